import subprocess
import sys

import pytest

from dqpaint.controllers import CONTROLLERS
from dqpaint.core import choice_name
from dqpaint.core.registry import Folder, Registry
from dqpaint.disturbances import DISTURBANCES
from dqpaint.errors import UnknownNameError, UsageError
from dqpaint.outputs import WRITERS
from dqpaint.plants import PLANTS
from tests.support.plugins import install

FOLDERS = [CONTROLLERS, PLANTS, DISTURBANCES, WRITERS]


@pytest.fixture
def fruit(tmp_path, monkeypatch):
    """A package whose files add things; what is read is written down."""
    name = "fruit_of_test_registry"
    folder = tmp_path / name
    folder.mkdir()
    (folder / "__init__.py").write_text(
        f"from dqpaint.core.registry import Folder\nREAD = []\nFRUIT = Folder('fruit', '{name}')\n"
    )
    for file, adds in (("apple", ["apple"]), ("red_plum", ["red-plum", "sloe"]), ("zest", [])):
        text = f"from {name} import FRUIT, READ\nREAD.append('{file}')\n"
        text += "".join(f"FRUIT.add('{add}')('{add} it is')\n" for add in adds)
        (folder / f"{file}.py").write_text(text)
    monkeypatch.syspath_prepend(tmp_path)
    module = __import__(name)
    yield module
    for key in [key for key in sys.modules if key.startswith(name)]:
        del sys.modules[key]


def test_a_file_is_read_when_its_thing_is_asked_for(fruit):
    assert fruit.READ == []
    assert fruit.FRUIT["red-plum"] == "red-plum it is"
    assert fruit.READ == ["red_plum"]
    assert "apple" in fruit.FRUIT
    assert fruit.READ == ["red_plum", "apple"]


def test_what_lies_elsewhere_is_found_all_the_same(fruit):
    assert fruit.FRUIT["sloe"] == "sloe it is"
    assert sorted(fruit.READ) == ["apple", "red_plum", "zest"]


@pytest.mark.parametrize("name", ["zest", "stone", "", "../apple", "os.path", "apple.x"])
def test_an_unknown_name_is_answered_with_all_of_them(fruit, name):
    assert name not in fruit.FRUIT
    with pytest.raises(UnknownNameError, match="known: apple, red-plum, sloe"):
        fruit.FRUIT[name]


def test_names_come_in_order_whatever_was_read_first(fruit):
    assert fruit.FRUIT["sloe"]
    assert list(fruit.FRUIT) == ["apple", "red-plum", "sloe"]
    assert len(fruit.FRUIT) == 3


def test_a_name_is_given_once():
    registry = Registry("fruit")
    registry.add("pear")("a pear")
    with pytest.raises(ValueError, match="two fruits named 'pear'"):
        registry.add("pear")("another")


@pytest.mark.parametrize("folder", FOLDERS, ids=lambda f: f.kind)
def test_the_folders_are_read_bit_by_bit(folder):
    assert isinstance(folder, Folder)
    assert list(folder) == sorted(folder)


@pytest.mark.slow
def test_a_run_reads_no_law_plant_or_disturbance_but_its_own():
    code = (
        "import sys; import dqpaint; dqpaint.draw('star', size=(64, 36));"
        "print(*(name for name in sys.modules if name.startswith('dqpaint.')))"
    )
    read = subprocess.run(
        [sys.executable, "-c", code], check=True, capture_output=True, text=True
    ).stdout.split()
    for law in set(CONTROLLERS) - {"hinf", "hinf-set"}:
        file = law.replace("-", "_")
        assert not any(
            name.startswith("dqpaint.controllers.laws.") and name.endswith(f".{file}")
            for name in read
        )
    # the ideal plant is a public base of others
    for room, used in (("plants", {"stiff", "ideal"}), ("disturbances", set())):
        for name in set(PLANTS if room == "plants" else DISTURBANCES) - used:
            assert f"dqpaint.{room}.{name}" not in read


@pytest.fixture
def orchard(tmp_path, monkeypatch, fruit):
    """A function that installs packages that bring fruit, and the registry open to them."""

    def grow(name, points, version="1.2", **files):
        install(tmp_path / name, name, files, f"[fruit.trees]\n{points}\n", version)
        monkeypatch.syspath_prepend(tmp_path / name)
        return Folder("fruit", "fruit_of_test_registry", "fruit.trees", lambda _, thing: str(thing))

    yield grow
    for key in [key for key in sys.modules if key.startswith("orchard")]:
        del sys.modules[key]


def test_plugins_are_found_by_their_entry_points(orchard):
    fruit = orchard("orchard1", "kiwi = orchard1.green:kiwi\nlime = orchard1.green", green="kiwi=7")
    assert fruit["kiwi"] == "7"  # as `adapt` makes it
    assert fruit.origin("kiwi") == "orchard1 1.2"
    assert list(fruit) == ["kiwi", "lime"]
    assert len(fruit) == 2


def test_a_built_in_name_is_never_hidden(orchard):
    orchard("orchard2", "apple = orchard2.red:apple", red="apple = 'wrong'")
    own = Folder("fruit", "fruit_of_test_registry", "fruit.trees")
    own.add("apple")("right")
    assert own["apple"] == "right"
    assert own.origin("apple") is None
    assert list(own) == ["apple"]
    assert own.faults == ["fruit 'apple' of orchard2 1.2 is not used: dqpaint has its own"]


@pytest.mark.parametrize(
    ("points", "said"),
    [
        ("kiwi = orchard3.nowhere:kiwi", "No module named 'orchard3.nowhere'"),
        ("kiwi = orchard3.green:plum", "has no attribute 'plum'"),
        ("kiwi = orchard3.broken:kiwi", "ZeroDivisionError"),
    ],
)
def test_a_plugin_that_cannot_be_loaded_is_told_with_its_package(orchard, points, said):
    fruit = orchard("orchard3", points, green="kiwi = 7", broken="1 / 0")
    with pytest.raises(UsageError, match=rf"fruit 'kiwi' of orchard3 1\.2 .*{said}"):
        fruit["kiwi"]
    assert list(fruit) == []  # a list shows the others
    assert said in fruit.faults[0]


def test_a_name_that_two_packages_bring_is_refused(orchard):
    orchard("orchard4", "kiwi = orchard4.green:kiwi", green="kiwi = 7")
    fruit = orchard("orchard5", "kiwi = orchard5.green:kiwi", green="kiwi = 8", version="2.0")
    with pytest.raises(UsageError, match=r"brought by orchard\d \S+ and orchard\d \S+: remove one"):
        fruit["kiwi"]


def test_a_plugin_may_register_itself_as_built_in_things_do(orchard):
    text = "from orchard6 import FRUIT\nFRUIT.add('kiwi')('registered')\nkiwi = 'not this'"
    fruit = orchard("orchard6", "kiwi = orchard6.green:kiwi", green=text)
    import orchard6

    orchard6.FRUIT = fruit
    assert fruit["kiwi"] == "registered"
    assert fruit.origin("kiwi") == "orchard6 1.2"


@pytest.mark.parametrize(
    ("text", "name"),
    [
        ("weak", "weak"),
        (" weak:share=0.5", "weak"),
        ("weak=0.5", "weak"),
        ("weak,share=0.5", "weak"),
        ("mine.py:Weak:share=0.5", "mine.py:Weak"),
        ("dir/mine.py:share=0.5", "dir/mine.py"),
        ("bar:", "bar"),
        ("", ""),
    ],
)
def test_the_name_of_a_choice_is_found_whatever_its_values(text, name):
    assert choice_name(text) == name

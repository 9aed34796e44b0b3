import subprocess
import sys

import pytest

from dqpaint.controllers import CONTROLLERS
from dqpaint.core.registry import Folder, Registry
from dqpaint.disturbances import DISTURBANCES
from dqpaint.errors import UnknownNameError
from dqpaint.outputs.robot import FORMATS
from dqpaint.plants import PLANTS

FOLDERS = [CONTROLLERS, PLANTS, DISTURBANCES, FORMATS]


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
        assert f"dqpaint.controllers.laws.{law.replace('-', '_')}" not in read
    for room, used in (("plants", "stiff"), ("disturbances", None)):
        for name in set(PLANTS if room == "plants" else DISTURBANCES) - {used}:
            assert f"dqpaint.{room}.{name}" not in read

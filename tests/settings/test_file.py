"""A picture from two files: the one that options make; what is wrong is told with its line."""

import json
import subprocess
import sys

import numpy as np
import pytest

import dqpaint
from dqpaint import __version__
from dqpaint.errors import DqpaintError, UsageError
from dqpaint.outputs.summary import summarise
from dqpaint.painting.validate import check_settings
from dqpaint.settings.file import SettingsFile, Trusted, read_given
from dqpaint.settings.model import Settings, make_settings
from dqpaint.settings.readers import parse_disturbances, parse_gains

TOML = """# a camera, a law, a lamp
view = "at:1.6:-0.5:0.8"
size = "96x54"
ev = 0.5
exposure = "f/4,iso200,50mm"
look = "aces"
starburst = 6
noise = 3
brush = "ball:size=9mm"
pwm = 400
magnify = 2.0
overlay = true
colour-by = "speed"

controller = "p"
plant = "ideal"
from = "home"
on-limit = "slow"
null = "limits,gain=3"
seed = 5
robot = "panda"
tool = "0,0,9cm"

[gain]
k = 15

[disturb]
latency = 2
twist = "noise,x=0.01,frequency=2"
"""
CHOSEN = make_settings(
    view="at:1.6:-0.5:0.8", width=96, height=54, ev=0.5, exposure="f/4,iso200,50mm", look="aces",
    starburst=6, noise=3, brush="ball:size=9mm", pwm=400.0, magnify=2.0, overlay=True,
    colour_by="speed", controller="p", gains=parse_gains(["k=15"]), plant="ideal", start="home",
    on_limit="slow", null="limits,gain=3", seed=5, robot="panda", tool="0,0,9cm",
    disturb=parse_disturbances(["latency=2", "twist=noise,x=0.01,frequency=2"]),
)  # fmt: skip
LINE = "period 20 ms\nstart at (0, 0) mm\nline to (30, 10) mm in 400 ms light red to cyan\n"


@pytest.fixture
def file(tmp_path):
    def write(text, name="given.toml"):
        path = tmp_path / name
        path.write_text(text)
        return str(path)

    return write


def test_every_option_of_the_command_line_can_be_said(file):
    assert make_settings(**read_given(file(TOML), check_settings).choices) == CHOSEN


def test_a_summary_says_all_that_its_run_was(file):
    facts = {
        "schema": "dqpaint-run-1", "versions": {"dqpaint": __version__}, "sha256": "a" * 64,
        "settings": json.loads(CHOSEN.model_dump_json()),
    }  # fmt: skip
    given = read_given(file(json.dumps(facts), "run.json"), check_settings)
    assert make_settings(**given.choices) == CHOSEN
    assert given.remarks("a" * 64) == ()
    assert given.remarks("b" * 64) == ("run.json was made with another text of this drawing",)


def test_a_version_that_is_not_this_one_is_told(file):
    given = read_given(file('dqpaint = "0.0.9"\n'), check_settings)
    assert given.remarks("") == (f"given.toml is for dqpaint 0.0.9, this is {__version__}",)
    assert read_given(file(f'dqpaint = "{__version__}"\n'), check_settings).remarks("") == ()
    assert SettingsFile().remarks("") == ()


def test_what_is_typed_wins_by_name():
    given = SettingsFile("a.toml", {
        "controller": "p", "gains": {"k": 3.0}, "view": "iso", "ghost": True,
        "disturb": {"payload": {"": 1.0}, "noise": {"": 1.0}},
    })  # fmt: skip
    typed = {"view": "top", "ghost": False, "ev": None, "disturb": {"noise": {"": 2.0}}}
    assert given.under(typed) == {
        "controller": "p", "gains": {"k": 3.0}, "view": "top", "ghost": False,
        "disturb": {"payload": {"": 1.0}, "noise": {"": 2.0}},
    }  # fmt: skip
    assert given.under({"gains": {"k": 4.0}})["gains"] == {"k": 4.0}
    assert given.under({"controller": "p"})["gains"] == {"k": 3.0}
    assert "gains" not in given.under({"controller": "pff"})  # they are those of another law
    assert SettingsFile("b.toml", {"gains": {"K_T": 9.0}}).under({"controller": "hinf"})["gains"]


def test_a_file_that_is_named_is_looked_for_beside_the_settings(file, tmp_path, monkeypatch):
    monkeypatch.chdir("/")
    (tmp_path / "own.py").write_text("def own(seen, k=2.0):\n    return k * seen.twist_d\n")
    (tmp_path / "stripes.png").write_bytes(b"")
    given = read_given(file('controller = "own.py:own"\ngain.k = 3\n'), check_settings)
    assert given.choices["controller"] == f"{tmp_path}/own.py:own"
    with pytest.raises(DqpaintError, match=r"given.toml:1: image .* is not a picture"):
        read_given(
            file('brush = "pixelstick:length=140mm,image=stripes.png,along=y"\n'), check_settings
        )


WRONG = {
    'size = "64x36"\nveiw = "iso"': "given.toml:2: no setting named 'veiw'; did you mean 'view'?",
    "camera = 3": "given.toml:1: no setting named 'camera'; did you mean 'view'?",
    "xyzzy = 3": "given.toml:1: no setting named 'xyzzy'; known: brush, colour-by, controller,",
    '\n\nview = "fornt"': "given.toml:3: no view named 'fornt'; did you mean 'front'? known: front",
    'look = "flim"': "given.toml:1: no look named 'flim'; did you mean 'film'? known: film, aces",
    'controller = "pf"': "no controller named 'pf'; did you mean 'pff'? known",
    'robot = "iwa"': "no robot named 'iwa'; did you mean 'iiwa'?",
    'plant = "compliant:freqency=3"': "given.toml:1: plant 'compliant': has no value named 'freq",
    'exposure = "f8"': "given.toml:1: exposure 'f8': 'f8' is not a part",
    'view = "at:1:0:1"\nexposure="2m"': None,
    'brush = "bra"': "no brush named 'bra'; did you mean 'bar'?",
    'tool = "1"': "given.toml:1: tool '1' is not X,Y,Z",
    'null = "hom"': "did you mean 'home'?",
    "starburst = 99": "given.toml:1: starburst 99: an aperture has",
    '[disturb]\ntwst = "x=3"': "given.toml:1: no disturbance named 'twst'; did you mean 'twist'?",
    "[gain]\nk = 3": "given.toml:1: controller 'hinf' has no gain named 'k'",
    "gain = 3": "given.toml:1: gain 3 gives no names with values, for example k=20",
    "disturb = 3": "given.toml:1: disturb 3 gives no names with values, for example twist=sine,",
    'ghost = "flash"': "given.toml:1: ghost 'flash' should be False, True or 'motion'",
    "ev = nan": "given.toml:1: ev nan should be a finite number",
    "view = 30": "given.toml:1: view 30 should be a valid string",
    "ev = true": "given.toml:1: ev True should be a valid number",
    "seed = true": "given.toml:1: seed True should be a valid integer",
    'overlay = "yes"': "given.toml:1: overlay 'yes' should be a valid boolean",
    '\nmotion_ghost = "yes"': "given.toml:2: motion_ghost 'yes' should be true or false",
    'controller = "p"\ngain.k = true': "given.toml:2: gain 'k' should be a number, not true",
    "[disturb]\nnoise = {rms = true}": "given.toml:1: disturb.noise.rms",
    "width = 3": "given.toml:1: width 3 should be greater than or equal to 16",
    'size = "big"': "given.toml:1: size 'big' is not WIDTHxHEIGHT",
    'size = "64x36"\nwidth = 99': "given.toml:2: width sets again what size sets",
    'out = "x"': "given.toml:1: 'out' is no part of a picture: give it on the command line",
    "dqpaint = 1": "given.toml:1: dqpaint is a version, for example",
    "view = \n": "given.toml is no TOML: Invalid value (at line 1, column 8)",
    "a = " + "[" * 9999: "given.toml is no TOML: it is nested too deep",
}


@pytest.mark.parametrize("text", WRONG)
def test_what_is_wrong_is_told_with_its_line(text, file, tmp_path):
    if WRONG[text] is None:  # each key is right, but not with the other
        (tmp_path / "a.traj").write_text(LINE)
        with pytest.raises(UsageError, match="exposure '2m'"):
            dqpaint.draw(tmp_path / "a.traj", settings=file(text))
        return
    with pytest.raises(DqpaintError) as caught:
        read_given(file(text), check_settings)
    assert not isinstance(caught.value, UsageError)  # it is the file that has a fault
    assert WRONG[text] in str(caught.value)


@pytest.mark.parametrize(("name", "data", "says"), [
    ("a.json", b"{", "a.json is no JSON"),
    ("a.json", b"[1]", "a.json is not the summary"),
    ("a.json", b'{"schema": "dqpaint-run-1"}', "a.json is damaged"),
    ("a.json", b'{"schema": "dqpaint-run-1", "versions": {}, "settings": {\n"veiw": 1}}',
     "a.json:2: no setting named 'veiw'"),
    ("a.toml", b"\xff", "cannot be read: 'utf-8'"),
    ("a.toml", b"#" * 1_000_001, "1 MB"),
])  # fmt: skip
def test_what_is_no_file_of_settings(name, data, says, tmp_path):
    (tmp_path / name).write_bytes(data)
    with pytest.raises(DqpaintError) as caught:
        read_given(str(tmp_path / name), check_settings)
    assert says in str(caught.value)


@pytest.mark.parametrize("name", ["nowhere.toml", ".", "a\0b", "x" * 999])
def test_what_is_not_there(name):
    with pytest.raises(DqpaintError, match="cannot be read"):
        read_given(name, check_settings)


def test_a_picture_from_two_files_is_the_picture_bit_for_bit(file, tmp_path):
    drawing = file(LINE, "line.traj")
    choices = CHOSEN.model_dump(exclude={"width", "height"})
    typed = dqpaint.draw(drawing, size=(96, 54), **choices)
    again = dqpaint.draw(drawing, settings=file(TOML))
    assert again.picture.png == typed.picture.png
    assert again.settings == typed.settings == CHOSEN
    summary = file(json.dumps(summarise(typed)), "line-p.json")
    third = dqpaint.draw(drawing, settings=summary)
    assert third.picture.png == typed.picture.png
    np.testing.assert_array_equal(third.track.posture, typed.track.posture)
    assert not any("another text" in note for note in third.notes)
    other = dqpaint.draw(drawing, settings=summary, view="front", noise=4)
    assert other.picture.png != typed.picture.png
    changed = dqpaint.draw(file(LINE + "# \n", "line.traj"), settings=summary)
    assert "line-p.json was made with another text of this drawing" in changed.notes


def test_a_preview_takes_the_camera_of_a_file(file):
    drawing = file(LINE, "line.traj")
    given = dqpaint.preview(drawing, settings=file('view = "iso"\nsize = "64x36"\nev = 1\n'))
    typed = dqpaint.preview(drawing, view="iso", size=(64, 36), ev=1.0)
    assert given.picture.png == typed.picture.png
    assert given.settings == typed.settings == Settings(width=64, height=36, view="iso", ev=1.0)


LOUD = """
from pathlib import Path

from dqpaint.brushes import Brush
from dqpaint.plants import Ideal

Path(__file__).with_suffix(".ran").touch()

def law(seen, k=1.0):
    return seen.twist_d

class Slow(Ideal):
    pass

class Pair(Brush):
    def emitters(self):
        return []
"""


@pytest.fixture
def codes(tmp_path):
    """Code in the folder of settings and outside, and whether either was run."""
    inside, outside = tmp_path / "own" / "loud.py", tmp_path / "loud.py"
    inside.parent.mkdir()
    for path in (inside, outside):
        path.write_text(LOUD)

    def ran():
        found = sorted(path.relative_to(tmp_path).as_posix() for path in tmp_path.rglob("*.ran"))
        for name in found:
            (tmp_path / name).unlink()
        return found

    def write(text):
        path = tmp_path / "own" / "given.toml"
        path.write_text(text)
        return str(path)

    return write, ran


CODE = {"controller": "loud.py:law", "plant": "loud.py:Slow", "brush": "loud.py:Pair"}


@pytest.mark.parametrize("name", CODE)
def test_code_beside_the_settings_is_run_where_laws_are_and_no_other(codes, name, tmp_path):
    write, ran = codes
    read_given(write(f'{name} = "{CODE[name]}"\n'), check_settings)
    assert ran() == ["own/loud.ran"]
    (tmp_path / "own" / "link.py").symlink_to(tmp_path / "loud.py")
    for path in ("../loud.py", str(tmp_path / "loud.py"), "link.py"):
        given = write(f'view = "iso"\n{name} = "{CODE[name].replace("loud.py", path)}"\n')
        with pytest.raises(DqpaintError, match=rf"given\.toml:2: {name} .*--trust"):
            read_given(given, check_settings)
        assert ran() == []
        read_given(Trusted(given), check_settings)
        assert len(ran()) == 1


@pytest.mark.parametrize("path", ["loud.py", "../loud.py"])
def test_what_runs_no_law_runs_no_code_of_settings(codes, path):
    write, ran = codes
    text = f'view = "iso"\ncontroller = "{path}:law"\nplant = "{path}:Slow"\ngain.k = 3\n'
    given = read_given(write(text), check_settings, "leave")
    assert given.choices == {"view": "iso"}
    with pytest.raises(DqpaintError, match=r"given\.toml:1: brush .*--brush"):
        read_given(write(f'brush = "{path}:Pair"\n'), check_settings, "leave")
    assert ran() == []


def test_preview_and_check_run_no_code_of_settings(codes, tmp_path):
    write, ran = codes
    (tmp_path / "line.traj").write_text("line to (30, 0) mm in 0.5 s\n")
    given = write('size = "32x32"\ncontroller = "loud.py:law"\nplant = "loud.py:Slow"\n')
    dqpaint.preview(tmp_path / "line.traj", settings=given)
    command = [sys.executable, "-m", "dqpaint", "check", "line.traj", "--settings", given]
    subprocess.run(command, cwd=tmp_path, check=True, stdout=subprocess.DEVNULL)
    assert ran() == []


def test_an_example_s_law_is_no_stranger(tmp_path):
    (tmp_path / "given.toml").write_text('controller = "mylaw.py"\n')
    assert read_given(str(tmp_path / "given.toml"), check_settings).choices["controller"]

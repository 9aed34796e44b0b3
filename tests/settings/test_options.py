"""One option, one place: what is declared of a setting is what every user of it says."""

import inspect
import os
import re
import shutil
import subprocess
import sys
from pathlib import Path
from typing import get_type_hints

import pytest

import dqpaint
from dqpaint.errors import UsageError
from dqpaint.settings import COMMANDS, SETTINGS, Settings, make_settings, options, settings_of

PACKAGE = Path(dqpaint.__file__).parent
LINE = "period 20 ms\nstart at (0, 0) mm\nline to (30, 10) mm in 400 ms\n"
GIVES = {
    "draw",
    "preview",
    "develop",
    "check",
    "export",
    "plot",
    "compare",
    "sweep",
    "tune",
    "replay",
}


def test_every_field_can_be_said_once():
    fields = [f for s in SETTINGS.values() for f in s.option.parts or (s.field,)]
    assert sorted(fields) == sorted(Settings.model_fields)
    names = [setting.name for setting in SETTINGS.values()]
    assert len(set(names)) == len(names)
    assert set(COMMANDS) == GIVES


def test_keywords_of_type_checkers_are_those_of_the_model():
    for name in ("draw", "preview", "develop"):
        typed = get_type_hints(getattr(options, f"{name.title()}Options"))
        of_command = {setting.keyword for setting in settings_of(*COMMANDS[name])}
        assert set(typed) == of_command
        parameters = inspect.signature(getattr(dqpaint, name)).parameters
        assert of_command <= set(parameters)
        doc = getattr(dqpaint, name).__doc__
        for keyword in of_command:
            assert f"    {keyword}: {SETTINGS[keyword].option.help[:20]}" in doc


@pytest.mark.parametrize("command", COMMANDS)
def test_help_has_every_option_of_the_command_s_groups(command, answer):
    done = answer(command, "--help")
    for setting in SETTINGS.values():
        shown = re.search(rf"^  --{setting.name}s?(?=[ ,]|$)", done.stdout, re.MULTILINE)
        assert bool(shown) == (setting.group in COMMANDS[command]), setting.name
    assert ("\nPicture:\n" in done.stdout) == (command not in ("export", "plot", "tune", "replay"))
    assert "[default: 640x360]" in done.stdout if command == "compare" else True


NEW = """    twinkle: Annotated[
        int, Field(ge=0, le=7), Option("how much the light twinkles", "N", name="twinkling")
    ] = 3

    on_limit:"""


@pytest.mark.slow
def test_one_option_is_one_place(tmp_path):
    """A field is added to a group in a copy: it is known to the help and behaviour of every command
    that takes the group, to Python and to files."""
    shutil.copytree(PACKAGE, tmp_path / "dqpaint")
    shutil.copytree(PACKAGE.parent / "trajectories", tmp_path / "dqpaint/trajectories")
    model = tmp_path / "dqpaint/settings/groups.py"
    text = model.read_text("utf-8")
    assert text.count("    on_limit:") == 1
    model.write_text(text.replace("    on_limit:", NEW), "utf-8")
    (tmp_path / "line.traj").write_text(LINE)
    (tmp_path / "good.toml").write_text("twinkling = 5\n")
    (tmp_path / "bad.toml").write_text("\ntwinkling = 8\n")

    def run(*words):
        return subprocess.run(
            [sys.executable, *words], cwd=tmp_path, capture_output=True, text=True, check=False,
            env={**os.environ, "PYTHONPATH": str(tmp_path)},
        )  # fmt: skip

    takers = [name for name in COMMANDS if settings_of_group(name, "on_limit")]
    assert takers == ["draw", "check", "export", "plot", "compare", "sweep", "tune", "replay"]
    for name in takers:
        assert re.search(
            r"--twinkling N +how much the light twinkles", run("-m", "dqpaint", name, "-h").stdout
        )
        words = [] if name == "replay" else ["--vary", "k=1,2"] if name == "sweep" else []
        words += ["--format", "csv"] if name == "export" else []
        drawing = "thesis-spiral" if name == "replay" else "line.traj"
        done = run("-m", "dqpaint", name, drawing, *words, "--twinkling", "8")
        assert (done.returncode, done.stdout) == (2, ""), done.stderr
        assert "usage: twinkle 8 should be less than or equal to 7" in done.stderr
    assert "--twinkling" not in run("-m", "dqpaint", "preview", "-h").stdout

    code = (
        "import dqpaint\n"
        "print(dqpaint.draw('line.traj', twinkle=4, size=(64, 36)).settings.twinkle)\n"
        "print(dqpaint.draw('line.traj', settings='good.toml', size='64x36').settings.twinkle)\n"
        "assert 'twinkle: how much the light twinkles [default: 3]' in dqpaint.draw.__doc__"
    )
    done = run("-c", code)
    assert (done.stdout, done.stderr) == ("4\n5\n", "")
    done = run("-m", "dqpaint", "check", "line.traj", "--settings", "bad.toml")
    assert "bad.toml:2: twinkle 8 should be less" in done.stderr


def settings_of_group(command, field):
    return any(setting.field == field for setting in settings_of(*COMMANDS[command]))


@pytest.mark.parametrize(("words", "says"), [
    (["--plants", "rubber"], "no plant named 'rubber'"),
    (["--gains", "x=1"], "has no gain named 'x'"),
    (["--sizes=big"], "size 'big' is not"),
    (["--plants", "ideal,stiff"], "draw takes one --plant"),
    (["--plantss", "stiff"], "No such option: --plantss"),
])  # fmt: skip
def test_several_are_accepted_for_one(words, says, answer, tmp_path):
    (tmp_path / "line.traj").write_text(LINE)
    done = answer("draw", "line.traj", *words)
    assert done.returncode == 2
    assert says in done.stderr


FORMS = {
    "size": ["64x36", (64, 36), [64, 36]],
    "gains": ["k=20", ["k=20"], {"k": 20}, {"k": 20.0}],
    "disturb": [
        "twist=x=0.01", ["twist=x=0.01"], {"twist": "x=0.01"}, {"twist": {"x": 0.01}},
    ],
    "controller": ["mine.py", Path("mine.py")],
    "recorded": ["run.csv", Path("run.csv")],
}  # fmt: skip


@pytest.mark.parametrize("keyword", FORMS)
def test_python_takes_what_the_command_line_takes(keyword):
    first, *others = (make_settings(**{keyword: form}) for form in FORMS[keyword])
    assert first != Settings()
    assert all(other == first for other in others)


@pytest.mark.parametrize(("size", "pixels"), [
    ("square", (1080, 1080)),
    ("portrait", (1080, 1350)),
    ("a3@300dpi", (4961, 3508)),
    ("a3-portrait", (3508, 4961)),
    ("a6@72dpi", (420, 298)),
])  # fmt: skip
def test_sizes_of_pages_and_prints(size, pixels):
    """By the tables of printers: A3 at 300 dpi is 4961x3508, A6 at 72 dpi 420x298."""
    settings = make_settings(size=size)
    assert (settings.width, settings.height) == pixels


def test_several_gains_and_diagonals_stand_in_one_text():
    assert make_settings(gains="k=5, d=2").gains == {"k": 5, "d": 2}
    assert make_settings(gains="q=1,1,4").gains == {"q": "1,1,4"}
    assert make_settings(gains={"q": [1, 1, 4]}).gains == {"q": (1, 1, 4)}


@pytest.mark.parametrize(("choice", "says"), [
    ({"size": 3}, "size 3 is not WIDTHxHEIGHT"),
    ({"size": "a7@300dpi"}, "size 'a7@300dpi' is not WIDTHxHEIGHT"),
    ({"size": "a2@600dpi"}, "8192"),
    ({"size": (1, 2, 3)}, "size .* is not WIDTHxHEIGHT"),
    ({"size": ("a", 36)}, "width 'a' should be a valid integer"),
    ({"gains": 3}, "gain 3 gives no names with values, for example k=20"),
    ({"gains": {"k": True}}, "gain 'k' should be a number, not true"),
    ({"disturb": [3]}, r"disturb \[3\] gives no names with values"),
    ({"disturb": {"twist": None}}, "disturbance 'twist=None'|twist"),
    ({"view": 3}, "view 3 should be a valid string"),
    ({"controller": 3}, "controller '3' can't be called"),
    ({"ev": "bright"}, "ev 'bright' should be a valid number"),
    ({"overlay": "perhaps"}, "overlay 'perhaps' should be a valid boolean"),
    ({"veiw": "iso"}, "draw takes no 'veiw'; did you mean 'view'"),
])  # fmt: skip
def test_a_wrong_type_is_told_with_the_option(choice, says, tmp_path):
    (tmp_path / "line.traj").write_text(LINE)
    with pytest.raises(UsageError, match=says):
        dqpaint.draw(tmp_path / "line.traj", **choice)


def test_a_command_refuses_what_is_of_others():
    with pytest.raises(UsageError, match="preview takes no 'controller'; "):
        dqpaint.preview("star", controller="p")
    with pytest.raises(UsageError, match="develop takes no 'brush'"):
        dqpaint.develop("star.npz", brush="bar")

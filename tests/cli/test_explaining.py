"""`dqpaint explain`: everything registered has its equation, its limits and a command that runs."""

import contextlib
import io
import os
import shlex

import pytest

from dqpaint.cli import explaining
from dqpaint.cli.main import app
from dqpaint.controllers import CONTROLLERS
from dqpaint.core import example_names
from dqpaint.core.texts.mathematics import latex_equation, unicode_equation
from dqpaint.metrics import METRICS
from dqpaint.settings import SETTINGS
from tests.support.latex import is_latex

EVERY = [(kind, one.name) for kind in explaining.NEEDED for one in explaining.all_explained(kind)]
IDEA = 420  # characters: three lines or so
SHORT = "period 5 ms\nline to (20, 10) mm tool rpy(0, 0, 10 deg) in 0.3 s\nhold 0.1 s\n"
DRAWN = ("draw", "compare", "sweep")


def found(kind, name):
    (one,) = [one for one in explaining.explained(name) if one.kind == kind]
    return one


@pytest.mark.parametrize(("kind", "name"), EVERY)
def test_everything_registered_is_explained(kind, name):
    one = found(kind, name)
    assert one.sections.missing(explaining.NEEDED[kind]) == []
    assert len(one.sections.texts["idea"]) < IDEA
    for equation in one.sections.equations:
        assert is_latex(latex_equation(equation))
    text = explaining.format_explained(one)
    assert unicode_equation(one.sections.equations[0]) in text
    assert all(value["name"] in text for value in one.values)
    for command in one.sections.try_:
        assert command in text
        assert shlex.split(command)[0] in ("dqpaint", "echo")
    if kind == "metric":
        assert name in text
    else:
        assert any(name in command for command in one.sections.try_) or kind == "profile"


def test_what_a_law_says_besides():
    text = explaining.format_explained(found("law", "hinf"))
    assert "q̇ = J_w⁺ ([-K_O Im(r_e); -K_T p_e] + Ad(x_e) ξ_d)" in text
    assert CONTROLLERS["hinf"].source in text
    assert "--gain paper: gamma_T = 0.372" in text
    for label in ("idea", "error", "stable", "fails", "gains", "source", "try"):
        assert f"\n  {label} " in text


def test_a_law_of_one_s_own(tmp_path):
    file = tmp_path / "mine.py"
    file.write_text('def mine(seen, k=2.0):\n    """Mine.\n\n    Equation:\n        u = k xi_d\n'
                    '    """\n    return k * seen.twist_d\n')  # fmt: skip
    (one,) = explaining.explained(str(file))
    text = explaining.format_explained(one)
    assert "u = k ξ_d" in text
    assert "k = 2" in text


def said(*words):
    """The exit code and what is printed, in this process."""
    out = io.StringIO()
    with contextlib.redirect_stdout(out), contextlib.redirect_stderr(out):
        code = app(list(words), standalone_mode=False)
    return code or 0, out.getvalue()


def test_an_unknown_name_gets_the_nearest(dqpaint):
    done = dqpaint("explain", "hinff")
    assert done.returncode == 2
    assert "'hinf'" in done.stderr


def test_figures_and_colours_in_examples_exist():
    for metric in METRICS.values():
        words = shlex.split(metric.example)
        if "--colour-by" in words:
            assert words[-1] == metric.colour_by
        if "--figure" in words:
            assert words[-1] == metric.name
    assert "colour_by" in SETTINGS


COMMANDS = sorted({
    "\n".join(one.sections.try_) for kind in ("law", "plant", "disturbance", "profile")
    for one in explaining.all_explained(kind)
} | {"dqpaint compare lag --controllers p,hinf --figure effort_integral",
     "dqpaint draw lag --controller p --colour-by position-error",
     "dqpaint draw lag --controller p --save motion"})  # fmt: skip


@pytest.mark.slow
@pytest.mark.parametrize("commands", COMMANDS)
def test_every_command_runs(commands, tmp_path, monkeypatch):
    """With a short drawing in place of its own, which exists."""
    monkeypatch.chdir(tmp_path)
    (tmp_path / "short.traj").write_text(SHORT)
    for command in commands.splitlines():
        words = shlex.split(command)
        if words[0] == "echo":  # echo "..." > FILE
            (tmp_path / words[3]).write_text(words[1] + "\n")
            continue
        assert (tmp_path / words[2]).exists() or words[2] in example_names()
        words[2] = "short.traj"
        small = ["--size", "64x36"] if words[1] in DRAWN else []
        jobs = ["--jobs", "1"] if words[1] in ("compare", "sweep") else []
        code, text = said(*words[1:], *small, *jobs)
        assert code == 0, text
    assert len(os.listdir(tmp_path)) > 1

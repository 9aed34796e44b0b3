"""What `check` costs: so much a line of any kind, and little to begin with."""

import subprocess
import sys
from pathlib import Path

import pytest
from typer.testing import CliRunner

from dqpaint.cli.studies import app
from dqpaint.errors import UsageError
from dqpaint.settings import COMMANDS, settings_of
from tests.support.many_lines import LINES, kinds
from tests.support.work import FAR_TOO_LONG, checked

MOST_CALLS = 900  # a line; 260 to 570 are needed


@pytest.mark.slow
@pytest.mark.parametrize("kind", kinds())
def test_ten_thousand_lines_are_checked_soon(kind: str, tmp_path: Path) -> None:
    text = kinds()[kind]
    assert text.count("\n") == LINES
    path = tmp_path / f"{kind}.traj"
    path.write_text(text, encoding="utf-8")
    answer = checked(path)
    assert answer.code == 0, answer.said
    assert answer.calls < MOST_CALLS * LINES


@pytest.mark.slow
def test_a_drawing_without_an_arm_is_checked_without_the_arms(tmp_path: Path) -> None:
    path = tmp_path / "line.traj"
    path.write_text("line by (9, 0) mm\n", encoding="utf-8")
    code = (
        "import sys; from dqpaint.planning.check import check\n"
        f"assert not check({str(path)!r}).errors\n"
        "assert not [m for m in sys.modules if m.startswith('dqpaint.robots')]\n"
        "assert not {'pin', 'pinocchio', 'cv2', 'pybullet'} & {*sys.modules}"
    )
    subprocess.run([sys.executable, "-c", code], check=True, timeout=FAR_TOO_LONG)


OPTIONS = {
    f"--{setting.name}": "nix" if setting.kind is str else "-9"
    for setting in settings_of(*COMMANDS["check"])
    if setting.kind is not bool
}


@pytest.mark.parametrize("option", OPTIONS)
def test_every_choice_is_heeded(option: str, tmp_path: Path) -> None:
    path = tmp_path / "line.traj"
    path.write_text("line by (9, 0) mm\n", encoding="utf-8")
    wrong = OPTIONS[option]
    fault = CliRunner().invoke(app, ["check", str(path), option, wrong]).exception
    assert isinstance(fault, UsageError)
    assert wrong in str(fault)

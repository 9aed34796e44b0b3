"""What `check` costs: 10,000 lines of any kind in less than a second, and little to begin with."""

import os
import subprocess
import sys
from pathlib import Path

import pytest
from typer.testing import CliRunner

from dqpaint.cli.studies import app
from dqpaint.errors import UsageError
from dqpaint.settings import COMMANDS, settings_of
from tests.bench.bench_language import PYTHON, kinds
from tests.support.clock import children_time

TIMES = 15.0  # as long as Python takes to compile as many lines, and to start; 4 to 6 measured


def spent(*arguments: str) -> float:
    """Processor time [s] of a process of this Python."""
    before = children_time()
    environment = {**os.environ, "OPENBLAS_NUM_THREADS": "1"}
    done = subprocess.run(
        [sys.executable, *arguments], check=False, capture_output=True, text=True, env=environment
    )
    assert done.returncode == 0, done.stdout + done.stderr
    return children_time() - before


@pytest.fixture(scope="module")
def floor(tmp_path_factory: pytest.TempPathFactory) -> float:
    path = tmp_path_factory.mktemp("floor") / "floor.py"
    path.write_text(PYTHON, encoding="utf-8")
    command = f"compile(open({str(path)!r}).read(), 'floor.py', 'exec')"
    return min(spent("-c", command) for _ in range(3))


@pytest.mark.slow
@pytest.mark.parametrize("kind", kinds())
def test_ten_thousand_lines_are_checked_soon(kind: str, tmp_path: Path, floor: float) -> None:
    text = kinds()[kind]
    assert text.count("\n") == 10_000
    path = tmp_path / f"{kind}.traj"
    path.write_text(text, encoding="utf-8")
    assert spent("-m", "dqpaint", "check", str(path)) < TIMES * floor


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
    spent("-c", code)


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

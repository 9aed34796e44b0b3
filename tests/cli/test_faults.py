"""Commands on a failing machine: a sentence, the right exit code, and files old or new.

Every fault of every command: `python -m tests.tools.faults`. Here is a part of them.
"""

import random
import tempfile

import pytest

from tests.support.faults import Answer, Faults
from tests.support.faulty_commands import COMMANDS, Trial
from tests.support.installed import needs_pybullet

SMALL = ["fmt", "new"]


def checked(name, folder, count=None):
    trial = Trial(name, folder / name)
    faults = trial.every_fault()
    if count:
        faults = random.Random(name).sample(faults, count)
    told = [text for fault in faults for text in trial.complaints(trial.outcome(fault))]
    assert told == []


@pytest.mark.parametrize("name", SMALL)
def test_every_fault_of_a_small_command(tmp_path, name):
    checked(name, tmp_path)


@pytest.mark.slow
@pytest.mark.parametrize("name", [name for name in COMMANDS if name not in SMALL])
def test_some_faults_of_a_large_command(tmp_path, name):
    checked(name, tmp_path, 8)


@needs_pybullet
def test_a_full_folder_of_temporary_files_is_told_as_such(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    (tmp_path / "a.traj").write_text("line to (10, 0) mm in 100 ms\n")

    def full(*_given, **_named):
        raise OSError(28, "No space left on device")

    monkeypatch.setattr(tempfile, "mkstemp", full)
    said = Answer("draw", "a.traj", "--size", "32x32")
    assert said.code == 1
    assert "No space left on device" in said.err
    assert "TMPDIR" in said.err
    assert "standard output" not in said.err


def test_a_fault_is_seen_by_these_tests(tmp_path, monkeypatch):
    from dqpaint.core import atomic_files

    trial = Trial("fmt", tmp_path / "fmt")

    def at_once(path, data):
        path.write_bytes(b"")
        path.write_bytes(data)

    monkeypatch.setattr("dqpaint.language.writing.format_files.rewrite", at_once)
    assert atomic_files.rewrite is not at_once
    told = [
        text for number in range(8) for text in trial.complaints(trial.outcome(Faults(number, 5)))
    ]
    assert any("neither old nor new" in text for text in told)

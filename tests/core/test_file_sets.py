"""Sets of files: all or none, whatever cuts them off, one writer at a time."""

import json
import os
import subprocess
import sys
import threading
from pathlib import Path

import pytest

from dqpaint.core import atomic_files, file_sets, finish_interrupted, open_folder, write_together
from dqpaint.errors import OutputError

OLD = {"a.png": b"old picture", "a.csv": b"old table", "a.json": b"old summary"}
NEW = {"a.png": b"new picture", "a.csv": b"new table", "a.json": b"new summary"}


def contents(folder):
    return {path.name: path.read_bytes() for path in folder.iterdir()}


@pytest.fixture
def folder(tmp_path):
    write_together(tmp_path / "made" / "twice", OLD)
    return tmp_path / "made" / "twice"


def killed_at(folder, call, count):
    """Write the new set in a process that ends at a call of a function of `os`, by its number."""
    program = f"""
import os
from pathlib import Path
from dqpaint.core import write_together
real, left = os.{call}, [{count}]
def last(*given, **named):
    left[0] -= 1
    if left[0] < 0:
        os._exit(9)
    return real(*given, **named)
os.{call} = last
write_together(Path({str(folder)!r}), {NEW!r})
"""
    return subprocess.run([sys.executable, "-c", program], check=False).returncode


@pytest.mark.parametrize(
    ("call", "count", "after"),
    [("fsync", 0, OLD), ("fsync", 2, OLD), ("replace", 0, OLD), ("replace", 1, NEW),
     ("replace", 3, NEW)],
)  # fmt: skip
def test_what_a_kill_left_is_undone_or_finished_by_the_next_who_writes(folder, call, count, after):
    assert killed_at(folder, call, count) == 9
    assert set(contents(folder)) > set(OLD)
    moved = finish_interrupted(folder)
    assert contents(folder) == after
    assert set(moved) <= set(NEW)
    assert bool(moved) == (after is NEW)
    assert finish_interrupted(folder) == []


def test_a_set_that_is_written_again_is_the_later_one(folder):
    assert killed_at(folder, "replace", 2) == 9
    write_together(folder, {"a.csv": b"newest"})
    assert contents(folder) == {**NEW, "a.csv": b"newest"}


def note_of(folder):
    (note,) = folder.glob("*.moves")
    return note


def test_a_set_of_which_the_disk_lost_a_file_is_undone(folder):
    assert killed_at(folder, "replace", 1) == 9
    next(folder.glob("*.part")).unlink()
    assert finish_interrupted(folder) == []
    assert contents(folder) == OLD


@pytest.mark.parametrize("change", [
    lambda moves: [{**moves[0], "name": "../a.png"}, *moves[1:]],
    lambda moves: [{**moves[0], "part": "../a.png"}, *moves[1:]],
    lambda moves: [{**moves[0], "part": "a.csv"}, *moves[1:]],
    lambda moves: [{"name": "a.png"}],
    lambda moves: 3,
])  # fmt: skip
def test_a_note_from_elsewhere_moves_nothing_out_of_its_folder(folder, change):
    assert killed_at(folder, "replace", 1) == 9
    note = note_of(folder)
    note.write_text(json.dumps(change(json.loads(note.read_text()))))
    assert finish_interrupted(folder) == []
    assert contents(folder) == {**OLD, note.name: note.read_bytes()}


def test_a_file_that_cannot_be_moved_waits_and_is_told(folder, monkeypatch):
    move = os.replace
    moved = []

    def broken(source, target):
        if Path(target).name == "a.json":
            raise OSError(5, "Input/output error")
        moved.append(target)
        move(source, target)

    monkeypatch.setattr(os, "replace", broken)
    with pytest.raises(OutputError, match=r"Input/output error.*complete on the disk"):
        write_together(folder, NEW)
    assert len(moved) == 3  # the note, picture and table
    monkeypatch.undo()
    assert finish_interrupted(folder) == ["a.json"]
    assert contents(folder) == NEW


def test_a_set_of_which_nothing_could_be_moved_leaves_nothing(folder, monkeypatch):
    move = os.replace

    def broken(source, target):
        if not str(target).endswith(file_sets.NOTE):
            raise OSError(5, "Input/output error")
        move(source, target)

    monkeypatch.setattr(os, "replace", broken)
    with pytest.raises(OSError, match="Input/output error"):
        write_together(folder, NEW)
    assert contents(folder) == OLD


def test_a_ctrl_c_between_two_moves_finishes_them(folder, monkeypatch):
    move = os.replace

    def stopped(source, target):
        move(source, target)
        if str(target).endswith("a.png"):
            monkeypatch.undo()
            raise KeyboardInterrupt

    monkeypatch.setattr(os, "replace", stopped)
    with pytest.raises(KeyboardInterrupt):
        write_together(folder, NEW)
    assert contents(folder) == NEW


def test_two_writers_of_one_name_do_not_mix(tmp_path):
    sets = [{name: f"{name} {n}".encode() for name in NEW} for n in range(4)]

    def write(one):
        for _ in range(5):
            write_together(tmp_path, one)

    threads = [threading.Thread(target=write, args=(one,)) for one in sets]
    for thread in threads:
        thread.start()
    while any(thread.is_alive() for thread in threads):
        with open_folder(tmp_path):  # nobody is in between
            found = contents(tmp_path)
        assert found in [{}, *sets]
    assert contents(tmp_path) in sets


def test_who_waits_for_too_long_is_told(tmp_path, monkeypatch):
    monkeypatch.setattr(atomic_files, "LONGEST_WAIT", 0.05)
    with open_folder(tmp_path), pytest.raises(OutputError, match="another dqpaint"):
        write_together(tmp_path, NEW)
    write_together(tmp_path, NEW)
    assert contents(tmp_path) == NEW


def test_without_locks_of_folders_files_are_written_and_others_left_alone(tmp_path, monkeypatch):
    (tmp_path / ".dqpaint-other.part").write_bytes(b"of another process")
    monkeypatch.setattr(atomic_files, "fcntl", None)
    write_together(tmp_path, NEW)
    assert contents(tmp_path) == {**NEW, ".dqpaint-other.part": b"of another process"}

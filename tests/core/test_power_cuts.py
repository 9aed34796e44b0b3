"""A power cut at any moment leaves the whole of a set or nothing of it."""

import itertools
import os

import pytest

from dqpaint.core import file_sets, finish_interrupted, write_new, write_together
from tests.support.power_cuts import Recorder, lay_down, read_folder

OLD = {"a.png": b"old picture", "a.csv": b"old table", "a.json": b"old summary"}
NEW = {"a.png": b"new picture", "a.csv": b"new table", "a.json": b"new summary"}


@pytest.fixture
def numbered(tmp_path):
    """New folders."""
    names = itertools.count()
    return lambda: tmp_path / str(next(names))


def recorded(folder, contents):
    with Recorder(folder) as recorder:
        write_together(folder, contents)
        recorder.said("written")
    return recorder


def recovered(folder):
    """The folder after the next start."""
    finish_interrupted(folder)
    return read_folder(folder)


@pytest.mark.parametrize("old", [{}, OLD, {"a.png": b"new picture", "other": b"mine"}])
def test_a_set_is_there_as_a_whole_or_not_at_all(numbered, old, monkeypatch):
    folder = numbered()
    lay_down(folder, old)
    recorder = recorded(folder, NEW)
    monkeypatch.setattr(os, "fsync", lambda _handle: None)
    found = []
    for state, said in recorder.cuts():
        place = numbered()
        lay_down(place, state)
        left = recovered(place)
        assert left in ([{**old, **NEW}] if said else [old, {**old, **NEW}])
        found.append(left != old)
    assert len(found) > 100
    assert len(set(found)) == 2


def test_a_second_cut_while_the_first_is_mended(numbered, monkeypatch):
    folder = numbered()
    lay_down(folder, OLD)
    states = [state for state, _ in recorded(folder, NEW).cuts()]
    monkeypatch.setattr(os, "fsync", lambda _handle: None)
    count = 0
    for state in states[::7]:
        place = numbered()
        lay_down(place, state)
        with Recorder(place) as mending:
            finish_interrupted(place)
        end = read_folder(place)
        for again, _ in mending.cuts():
            other = numbered()
            lay_down(other, again)
            assert recovered(other) == end
            count += 1
    assert count > 100


def test_one_file_alone(numbered, monkeypatch):
    folder = numbered()
    lay_down(folder, OLD)
    recorder = recorded(folder, {"a.csv": b"new table"})
    monkeypatch.setattr(os, "fsync", lambda _handle: None)
    for state, said in recorder.cuts():
        place = numbered()
        lay_down(place, state)
        new = {**OLD, "a.csv": b"new table"}
        assert recovered(place) in ([new] if said else [OLD, new])


def test_a_new_drawing(numbered, monkeypatch):
    folder = numbered()
    folder.mkdir()
    with Recorder(folder) as recorder:
        write_new(folder / "a.traj", b"line")
        recorder.said("written")
    for state, said in recorder.cuts():
        shown = {name: data for name, data in state.items() if not name.startswith(".")}
        assert shown in ([{"a.traj": b"line"}] if said else [{}, {"a.traj": b"line"}])


@pytest.mark.parametrize("lazy", ["sync_files", "folder"])
def test_the_tests_see_a_program_that_does_not_sync(numbered, lazy, monkeypatch):
    folder = numbered()
    lay_down(folder, OLD)
    with monkeypatch.context() as patch:
        if lazy == "folder":
            patch.setattr(file_sets.OpenFolder, "sync", lambda _self: None)
        else:
            patch.setattr(file_sets, "sync_files", lambda _paths: None)
        recorder = recorded(folder, NEW)
    monkeypatch.setattr(os, "fsync", lambda _handle: None)
    wrong = 0
    for state, said in recorder.cuts():
        place = numbered()
        lay_down(place, state)
        wrong += recovered(place) not in ([NEW] if said else [OLD, NEW])
    assert wrong

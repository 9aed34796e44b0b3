"""Files come whole or not at all."""

import os
import stat

import pytest

from dqpaint.core.atomic_files import NotRegularError, open_regular, rewrite, write_new
from dqpaint.errors import OutputError


def names(folder):
    return sorted(path.name for path in folder.iterdir())


def test_a_new_file_has_the_usual_permissions(tmp_path):
    write_new(tmp_path / "a", b"1")
    mask = os.umask(0)
    os.umask(mask)
    assert stat.S_IMODE((tmp_path / "a").stat().st_mode) == 0o666 & ~mask
    with pytest.raises(OutputError, match="is there already"):
        write_new(tmp_path / "a", b"2")
    assert (tmp_path / "a").read_bytes() == b"1"
    assert names(tmp_path) == ["a"]


def test_a_link_to_nowhere_is_something(tmp_path):
    (tmp_path / "a").symlink_to(tmp_path / "gone")
    with pytest.raises(OutputError, match="is there already"):
        write_new(tmp_path / "a", b"2")
    with pytest.raises(OutputError, match="cannot be written"):
        rewrite(tmp_path / "a", b"2")
    assert names(tmp_path) == ["a"]


@pytest.mark.parametrize("call", [write_new, rewrite])
def test_places_that_cannot_be_written(tmp_path, call):
    for path in (tmp_path / "no" / "a", tmp_path / ("x" * 300), tmp_path / "a\0b"):
        with pytest.raises(OutputError, match="cannot be written"):
            call(path, b"1")
    assert names(tmp_path) == []


@pytest.mark.parametrize("call", [write_new, rewrite])
def test_a_full_disk_leaves_nothing(tmp_path, call, monkeypatch):
    if call is rewrite:
        (tmp_path / "a").write_bytes(b"old")

    def full(*_):
        raise OSError(28, "No space left on device")

    monkeypatch.setattr("os.chmod", full)
    with pytest.raises(OutputError, match="No space left"):
        call(tmp_path / "a", b"new")
    assert names(tmp_path) == (["a"] if call is rewrite else [])
    if call is rewrite:
        assert (tmp_path / "a").read_bytes() == b"old"


def test_a_read_only_file_is_left_as_it_is(tmp_path):
    path = tmp_path / "a"
    path.write_bytes(b"old")
    path.chmod(0o444)
    with pytest.raises(OutputError, match="is read-only"):
        rewrite(path, b"new")
    assert path.read_bytes() == b"old"
    path.chmod(0o640)
    rewrite(path, b"new")
    assert path.read_bytes() == b"new"
    assert stat.S_IMODE(path.stat().st_mode) == 0o640


@pytest.mark.skipif(not os.path.isdir("/proc/self/fd"), reason="open files are counted there")
def test_another_file_that_comes_in_between_is_refused_and_closed(tmp_path, monkeypatch):
    path = tmp_path / "a"
    path.write_bytes(b"1")
    regular = os.lstat(path)
    path.unlink()
    os.mkfifo(path)
    monkeypatch.setattr(os, "lstat", lambda _: regular)
    before = len(os.listdir("/proc/self/fd"))
    with pytest.raises(NotRegularError):
        open_regular(path, os.O_RDWR)
    assert len(os.listdir("/proc/self/fd")) == before

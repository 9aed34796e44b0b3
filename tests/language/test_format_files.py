"""Files in the one layout: what is written, and what is left alone."""

import os
import stat

import pytest

from dqpaint.errors import DqpaintError
from dqpaint.language.writing.format_files import format_bytes, format_file

UGLY, FAIR = b"line   to (1,2)mm\nhold 1s", b"line to (1, 2) mm\nhold 1 s\n"


@pytest.fixture
def drawing(tmp_path):
    path = tmp_path / "a.traj"
    path.write_bytes(UGLY)
    return path


def test_line_ends_stay_and_the_mark_goes():
    assert format_bytes(UGLY, "a") == FAIR
    crlf = FAIR.replace(b"\n", b"\r\n")
    assert format_bytes(UGLY.replace(b"\n", b"\r\n"), "a") == format_bytes(crlf, "a") == crlf
    assert format_bytes(b"\xef\xbb\xbf" + FAIR, "a") == FAIR
    mixed = b"hold 1 s\r\nhold 2 s\nhold 3 s\n"
    assert format_bytes(mixed, "a") == b"hold 1 s\r\nhold 2 s\r\nhold 3 s\r\n"


def test_a_file_is_rewritten_once(drawing):
    assert format_file(str(drawing), write=False)
    assert drawing.read_bytes() == UGLY
    assert format_file(str(drawing), write=True)
    assert drawing.read_bytes() == FAIR
    before = drawing.stat()
    assert not format_file(str(drawing), write=True)
    assert drawing.stat().st_mtime_ns == before.st_mtime_ns


def test_permissions_and_links_stay(drawing, tmp_path):
    os.chmod(drawing, 0o640)
    link = tmp_path / "link.traj"
    link.symlink_to(drawing)
    assert format_file(str(link), write=True)
    assert link.is_symlink()
    assert drawing.read_bytes() == FAIR
    assert stat.S_IMODE(drawing.stat().st_mode) == 0o640
    assert sorted(path.name for path in tmp_path.iterdir()) == ["a.traj", "link.traj"]


def test_what_is_no_drawing_is_left_alone(drawing, tmp_path):
    for data, says in [(b"lin to (1, 2) mm", "E120"), (b"\xff\xfe1", "UTF-16"), (b"\xe4", "UTF-8")]:
        drawing.write_bytes(data)
        with pytest.raises(DqpaintError, match=says):
            format_file(str(drawing), write=True)
        assert drawing.read_bytes() == data
    with pytest.raises(DqpaintError, match="can't read"):
        format_file(str(tmp_path), write=True)


def test_a_write_that_fails_leaves_the_file_as_it_was(drawing, tmp_path, monkeypatch):
    def full(*_):
        raise OSError(28, "No space left on device")

    monkeypatch.setattr("os.replace", full)
    with pytest.raises(DqpaintError, match="No space left"):
        format_file(str(drawing), write=True)
    assert drawing.read_bytes() == UGLY
    assert [path.name for path in tmp_path.iterdir()] == ["a.traj"]

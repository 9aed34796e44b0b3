"""The folder: names inside it, and nothing else."""

import os

import pytest

from dqpaint.errors import DqpaintError, UsageError
from dqpaint.studio.folder import LARGEST_TEXT, DrawingFolder


@pytest.fixture
def folder(tmp_path):
    root = tmp_path / "drawings"
    (root / "below").mkdir(parents=True)
    (root / "a.traj").write_text("speed 1 mm/s\n")
    (root / "below" / "b.traj").write_text("# below\n")
    (root / "notes.txt").write_text("no drawing")
    (tmp_path / "secret.traj").write_text("# outside")
    os.symlink(tmp_path / "secret.traj", root / "link.traj")
    os.symlink(tmp_path, root / "out")
    return DrawingFolder(root)


def test_its_drawings_are_listed(folder):
    assert folder.names() == ["a.traj", "below/b.traj"]


def test_a_drawing_is_read_and_saved(folder):
    folder.save("a.traj", "# other\n")
    folder.save("below/new.traj", "# new\n")

    assert folder.read("a.traj") == "# other\n"
    assert folder.read("below/new.traj") == "# new\n"


@pytest.mark.parametrize(
    "name",
    ["../secret.traj", "/etc/passwd", "link.traj", "out/secret.traj", "notes.txt", "", "a\0.traj",
     "below/../../secret.traj", "..\\secret.traj", "a"],
)  # fmt: skip
def test_nothing_outside_is_read_or_written(folder, name):
    with pytest.raises(UsageError):
        folder.read(name)
    with pytest.raises(UsageError):
        folder.save(name, "# written")
    assert (folder.root.parent / "secret.traj").read_text() == "# outside"


def test_a_text_that_is_too_large_or_no_text(folder):
    with pytest.raises(UsageError, match="2,000,000"):
        folder.save("a.traj", "x" * (LARGEST_TEXT + 1))
    (folder.root / "a.traj").write_bytes(b"\xff\xfe")
    with pytest.raises(DqpaintError, match="UTF-8"):
        folder.read("a.traj")

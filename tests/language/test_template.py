"""A first drawing: it reads well, draws well, and overwrites nothing."""

import pytest

from dqpaint.errors import DqpaintError
from dqpaint.language.writing.formatter import formatted
from dqpaint.language.writing.template import start
from dqpaint.planning.check import check


def test_it_is_a_drawing_that_the_default_arm_reaches(tmp_path):
    path = start(str(tmp_path / "flower"))
    text = path.read_text("utf-8")
    assert text.startswith("# flower.traj - ")
    assert formatted(text) == text
    result = check(str(path), robot="iiwa")
    assert (result.diagnostics, result.fault) == ((), "")
    assert result.forecast is not None
    assert "iiwa reaches it" in result.forecast.text
    assert 5 < result.forecast.motion.t[-1] < 30
    assert text.count("#") > 6


def test_a_file_that_is_there_stays(tmp_path):
    (tmp_path / "mine.traj").write_text("hold 1 s\n")
    for name in ("mine", "mine.traj"):
        with pytest.raises(DqpaintError, match="is there already"):
            start(str(tmp_path / name))
    assert [path.name for path in tmp_path.iterdir()] == ["mine.traj"]
    assert (tmp_path / "mine.traj").read_text() == "hold 1 s\n"


@pytest.mark.parametrize(
    "name", ["", ".traj", "no/such/folder", "x" * 300, "a\nb", "a/", "a\0b", " "]
)
def test_names_that_are_none(tmp_path, monkeypatch, name):
    monkeypatch.chdir(tmp_path)
    with pytest.raises(DqpaintError):
        start(name)
    assert not list(tmp_path.iterdir())

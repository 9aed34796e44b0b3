"""Drawings, previews and paintings in a notebook: text in place of a file, pictures, a frame."""

import sys
from types import ModuleType

import numpy as np
import pytest

import dqpaint
from dqpaint.errors import UsageError
from dqpaint.language import ScriptError
from tests.support.commands import LINE

PNG = b"\x89PNG\r\n"
SMALL = {"size": (64, 36)}


@pytest.fixture(scope="module")
def painting():
    return dqpaint.draw(text=LINE, plant="ideal", **SMALL)


def test_a_text_is_drawn_as_its_file(painting, tmp_path):
    (tmp_path / "line.traj").write_text(LINE)
    of_file = dqpaint.draw(tmp_path / "line.traj", plant="ideal", **SMALL)
    assert np.array_equal(painting.image, of_file.image)
    assert painting.sha256 == of_file.sha256
    shown = dqpaint.preview(text=LINE, **SMALL)
    assert np.array_equal(shown.image, dqpaint.preview(tmp_path / "line.traj", **SMALL).image)
    assert [path.name for path in dqpaint.save(painting, tmp_path, "png")] == ["text-hinf.png"]


def test_text_or_drawing_but_not_both():
    for call in (dqpaint.draw, dqpaint.preview):
        with pytest.raises(UsageError, match="text="):
            call()
        with pytest.raises(UsageError, match="text="):
            call("star", text=LINE)
        with pytest.raises(ScriptError, match=r"text\.traj:1"):
            call(text="lin to (0, 0) mm\n")


def test_a_notebook_shows_them(painting):
    shown = dqpaint.preview(text=LINE, **SMALL)
    for one in (painting, shown):
        assert one._repr_png_().startswith(PNG)
        assert "text.traj" in repr(one)
    d = dqpaint.Drawing("wave")
    d.start(at=(0, 0))
    d.comment("<b> & co")
    assert d._repr_html_().startswith("<pre>")
    assert "# &lt;b&gt; &amp; co" in d._repr_html_()
    d.write("lin to <i>")
    assert "<i>" not in d._repr_html_()  # the mistakes, not a traceback


def test_the_table_as_a_frame(painting, monkeypatch):
    pandas = ModuleType("pandas")
    pandas.DataFrame = lambda table: ("frame", table)
    monkeypatch.setitem(sys.modules, "pandas", pandas)
    assert painting.to_frame() == ("frame", painting.table)
    monkeypatch.setitem(sys.modules, "pandas", None)
    with pytest.raises(UsageError, match="pandas"):
        painting.to_frame()


def test_the_frame_of_pandas_itself(painting):
    pytest.importorskip("pandas")
    frame = painting.to_frame()
    assert list(frame.columns) == list(painting.table)
    assert len(frame) == len(painting.motion.t)

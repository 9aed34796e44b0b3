"""A cell of a notebook is a drawing: a picture of what is asked for, or a run of a law."""

import numpy as np
import pytest

import dqpaint
from dqpaint.editors.notebook_cells import KEYWORDS, read_options, traj
from dqpaint.errors import UsageError
from dqpaint.settings import SETTINGS
from tests.support.commands import LINE


def test_what_options_stand_for():
    line = '--controller p --gain k=5 --ghost --size=64x36 --disturb "twist=x=1" --disturb noise=1'
    assert read_options(line) == {
        "controller": "p", "gains": "k=5", "ghost": True, "size": "64x36",
        "disturb": ["twist=x=1", "noise=1"],
    }  # fmt: skip
    assert read_options("") == {}
    with pytest.raises(UsageError, match="star"):
        read_options("star --size 64x36")


def test_every_option_has_its_keyword():
    for keyword, setting in SETTINGS.items():
        assert KEYWORDS.get(setting.name, setting.name.replace("-", "_")) == keyword


def test_a_cell_is_what_it_would_be_elsewhere(capsys):
    shown = traj("--size 64x36", LINE)
    assert np.array_equal(shown.image, dqpaint.preview(text=LINE, size=(64, 36)).image)
    ran = traj("--size 64x36 --plant ideal --controller p --gain k=7", LINE)
    same = dqpaint.draw(text=LINE, size=(64, 36), plant="ideal", controller="p", gains="k=7")
    assert np.array_equal(ran.image, same.image)
    assert ran._repr_html_() if hasattr(ran, "_repr_html_") else ran._repr_png_()
    assert capsys.readouterr().err == ""


@pytest.mark.parametrize(("line", "cell", "said"), [
    ("", "line to (0, 0, 70)\n", "E218"), ("--controler p", LINE, "controller"),
    ("star", LINE, "%%traj"), ("--size 9", LINE, "size"), ("--text star", LINE, "text"),
    ("--progress 1", LINE, "progress"), ('--gain "k=5', LINE, "quotation"),
])  # fmt: skip
def test_a_fault_is_told_and_is_no_picture(line, cell, said, capsys):
    assert traj(line, cell) is None
    assert said in capsys.readouterr().err


def test_it_is_loaded_by_the_name_of_the_package():
    class Shell:
        def register_magic_function(self, *given):
            self.given = given

    shell = Shell()
    dqpaint.load_ipython_extension(shell)
    assert shell.given == (traj, "cell", "traj")

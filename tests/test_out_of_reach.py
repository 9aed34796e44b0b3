"""Drawings that leave the reach: found wherever it happens, with distance and advice that hold."""

import re

import numpy as np
import pytest

from dqpaint.language import ScriptError, parse
from dqpaint.paint import paint
from dqpaint.settings import make_settings

SETTINGS = make_settings(plant="ideal", width=64, height=36)


def refused(text):
    with pytest.raises(ScriptError) as caught:
        paint(parse(text, "far.traj"), SETTINGS)
    return str(caught.value)


@pytest.mark.slow
def test_a_stroke_that_leaves_the_reach_between_the_rows_of_the_forecast_is_found_by_the_run():
    """A short bulge among 600 strokes that stay at home."""
    home = "repeat 150\n  line by (0.5, 0) mm\n  line by (-0.5, 0) mm\nend\n"
    out = "curve (0, 0, 400 mm * sin(t)) for t from 0 to 180 deg in 0.6 s\n"
    message = refused("period 8 ms\n" + home + out + home)
    assert "--> far.traj:6:1" in message
    assert "farthest point of this line" in message


@pytest.mark.slow
def test_the_farthest_point_is_named_with_about_its_distance():
    message = refused("hold 1 s\nline to (0, 0, 900) mm\n")
    found = re.search(r"sample \d+ \((\d+\.\d+) s\) is (\d+) mm", message)
    assert float(found[1]) == pytest.approx(1 + 900 / 100 * 1.25, abs=0.02)  # the end of the line
    # the shoulder stands 0.36 m high, the stretched arm with its lamp ends 0.82 + 0.161 m away
    assert float(found[2]) == pytest.approx(1e3 * (np.hypot(1.6 - 0.161, 0.14) - 0.82), rel=0.1)


@pytest.mark.slow
def test_the_advised_scale_is_reached_and_a_larger_one_is_not():
    text = "move to (0, 0, 0)\nline to (0, 0, 500) mm\n"
    scale = float(re.search(r"with scale (\d\.\d+)", refused(text))[1])
    paint(parse(f"with scale {scale}\n{text}end\n", "a"), SETTINGS)
    refused(f"with scale {scale + 0.1}\n{text}end\n")


@pytest.mark.slow
def test_a_tool_that_cannot_turn_so_is_told_apart_from_a_distance():
    message = refused("line to (0, 0) mm tool rpy(180 deg, 0, 0)\n")
    assert re.search(r"and \d+ deg outside the reach|only with the tool turned", message)
    assert "turn the tool another way" in message

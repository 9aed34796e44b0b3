"""Boxes, whiskers and what lies beyond, as matplotlib works them out."""

import numpy as np
import pytest
from matplotlib.cbook import boxplot_stats

from dqpaint.studies.experiment.cells import Cell, find_figure
from dqpaint.studies.kinds.compare import boxes
from dqpaint.studies.replay.measures import MeasureRequest, single_runs
from dqpaint.studies.replay.papers import read_paper
from dqpaint.studies.report.box_plots import box_plot
from dqpaint.studies.runner.run import Result


@pytest.mark.parametrize("count", [4, 5, 50])
def test_a_box_is_that_of_matplotlib(rng, count):
    groups = {name: rng.standard_t(2, count) + 3 * i for i, name in enumerate("abc")}
    panel = box_plot("t", "y", groups)
    assert panel.ticks == ["a", "b", "c"]
    outline = panel.lines[0]
    parts = np.split(outline.y, np.flatnonzero(np.isnan(outline.x)))
    for at, (part, values) in enumerate(zip(parts, groups.values(), strict=False)):
        (right,) = boxplot_stats(values)
        here = np.unique(part[np.isfinite(part)])
        expected = [right[n] for n in ("whislo", "q1", "med", "q3", "whishi")]
        np.testing.assert_allclose(here, np.unique(expected))
        dots = [line for line in panel.lines if not line.width]
        beyond = dots[0].y[dots[0].x == at] if dots else []
        np.testing.assert_allclose(np.sort(beyond), np.sort(right["fliers"]))
        wide = outline.x[np.isin(outline.y, right["med"])]
        assert (wide.min(), wide.max()) == (at - 0.3, at + 0.3)
    assert len(parts) == len(groups) + 1  # and the last gap


def test_few_numbers_are_dots():
    panel = box_plot("t", "y", {"a": [1.0, 2.0, 4.0], "none": []})
    (dots,) = panel.lines
    assert (dots.width, dots.y.tolist(), dots.label) == (0.0, [1.0, 2.0, 4.0], "runs")


def test_a_comparison_of_many_runs_has_boxes_of_those_that_are_results():
    def cell(name, *words):
        results = (Result(w, w, "", {"error_integral": 1.0 + i}) for i, w in enumerate(words))
        return Cell({"controller": name}, tuple(results))

    many = [cell("p", *["done"] * 5, "clipped"), cell("pff", "done", "oscillates")]
    figure = find_figure("error_integral", many)
    (panel,) = boxes(many, figure)["-boxes"].panels
    assert panel.ticks == ["p", "pff"]
    assert np.nanmax(panel.lines[0].y) == 5.0
    assert panel.lines[1].x.tolist() == [1.0]
    assert boxes([cell("p", "done", "done")], figure) == {}


def test_single_runs_have_a_box_a_law_and_section(tmp_path):
    made = single_runs.single_runs(read_paper("thesis-runs"), MeasureRequest(tmp_path))
    panels = made.shown["-boxes"].panels
    assert [panel.title.partition(":")[0] for panel in panels] == [
        "E.6.1", "E.6.2", "E.6.3", "E.1", "E.4",
    ]  # fmt: skip
    assert all(len(panel.ticks) == 6 for panel in panels)
    known = single_runs.read_runs()["E.6.3", "K"]["error_integral"]
    assert np.isin(np.median(known), panels[2].lines[0].y)

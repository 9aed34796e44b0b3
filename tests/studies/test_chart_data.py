"""What a page's scripts are given to draw: few points, no peak lost, no number that is none."""

import json

import numpy as np

from dqpaint.studies.report import chart_data
from dqpaint.studies.report.charts import HeatMap, Line, Panel

T = np.linspace(0, 10, 4000)
PEAK = Line(T, np.where(np.arange(4000) == 2222, 50.0, 2.0), "a peak", "#123456")
MARKED = Line(T, T, "marked", marks=np.zeros(4000, dtype=bool))


def test_lines_are_thinned_and_keep_their_peaks():
    for most in (chart_data.MOST_POINTS, 200):
        thin = chart_data.thinned(PEAK, most)
        assert len(thin.x) <= most + 2
        assert thin.y.max() == 50.0
        assert (thin.x[0], thin.x[-1]) == (T[0], T[-1])
        assert np.all(np.diff(thin.x) > 0)
        assert (thin.label, thin.colour) == (PEAK.label, PEAK.colour)
    assert chart_data.thinned(MARKED) is MARKED


def test_what_is_drawn_is_json_and_says_all():
    line = Line(
        np.array([1.0, 2.0]), np.array([np.nan, 1 / 3]), "one", bars=np.array([0.1, np.inf])
    )
    panel = Panel("a", "k [1/s]", "mm", [line, PEAK], wall=3.0, limit="most", span=(0.1, 2.0))
    data = json.loads(json.dumps(chart_data.of_panel(panel, 100), allow_nan=False))
    assert data["lines"][0]["y"] == [None, 0.333333]
    assert data["lines"][0]["bars"] == [0.1, None]
    assert data["lines"][0]["colour"] != data["lines"][1]["colour"] == "#123456"
    assert len(data["lines"][1]["x"]) <= 102
    assert (data["wall"], data["bound"], data["limit"], data["span"]) == (
        3.0,
        None,
        "most",
        [0.1, 2],
    )
    given = HeatMap("m", "k", "q", ("1",), ("2", "3"), np.array([[np.nan], [7.0]]),
                    np.array([[False], [True]]))  # fmt: skip
    data = json.loads(json.dumps(chart_data.of_map(given), allow_nan=False))
    assert (data["values"], data["marked"]) == ([[None], [7.0]], [[False], [True]])

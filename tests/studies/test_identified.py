"""The fit of a plant to one law's table: its least squares, and what it says of what remains."""

import numpy as np
import pytest

from dqpaint.errors import UsageError
from dqpaint.studies.experiment.statistics import Spread
from dqpaint.studies.replay.claims import published
from dqpaint.studies.replay.measure import MeasureRequest
from dqpaint.studies.replay.measures import identified
from dqpaint.studies.replay.papers import Paper, read_paper

PAPER = read_paper("thesis-identified")


def numbers(truth):
    """Numbers of an arm whose laws of errors are known, by the values of its plant."""
    gain = {"K, ln2^2": 60.0, "K, best": 125.0}
    found = {}
    for cell in PAPER.cells:
        load, lag = 0.5 / truth["scale"], 3 / truth["torque"]
        k = gain.get(cell.name, 100.0)
        row = {
            "error_integral": load / k + lag, "command_integral_rad": load,
            "effort_integral": 1 / (1 + lag), "speed_integral_m": 3 - truth["damping"],
            "acceleration_integral": 1.0,
        }  # fmt: skip
        found[cell.name] = {name: Spread(1, value, np.nan) for name, value in row.items()}
    return found


def test_least_squares_finds_the_minimum_in_few_evaluations(rng):
    """A curved problem of known minimum, residuals that do not vanish there."""
    A, truth = rng.normal(size=(8, 3)), np.array([0.4, -0.7, 0.2])
    asked = []

    def residuals(x):
        asked.append(x)
        return A @ (x - truth) + 0.05 * (x[0] - truth[0]) ** 2

    x, r, sets = identified.least_squares(residuals, np.zeros(3))
    assert sets == len(asked) <= 4 + identified.ROUNDS
    np.testing.assert_allclose(x, truth, atol=0.01)
    assert identified.rms(r) < 0.01


def test_a_step_that_makes_it_worse_is_not_kept():
    def residuals(x):
        return np.array([np.sin(3 * x[0]) + 2.0, 0.1 * x[0]])

    start = np.array([0.5])
    _, r, _ = identified.least_squares(residuals, start)
    assert identified.rms(r) <= identified.rms(residuals(start))


@pytest.mark.parametrize("edge", [0.15, 0.5, 0.9])
def test_runs_without_numbers_say_nothing_of_the_derivative(edge):
    """Beyond an edge nothing is known: of a first difference (0.15), or where a step leads.

    Taken for a large residual instead, it leaves the minimum 0.05 to 0.24 away.
    """
    A = np.array([[0.6, 0.3], [0.3, -0.45], [0.15, 0.24]])
    truth = np.array([edge - 0.1, 1.2])
    lost = []

    def residuals(x):
        if x[0] > edge:
            lost.append(x)
            return np.full(3, np.nan)
        return A @ (x - truth) + 0.1 * (x[0] - truth[0]) * (x[1] - truth[1])

    x, r, sets = identified.least_squares(residuals, np.zeros(2))
    assert lost
    assert sets <= 5 + identified.ROUNDS
    np.testing.assert_allclose(x, truth, atol=0.005)
    assert not np.isnan(r).any()


def test_a_start_without_numbers_is_told_and_does_not_end_the_fit():
    _, r, _ = identified.least_squares(lambda x: np.full(3, np.nan), np.zeros(2))
    assert identified.rms(r) == pytest.approx(np.log(10))


def test_the_plant_that_made_the_numbers_is_found_again(monkeypatch):
    truth = {"scale": 0.3, "damping": 0.8, "torque": 70.0}
    fit = PAPER.fit
    seen = []

    def carried_out(paper, request, choices, keep):
        assert set(choices) == set(fit.cells)
        text = paper.settings["plant"]
        seen.append(text)
        return dict(part.split("=") for part in text.split(",")[3:])

    monkeypatch.setattr(identified, "carry_out", carried_out)
    monkeypatch.setattr(
        identified, "numbers_of",
        lambda paper, values: numbers({name: float(v) for name, v in values.items()}),
    )  # fmt: skip
    monkeypatch.setattr(identified, "published", lambda paper: numbers(truth))
    found = identified.find_values(PAPER, fit, MeasureRequest(folder=None))
    for name, value in truth.items():
        assert found.values[name] == pytest.approx(value, rel=0.05)
    assert found.residual < 0.01
    assert found.sets == len(seen)
    assert seen[0].startswith("servo:theta-gc,reference=measured,")
    assert seen[0].endswith(",scale=0.5,damping=0.5,torque=100")


def test_residuals_are_logarithms_and_a_lost_run_is_a_bad_one():
    theirs = published(PAPER)
    half = {
        "K, best": {"error_integral": Spread(1, 0.5 * 1.232, np.nan)},
        "K, ln2": {"error_integral": Spread(1, np.nan, np.nan)},
    }
    found = identified.log_ratios(theirs, half, ["K, best", "K, ln2", "HIR, best"],
                                  ["error_integral"])  # fmt: skip
    np.testing.assert_allclose(found, [np.log(0.5), np.nan, np.nan])
    assert identified.rms(found[1:]) == pytest.approx(np.log(10))


def test_what_remains_is_said_law_by_law():
    ours = {
        cell.name: {
            name: Spread(1, 1.1 * (value[0] if isinstance(value, tuple) else value), np.nan)
            for name, value in cell.published.items()
        }
        for cell in PAPER.cells
    }
    ours["HIR, best"]["error_integral"] = Spread(1, 100.0, np.nan)
    del ours["HIRT, best"]
    del ours["LQR in R8, ln2"], ours["LQR in R8, best"], ours["LQR in R8, ln2^2"]
    fitted = identified.Fitted({"scale": 0.25}, np.log(1.07), 9)
    lines = identified.said(PAPER, PAPER.fit, fitted, ours)
    assert "scale = 0.25" in lines[0]
    assert "7 %" in lines[0]
    assert len(lines) == 7
    said = {line.split(":")[0]: line for line in lines}
    assert "command [rad] 10 %" in said["predicted of K"]
    assert "acceleration" not in said["predicted of K"]
    assert "error 15 times" in said["predicted of HIR"]
    assert said["predicted of HIRT"].endswith("1 of 3 rows have no result")
    assert said["predicted of LQR in R8"].endswith("nothing; 3 of 3 rows have no result")


def test_its_rows_are_those_of_the_spiral():
    assert PAPER.cells == read_paper("thesis-spiral").cells


def test_it_fits_the_plant_and_takes_none():
    with pytest.raises(UsageError, match=r"thesis-identified.*--plant"):
        identified.identified(PAPER, MeasureRequest(folder=None, settings={"plant": "stiff"}))


def test_a_fit_to_rows_that_are_not_there_is_refused():
    data = PAPER.model_dump()
    data["fit"]["cells"] = ("K, worst",)
    with pytest.raises(ValueError, match="fit names"):
        Paper.model_validate(data)

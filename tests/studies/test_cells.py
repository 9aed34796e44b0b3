"""A row of a table: each figure in the unit that its heading names."""

import math

import numpy as np
import pytest

from dqpaint.studies.experiment.cells import Cell, columns, find_figure, rounded, rows
from dqpaint.studies.runner.run import Result

# What a run says in SI units, by name, and what the table says under which heading.
SAID = {
    "error_integral": (0.0125, "error integral", 1.0),
    "position_error_rms_m": (0.00325, "position rms [mm]", 1e3),
    "position_error_max_m": (0.0475, "position largest [mm]", 1e3),
    "orientation_error_rms_rad": (math.pi / 7, "orientation rms [deg]", 180 / math.pi),
    "command_integral_rad": (3.75, "command [rad]", 1.0),
    "speed_integral_m": (1.25, "path length [m]", 1.0),
}


def run(seed, factor):
    return Result(str(seed), "done", figures={n: factor * v for n, (v, _, _) in SAID.items()})


def test_figures_are_shown_in_the_units_of_their_headings():
    headings, row = rows([Cell({"law": "p"}, (run(0, 1.0),))])
    shown = dict(zip(headings, row, strict=True))
    for value, heading, scale in SAID.values():
        assert float(shown[heading]) == pytest.approx(value * scale, rel=5e-4)
    assert "effort [rad s]" not in shown  # of which no run says anything
    other = Cell({"law": "q"}, (Result("1", "done", figures={"effort_integral": 2.0}),))
    lines = rows([Cell({"law": "p"}, (run(0, 1.0),)), other])
    assert [line[lines[0].index("effort [rad s]")] for line in lines[1:]] == ["-", "2"]


def test_several_runs_are_shown_by_mean_and_spread():
    factors = [0.5, 1.0, 1.75]
    cell = Cell({"law": "p"}, tuple(run(k, factor) for k, factor in enumerate(factors)))
    headings, row = rows([cell])
    shown = dict(zip(headings, row, strict=True))
    for name, (value, heading, scale) in SAID.items():
        mean, std = (float(word) for word in shown[heading].split(" ± "))
        true = value * scale * np.std(factors, ddof=1)
        assert mean == pytest.approx(value * scale * np.mean(factors), abs=0.2 * true)
        assert std == pytest.approx(true, rel=0.2)
        assert columns([cell])[f"{name}_mean"] == pytest.approx([value * np.mean(factors)])


def test_a_command_has_the_unit_of_the_law_that_gives_it():
    def cell(name):
        return Cell({"law": name}, (Result("0", "done", figures={name: 1.0}),))

    rates, torques = cell("command_integral_rad"), cell("torque_integral_Nm_s")
    for found, heading in (
        ([rates], "command [rad]"), ([torques], "command [Nm s]"),
        ([torques, rates], "command [rad, Nm s]"),
    ):  # fmt: skip
        assert heading in rows(found)[0]
        assert find_figure("torque_integral_Nm_s", found).heading == heading


@pytest.mark.parametrize(
    ("value", "spread", "shown"),
    [
        (1.183, 0.0074, "1.183 ± 0.007"), (0.006927, 9.8e-06, "0.006927 ± 0.000010"),
        (0.827, 0.119, "0.83 ± 0.12"), (0.827, 0.367, "0.8 ± 0.4"), (5.0, 0.0, "5 ± 0"),
        (1234.5678, 36.0, "1230 ± 40"), (2.5e-7, 1.24e-8, "2.50e-07 ± 0.12e-07"),
        (0.0, 0.002, "0.0000 ± 0.0020"), (3.0, math.nan, "3 ± nan"),
        (2e7, 3e5, "2.000e+07 ± 0.030e+07"),
    ],
)  # fmt: skip
def test_digits_fit_the_spread(value, spread, shown):
    """The examples of the rule of the Particle Data Group, and hard ones."""
    assert " ± ".join(rounded(value, spread)) == shown


def test_a_figure_that_some_runs_lack_says_of_how_many_it_is():
    def of(*values):
        return Cell({"law": "p"}, tuple(
            Result(str(i), "done", figures={"error_integral": 1.0} | (
                {} if v is None else {"step_position_settling_s": v}))
            for i, v in enumerate(values)))  # fmt: skip

    for values, shown in (((0.4, None, 0.6), "0.50 ± 0.14 (of 2)"), ((0.4, 0.6), "0.50 ± 0.14")):
        heads, row = rows([of(*values)])
        assert row[heads.index("position settling [s]")] == shown

"""A paper's single runs -> their means, drift, and how much each run is like the one before."""

import csv
from collections import defaultdict
from collections.abc import Sequence

import numpy as np

from dqpaint.dq import Floats
from dqpaint.studies.experiment.statistics import spread, two_sided
from dqpaint.studies.replay.measure import MEASURES, MeasureRequest, MeasureResult
from dqpaint.studies.replay.papers import Paper, find_paper_drawing
from dqpaint.studies.report.box_plots import box_plot
from dqpaint.studies.report.charts import Line, Panel
from dqpaint.studies.report.page import Charts

LAWS = "K", "K+FF", "LQR in R8", "LQR in DQ", "HIR", "HIRT"
CHANCE = "chance"  # the cell with what independent runs stay below, 39 of 40 times
Runs = dict[tuple[str, str], dict[str, Floats]]
"""By section and law, the values (N,) of each figure in the order of the runs."""


def read_runs() -> Runs:
    """The single runs of the thesis's appendix E, as far as its text has them."""
    lists: dict[tuple[str, str], dict[str, list[float]]] = defaultdict(lambda: defaultdict(list))
    path = find_paper_drawing("thesis-hinf").with_name("thesis-appendix-e.csv")
    with path.open(newline="", encoding="utf-8") as file:
        for row in csv.DictReader(file):
            for law in LAWS:
                if row[law]:
                    lists[row["section"], law][row["figure"]].append(float(row[law]))
    return {key: {n: np.array(v) for n, v in rows.items()} for key, rows in lists.items()}


@MEASURES.add("single-runs")
def single_runs(paper: Paper, request: MeasureRequest) -> MeasureResult:
    """Every cell named `law, section` is worked out from its runs."""
    request.nothing_but(paper)
    runs = read_runs()
    numbers = {}
    for cell in paper.cells:
        law, _, section = cell.name.rpartition(", ")
        if cell.name == CHANCE:
            longest = max(
                len(rows["error_integral"]) for rows in runs.values() if "error_integral" in rows
            )
            numbers[cell.name] = {"likeness": spread([1.96 / np.sqrt(longest)])}
            continue
        own, first = runs[section, law], runs[section, LAWS[0]]["error_integral"]
        error = own["error_integral"]
        slope, chance = drift(error)
        numbers[cell.name] = {
            "error_integral": spread(error.tolist()),
            "command_integral_rad": spread(own["command_integral_rad"].tolist()),
            "drift": spread([slope]),
            "drift_chance": spread([chance]),
            "likeness": spread([correlation(error[1:], error[:-1])]),
            **({"with_k": spread([correlation(error, first)])} if law != LAWS[0] else {}),
        }
    count = sum(len(values) for rows in runs.values() for values in rows.values())
    ours = f"worked out from {count} printed numbers"
    return MeasureResult(numbers, ours, shown={
        "-runs": in_order_of_runs(paper, runs), "-boxes": boxed(paper, runs),
    })  # fmt: skip


def drift(values: Floats) -> tuple[float, float]:
    """The change of values (N,) from the first to the last by a fitted line, as a part of the mean.

    And the chance of so large a one among independent runs, by Student's t.
    """
    n = len(values)
    at = np.arange(n) - (n - 1) / 2
    slope = float(at @ values / (at @ at))
    left = values - values.mean() - slope * at
    error = float(np.sqrt(left @ left / (n - 2) / (at @ at)))
    return slope * (n - 1) / float(values.mean()), two_sided(slope / error, n - 2)


def correlation(one: Floats, other: Floats) -> float:
    """Of two rows of values (N,), from -1 to 1."""
    return float(np.corrcoef(one, other)[0, 1])


def in_order_of_runs(paper: Paper, runs: Runs) -> Charts:
    """The error of each run by its number, and how the runs are distributed, a panel a section."""
    names = [cell.name.rpartition(", ")[::2] for cell in paper.cells if cell.name != CHANCE]
    sections = dict.fromkeys(section for _, section in names)

    def lines(section: str, ordered: bool) -> list[Line]:
        of = [(law, runs[section, law]["error_integral"]) for law, at in names if at == section]
        if ordered:
            return [Line(np.arange(1.0, len(v) + 1), v, law) for law, v in of]
        return [Line(np.sort(v) / v.mean(), _shares(v), law) for law, v in of]

    panels = [Panel(f"{section}: error of each run", "run", "error", lines(section, True))
              for section in sections]  # fmt: skip
    panels += [Panel(f"{section}: distribution", "error by its mean", "share of runs below",
                     lines(section, False)) for section in sections]  # fmt: skip
    return Charts("The single runs, in their order and by their size", panels, shared=True)


def boxed(paper: Paper, runs: Runs) -> Charts:
    """The errors of each law as a box plot, a panel a section."""
    names = [cell.name.rpartition(", ")[::2] for cell in paper.cells if cell.name != CHANCE]
    sections = dict.fromkeys(section for _, section in names)
    panels = [
        box_plot(f"{section}: error", "error", {
            law.replace(" in ", " "): runs[section, law]["error_integral"]
            for law, at in names if at == section
        })
        for section in sections
    ]  # fmt: skip
    return Charts("The single runs as box plots", panels, shared=True, columns=2)


def _shares(values: Sequence[float] | Floats) -> Floats:
    return (np.arange(len(values)) + 0.5) / len(values)

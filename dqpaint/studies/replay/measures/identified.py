"""A paper's tables -> a plant fitted to one law's rows, and its predictions of all the others.

Nothing is tuned by hand: values begin where the replay's file says, Levenberg and Marquardt's
method moves them, and what remains is printed, whatever it is.
"""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np

from dqpaint.dq import Floats
from dqpaint.errors import UsageError
from dqpaint.studies.experiment.cells import split_label
from dqpaint.studies.replay.claims import Numbers, published
from dqpaint.studies.replay.measure import MEASURES, MeasureRequest, MeasureResult
from dqpaint.studies.replay.measures.tracking import (
    KEPT,
    beside_published,
    carry_out,
    measured,
    numbers_of,
    settings_of,
)
from dqpaint.studies.replay.papers import Fit, Paper
from dqpaint.studies.report.pictures import pictures

CHANGE = 0.2  # of a transformed value, for the derivative
FARTHEST = 1.0  # of a transformed value in one step
ROUNDS = 6  # steps after the first derivative; each is one more set of runs
ENOUGH = 0.002  # of the residual: a step that gains less is the last
LOST = np.log(10.0)  # what a residual counts for that is nan: its run has no numbers

Residuals = Callable[[Floats], Floats]


@dataclass(frozen=True)
class Fitted:
    """What was found.

    Attributes:
        values: of the plant, by their names.
        residual: root of the mean square of ln(here / paper) over the numbers fitted to.
        sets: how many sets of runs it took.
    """

    values: Mapping[str, float]
    residual: float
    sets: int


@MEASURES.add("identified")
def identified(paper: Paper, request: MeasureRequest) -> MeasureResult:
    """The fit, then every cell of the tables under the fitted plant."""
    fit = paper.fit
    assert fit is not None
    if "plant" in request.settings:
        raise UsageError(f"replay '{paper.name}' takes no --plant: it fits one to the paper")
    found = find_values(paper, fit, replace(request, runs=1))
    fitted = under(paper, fit, found.values)
    choices = {cell.name: cell.settings for cell in paper.cells}
    cells = carry_out(fitted, request, choices, KEPT)
    numbers = numbers_of(paper, cells)
    beside = beside_published(paper, numbers)
    shown = pictures(cells, request.folder, settings_of(fitted, request, {}))
    made = measured(fitted, request, cells, {**beside, **shown})
    return replace(made, ours="\n".join([*said(paper, fit, found, numbers), made.ours]))


def under(paper: Paper, fit: Fit, values: Mapping[str, float]) -> Paper:
    """The experiment on the plant with some values."""
    plant = fit.plant.format(**{name: f"{value:.6g}" for name, value in values.items()})
    return paper.model_copy(update={"settings": {**paper.settings, "plant": plant}})


def find_values(paper: Paper, fit: Fit, request: MeasureRequest) -> Fitted:
    """Fit a plant's values to the numbers of some cells.

    Raises:
        DqpaintError: every run of a set failed.
    """
    names = list(fit.parameters)
    low, high, start = (
        np.array([getattr(fit.parameters[name], part) for name in names])
        for part in ("low", "high", "start")
    )
    theirs = published(paper)
    cells = {cell.name: cell for cell in paper.cells}

    def values(x: Floats) -> Floats:
        return np.asarray(low + (high - low) / (1 + np.exp(-x)))

    def residuals(x: Floats) -> Floats:
        tried = under(paper, fit, dict(zip(names, values(x).tolist(), strict=True)))
        choices = {name: cells[name].settings for name in fit.cells}
        ours = numbers_of(paper, carry_out(tried, request, choices, ()))
        return log_ratios(theirs, ours, fit.cells, fit.figures)

    begin = np.log((start - low) / (high - start))
    x, r, sets = least_squares(residuals, begin)
    return Fitted(dict(zip(names, values(x).tolist(), strict=True)), rms(r), sets)


def least_squares(residuals: Residuals, start: Floats) -> tuple[Floats, Floats, int]:
    """The parameters (n,) of least squared residuals (m,), with few evaluations.

    Levenberg and Marquardt's steps on a derivative taken once by differences and renewed after each
    step by Broyden's formula: 1 + 2 n + ROUNDS evaluations at the most. A residual of nan is one of
    a run without numbers: what it says of a derivative is nothing, so no difference to it is
    taken, and the step that led there is halved.

    Returns:
        Parameters, residuals, number of evaluations.
    """
    x, r = start.copy(), residuals(start)
    sets, caution, farthest = 1, 0.01, FARTHEST
    columns = []
    for along in CHANGE * np.eye(len(x)):
        for aside in (along, -along):
            change = residuals(x + aside) - r
            sets += 1
            if not np.isnan(change).any():
                break
        columns.append(change / aside.sum())
    J = np.nan_to_num(np.stack(columns, axis=1))
    for _ in range(ROUNDS):
        normal = J.T @ J
        damped = normal + caution * np.diag(np.diag(normal) + 1e-9)
        pull = J.T @ np.nan_to_num(r, nan=LOST)
        step = np.clip(-np.linalg.solve(damped, pull), -farthest, farthest)
        tried = residuals(x + step)
        sets += 1
        change = tried - r - J @ step
        if np.isnan(change).any():
            farthest = float(np.abs(step).max()) / 2
            continue
        J += np.outer(change, step) / max(float(step @ step), 1e-12)
        gain = rms(r) - rms(tried)
        if gain > 0:
            x, r, caution = x + step, tried, caution / 4
        else:
            caution *= 10
        if 0 <= gain < ENOUGH:
            break
    return x, r, sets


def log_ratios(
    theirs: Numbers, ours: Numbers, cells: Sequence[str], figures: Sequence[str]
) -> Floats:
    """ln(ours / theirs) of every figure of every cell; nan where ours is missing."""
    found = []
    for cell in cells:
        for figure in figures:
            if figure not in theirs[cell]:
                continue
            one = ours.get(cell, {}).get(figure)
            good = one is not None and one.mean > 0
            found.append(np.log(one.mean / theirs[cell][figure].mean) if one and good else np.nan)
    return np.array(found)


def rms(values: Floats) -> float:
    """The root of the mean square; of a nan, that of LOST."""
    return float(np.sqrt(np.mean(np.nan_to_num(values, nan=LOST) ** 2)))


def said(paper: Paper, fit: Fit, found: Fitted, ours: Numbers) -> list[str]:
    """What was fitted to what, and what remains of it and of every prediction, a line each."""
    theirs = published(paper)
    values = ", ".join(f"{name} = {value:.3g}" for name, value in found.values.items())
    count = len(log_ratios(theirs, ours, fit.cells, fit.figures))
    lines = [
        f"fitted: {values}, to {count} numbers of {'; '.join(fit.cells)} in {found.sets} sets of "
        f"runs; left over: they are off by {off(found.residual)} (root mean square)",
    ]
    families: dict[str, list[str]] = {}
    for cell in paper.cells:
        if cell.name not in fit.cells:
            families.setdefault(split_label(cell.name)[0], []).append(cell.name)
    for family, names in families.items():
        known = [name for name in names if name in ours]
        parts = [
            f"{figure.says} {off(rms(log_ratios(theirs, ours, known, [figure.name])))}"
            for figure in paper.figures
            if known and figure.name in fit.figures
        ]
        text = f"off by {', '.join(parts)}" if parts else "nothing"
        if lost := len(names) - len(known):
            text += f"; {lost} of {len(names)} rows have no result"
        lines.append(f"predicted of {family}: {text}")
    return lines


def off(residual: float) -> str:
    """A residual of logarithms as a factor: 12 %, or 3.4 times."""
    factor = float(np.exp(residual))
    return f"{100 * (factor - 1):.0f} %" if factor < 2 else f"{factor:.2g} times"

"""A drawing and ranges of gains -> the gains with the least error within an effort bound.

minimise error(gains)  subject to  effort(gains) <= bound x what the drawing itself needs

Two of SciPy's optimisers seek it, neither of which wants a derivative. Differential evolution (R.
Storn and K. Price, J. Global Optimization 11, 1997) finds the region: it is not held up by noise or
the cliffs where a loop becomes unstable, and asks for a whole generation at once, which the workers
share. COBYQA (T. Ragonneau, Hong Kong Polytechnic University, 2022), a trust-region method that
knows bounds such as ours, goes the rest of the way, a run at a time. The first draws from a seeded
generator, the second from nothing, and both are fed from the study's record. So they take the same
way again: a study that was stopped goes on, and its answer is the same bit for bit, whatever the
number of workers.
"""

import math
from collections.abc import Callable, Sequence
from pathlib import Path

import numpy as np
from scipy.optimize import (
    Bounds,
    NonlinearConstraint,
    OptimizeResult,
    differential_evolution,
    minimize,
)

from dqpaint.controllers import find_controller
from dqpaint.dq import Floats
from dqpaint.errors import DqpaintError, UsageError
from dqpaint.settings import SMALLEST, Settings
from dqpaint.studies.experiment.axes import with_choice
from dqpaint.studies.experiment.cells import Cell, find_figure, run_cells
from dqpaint.studies.experiment.gain_range import Range, parse_range
from dqpaint.studies.kinds.study_request import StudyRequest
from dqpaint.studies.kinds.tuning import Tuning
from dqpaint.studies.runner.engine import Study, check
from dqpaint.studies.runner.run import Run, seeded

PER_GAIN = 8  # of a generation
MOST_GAINS = 4
ALIKE = 0.3  # part of the error by which a generation differs when the region is found
FIRST_STEP, LAST_STEP = 0.03, 2e-4  # of the second search, as parts of the ranges
LOCAL = 16  # runs that are left to it, a gain
ABOUT = 10.0  # a gain nobody gave a range is sought from a tenth to ten times its usual value
BEYOND = 1e30  # above any error: gains that cost too much, the dearer the worse
REFERENCE = "hinf"
MOST_RUNS = 100_000
Gains = tuple[float, ...]
"""Values of the gains that are sought, in the order of their ranges."""


def tune(
    request: StudyRequest,
    texts: Sequence[str],
    factor: float,
    error: str,
    effort: str,
    count: int,
    budget: int,
) -> Tuning:
    """Seek gains of a law.

    Args:
        request: the drawing, its settings, the folder and the workers; the first run and the
            search have the settings' seed.
        texts: where which gains are sought, as in "k=1..100"; none for all of the law's.
        factor: the most effort, over what the drawing itself needs.
        error: name of the figure that is to be small.
        effort: name of the figure that is bounded.
        count: how many runs each, with the seeds that follow.
        budget: the most runs.

    Raises:
        DqpaintError: a fault in the drawing, the choices or the folder.
    """
    base = request.settings()
    ranges = _ranges(texts, base)
    least = 1 + (generation(len(ranges)) + LOCAL * len(ranges)) * max(count, 1)
    if not least <= budget <= MOST_RUNS:
        raise UsageError(
            f"the budget must be {least} to {MOST_RUNS:,} runs for gains "
            f"{', '.join(one.name for one in ranges)} and --runs {count}, not {budget} runs"
        )
    if not (math.isfinite(factor) and factor > 0):
        raise UsageError(f"effort {factor:g} is no bound: write 1.1 for 10 % more than is needed")
    name, text = request.drawing
    small = base.model_copy(update={"width": SMALLEST, "height": SMALLEST})
    torque = find_controller(base.controller).drives_torque
    reference = Run(name, text, _undisturbed(small, torque))

    def runs_of(gains: Gains) -> list[Run]:
        choice = {f"gain.{name}": value for name, value in _choice(ranges, gains).items()}
        return seeded(Run(name, text, with_choice(small, choice)), count)

    ends = [tuple(r.low for r in ranges), tuple(r.high for r in ranges)]
    check([reference, *(run for end in ends for run in runs_of(end)[:1])])
    with Study(request.folder, request.jobs, request.study, budget, request.reporter) as study:
        (first,) = study.results([reference])
        if first.status != "done":
            raise DqpaintError(f"the effort that the drawing needs is not known: {first.message}")
        whole = Cell({}, (first,))
        figures = find_figure(error, [whole]), find_figure(effort, [whole])
        needed = whole.spread(figures[1]).mean

        def cost(cell: Cell) -> tuple[float, float]:
            effort = cell.spread(figures[1]).mean / (factor * needed)
            return (cell.spread(figures[0]).mean, effort) if cell.stable else (math.inf, math.inf)

        search = _Search(study, ranges, runs_of, cost, (budget - 1) // max(count, 1))
        usual = _usual(base, ranges)
        settled = search.seek(usual, base.seed)
    if study.known:
        tried = 1 + len(search.cells) * count
        request.reporter.note(f"{study.known} of {tried} runs were done before")
    return Tuning(
        name=Path(name).name, settings=base, cells=tuple(search.cells.values()),
        folder=request.folder, text=text, ranges=ranges,
        usual=search.cells[usual] if usual else None, error=figures[0], effort=figures[1],
        needed=needed, factor=factor, settled=settled,
    )  # fmt: skip


def generation(gains: int) -> int:
    """How many choices of so many gains are tried at once: Sobol's points are a power of two."""
    return 1 << (PER_GAIN * gains - 1).bit_length()


class _Search:
    """Gains in, error and effort by its bound out; each choice is run once."""

    def __init__(
        self,
        study: Study,
        ranges: Sequence[Range],
        runs_of: Callable[[Gains], list[Run]],
        cost: Callable[[Cell], tuple[float, float]],
        most: int,
    ) -> None:
        self.cells: dict[Gains, Cell] = {}
        self._study, self._ranges, self._runs_of, self._cost = study, ranges, runs_of, cost
        self._most, self._dimensions = most, [(0.0, 1.0)] * len(ranges)

    def seek(self, start: Gains | None, seed: int) -> bool:
        """Whether the search came to its end before the most choices were tried."""
        found = differential_evolution(
            self._ranked, self._dimensions, popsize=PER_GAIN, init="sobol", vectorized=True,
            updating="deferred", polish=False, tol=ALIKE, maxiter=self._most,
            x0=None if start is None else self._parts(start), callback=self._is_spent,
            rng=np.random.default_rng(seed),
        )  # fmt: skip
        scale = self._at(found.x)[0]
        left = self._most - len(self.cells)
        if not math.isfinite(scale) or left < LOCAL:
            return False
        # gains that cost too much are a wall to the first search, a slope to the second
        bound = NonlinearConstraint(lambda parts: self._at(parts)[1], -np.inf, 1.0)
        steps = {"initial_tr_radius": FIRST_STEP, "final_tr_radius": LAST_STEP, "maxfev": left}
        refined = minimize(
            lambda parts: self._at(parts)[0] / scale, found.x, method="COBYQA",
            bounds=Bounds(*zip(*self._dimensions, strict=True)), constraints=[bound],
            options=steps,
        )  # fmt: skip
        return bool(refined.success)

    def _parts(self, gains: Gains) -> list[float]:
        return [r.part(value) for r, value in zip(self._ranges, gains, strict=True)]

    def _gains(self, parts: Floats) -> Gains:
        return tuple(r.value(p) for r, p in zip(self._ranges, parts.tolist(), strict=True))

    def _is_spent(self, intermediate_result: OptimizeResult) -> bool:
        size, local = generation(len(self._ranges)), LOCAL * len(self._ranges)
        return len(self.cells) + size + local > self._most

    def _ranked(self, parts: Floats) -> Floats:
        """One number (S,) for each of parts (n, S): within the bound the error, else above any."""
        choices = [self._gains(column) for column in parts.T]
        self._run(choices)
        costs = [self._cost(self.cells[gains]) for gains in choices]
        return np.array([error if by <= 1 else BEYOND * by for error, by in costs])

    def _at(self, parts: Floats) -> tuple[float, float]:
        """Error and effort at one point."""
        gains = self._gains(np.clip(parts, 0.0, 1.0))
        self._run([gains])
        return self._cost(self.cells[gains])

    def _run(self, tried: Sequence[Gains]) -> None:
        new = [gains for gains in dict.fromkeys(tried) if gains not in self.cells]
        if not new:
            return
        choices = [_choice(self._ranges, gains) for gains in new]
        cells = run_cells(choices, [self._runs_of(gains) for gains in new], self._study.results)
        self.cells.update(zip(new, cells, strict=True))


def _ranges(texts: Sequence[str], base: Settings) -> tuple[Range, ...]:
    """Where gains are sought: as given, else about those that were not chosen."""
    found = [parse_range(text) for text in texts] or _usual_ranges(base)
    names = [one.name for one in found]
    twice = {n for n in names if names.count(n) > 1 or n in base.gains}
    if twice:
        raise UsageError(f"gain '{twice.pop()}' is chosen twice")
    if not 1 <= len(found) <= MOST_GAINS:
        raise UsageError(
            f"{len(found)} gains to tune; name 1 to {MOST_GAINS} with --vary, for example k=1..100"
        )
    return tuple(found)


def _usual_ranges(base: Settings) -> list[Range]:
    fields = find_controller(base.controller).gains.model_fields
    usual = {n: f.default for n, f in fields.items() if n not in base.gains}
    return [
        Range(name, value / ABOUT, value * ABOUT, True)
        for name, value in usual.items()
        if isinstance(value, int | float) and value > 0
    ]


def _usual(base: Settings, ranges: Sequence[Range]) -> Gains | None:
    """The law's own values of the gains, if it has some and they lie within the ranges."""
    fields = find_controller(base.controller).gains.model_fields
    values = [
        one.value(one.part(value))
        for one in ranges
        if one.name in fields
        and isinstance(value := fields[one.name].default, int | float)
        and one.low <= value <= one.high
    ]
    return tuple(values) if len(values) == len(ranges) else None


def _choice(ranges: Sequence[Range], gains: Gains) -> dict[str, str]:
    return {one.name: f"{value:g}" for one, value in zip(ranges, gains, strict=True)}


def _undisturbed(base: Settings, torque: bool) -> Settings:
    """What tells the effort that the drawing itself needs: an arm that does what is asked."""
    law = {} if torque else {"controller": REFERENCE, "plant": "ideal"}
    return base.model_copy(update={"gains": {}, "disturb": {}, "plant": None, **law})

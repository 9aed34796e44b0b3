"""Claims and numbers -> verdicts; the paper's numbers and ours are judged by the same rules.

Nothing here knows whose numbers they are. A verdict follows from the numbers alone, so two laws
that change places change it. What a number should be comes from elsewhere: for ours it is what the
paper prints, for the paper's what it prints in another place.
"""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from itertools import pairwise
from typing import Literal

import numpy as np

from dqpaint.core import Registry
from dqpaint.studies.experiment.statistics import LEVEL, Spread, holm, spread, welch
from dqpaint.studies.replay.papers import Claim, Paper

Numbers = Mapping[str, Mapping[str, Spread]]
"""Mean and spread, by the names of cell and figure; a cell without numbers may be missing."""
Word = Literal["holds", "fails", "in part", "not shown", "no numbers"]
PART = 0.5  # of a trend's steps that go its way, beyond which it holds in part
CLOSE = 1e-3  # of two means: a smaller difference is none, however well it is known


@dataclass(frozen=True)
class ClaimVerdict:
    """What a table of numbers says to a claim, and the numbers that decide it.

    `not shown`: the means differ by less than chance explains, or by less than 0.1 %.
    """

    word: Word
    why: str = ""

    def __str__(self) -> str:
        return f"{self.word}: {self.why}" if self.why else self.word


Rule = Callable[[Claim, Sequence[Spread], Sequence[Spread]], ClaimVerdict]
RULES: Registry[Rule] = Registry("kind of claim")


def published(paper: Paper) -> Numbers:
    """The paper's own numbers; a standard deviation that is not printed is unknown."""
    found: dict[str, dict[str, Spread]] = {}
    for cell in paper.cells:
        row = found.setdefault(cell.name, {})
        for name, value in cell.published.items():
            mean, std = value if isinstance(value, tuple) else (value, float("nan"))
            row[name] = Spread(paper.runs if isinstance(value, tuple) else 1, mean, std)
    return found


def printed_elsewhere(paper: Paper) -> Numbers:
    """What the paper's own numbers should be, as another place of it has them."""
    return {
        cell.name: {name: spread([value]) for name, value in cell.elsewhere.items()}
        for cell in paper.cells
    }


def judge(claim: Claim, paper: Paper, numbers: Numbers, standard: Numbers) -> ClaimVerdict:
    """What numbers say to a claim.

    Args:
        claim: of the paper.
        paper: for its grid.
        numbers: the paper's, or ours.
        standard: the numbers that `equals` compares with where the claim states none.
    """
    if claim.kind == "trend":
        return _trend(claim, paper, numbers)
    values = [numbers.get(name, {}).get(claim.figure) for name in claim.cells]
    known = [value for value in values if value is not None and np.isfinite(value.mean)]
    if len(known) < len(values):
        lost = [n for n, v in zip(claim.cells, values, strict=True) if v not in known]
        return ClaimVerdict(
            "no numbers", "" if len(lost) == len(values) else f"of {', '.join(lost)}"
        )
    rows = [standard.get(name, {}) for name in claim.cells]
    return RULES[claim.kind](claim, known, [r[claim.figure] for r in rows if claim.figure in r])


@RULES.add("order")
def _order(claim: Claim, values: Sequence[Spread], printed: Sequence[Spread]) -> ClaimVerdict:
    steps = list(pairwise(values))
    signs = ["<" if a.mean < b.mean else ">" if a.mean > b.mean else "=" for a, b in steps]
    why = f"{values[0].mean:.4g}"
    for sign, (_, b) in zip(signs, steps, strict=True):
        why += f" {sign} {b.mean:.4g}"
    differ = told_apart(steps)
    if any(sign != "<" and sure for sign, sure in zip(signs, differ, strict=True)):
        return ClaimVerdict("fails", why)
    return ClaimVerdict("holds" if all(differ) else "not shown", why)


def told_apart(pairs: Sequence[tuple[Spread, Spread]]) -> list[bool]:
    """Which pairs of means are shown to differ, all tests together at one level (Holm).

    Where nothing was repeated numbers stand; a difference of less than a thousandth is none.
    """
    tests = [welch(a, b) if np.isfinite([a.std, b.std]).all() else None for a, b in pairs]
    raised = iter(holm([test.p for test in tests if test]))
    chances = [next(raised) if test else 0.0 for test in tests]
    return [
        chance < LEVEL and abs(a.mean - b.mean) > CLOSE * max(abs(a.mean), abs(b.mean))
        for chance, (a, b) in zip(chances, pairs, strict=True)
    ]


@RULES.add("spread")
def _spread(claim: Claim, values: Sequence[Spread], printed: Sequence[Spread]) -> ClaimVerdict:
    stds = [value.std for value in values]
    if not np.isfinite(stds).all():
        return ClaimVerdict("no numbers", "needs several runs")
    rises = all(a < b for a, b in pairwise(stds))
    why = f"deviations {', '.join(f'{std:.4g}' for std in stds)}"
    return ClaimVerdict("holds" if rises else "fails", why)


@RULES.add("ratio")
def _ratio(claim: Claim, values: Sequence[Spread], printed: Sequence[Spread]) -> ClaimVerdict:
    first, second = values
    if second.mean == 0:
        return ClaimVerdict("no numbers", "divided by 0")
    found = first.mean / second.mean
    good = abs(found / claim.value - 1) <= claim.tolerance
    why = f"{found:.4g} for {claim.value:.4g} ± {claim.tolerance:.0%}"
    return ClaimVerdict("holds" if good else "fails", why)


@RULES.add("alike")
def _alike(claim: Claim, values: Sequence[Spread], printed: Sequence[Spread]) -> ClaimVerdict:
    first = values[0].mean
    if first == 0:
        good = all(value.mean == 0 for value in values)
        return ClaimVerdict("holds" if good else "fails", "beside 0")
    ratios = [value.mean / first for value in values[1:]]
    good = all(abs(ratio - 1) <= claim.tolerance for ratio in ratios)
    why = f"{', '.join(f'{ratio:.3g}' for ratio in ratios)} times for 1 ± {claim.tolerance:.2g}"
    return ClaimVerdict("holds" if good else "fails", why)


@RULES.add("equals")
def _equals(claim: Claim, values: Sequence[Spread], printed: Sequence[Spread]) -> ClaimVerdict:
    if claim.stated is not None:
        printed = [spread([claim.stated])] * len(values)
    if len(printed) < len(values):
        return ClaimVerdict("no numbers", "nothing to hold them against")
    gaps = [abs(a.mean - b.mean) for a, b in zip(values, printed, strict=True)]
    good = max(gaps) <= claim.tolerance
    why = f"{max(gaps):.4g} apart at the most, for {claim.tolerance:.4g}"
    return ClaimVerdict("holds" if good else "fails", why)


@RULES.add("below")
def _below(claim: Claim, values: Sequence[Spread], printed: Sequence[Spread]) -> ClaimVerdict:
    most = max(value.mean for value in values)
    return ClaimVerdict("holds" if most <= claim.value else "fails",
                   f"{most:.4g} for at most {claim.value:.4g}")  # fmt: skip


def _trend(claim: Claim, paper: Paper, numbers: Numbers) -> ClaimVerdict:
    """Every step along an axis of the grid, the other one held, goes the claimed way."""
    steps = []
    for line in grid_lines(paper, claim.axis):
        means = [numbers[n][claim.figure].mean for n in line if claim.figure in numbers.get(n, {})]
        steps += [b - a for a, b in pairwise(means)] if len(means) == len(line) else []
    if not steps:
        return ClaimVerdict("no numbers")
    sign = 1 if claim.way == "rises" else -1
    good = sum(sign * step > 0 for step in steps)
    why = f"{good} of {len(steps)} steps"
    if good == len(steps):
        return ClaimVerdict("holds", why)
    return ClaimVerdict("in part" if good > PART * len(steps) else "fails", why)


def cell_name(place: Mapping[str, float]) -> str:
    """The name of a cell of a grid."""
    return ", ".join(f"{name} = {value:g}" for name, value in place.items())


def grid_lines(paper: Paper, axis: str) -> list[list[str]]:
    """The names of a grid's cells in lines along one of its two axes."""
    (other,) = (name for name in paper.axes if name != axis)
    return [
        [cell_name({n: (a if n == axis else b) for n in paper.axes}) for a in paper.axes[axis]]
        for b in paper.axes[other]
    ]

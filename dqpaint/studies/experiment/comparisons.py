"""Cells and chosen pairs -> which figures differ: tests within families, corrected after Holm.

A family is what differs in one axis alone: the laws on one plant under one disturbance. Other pairs
are compared only where nobody would ask, and each makes all others harder to show.
"""

import math
import re
from collections import defaultdict
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from itertools import combinations
from typing import Literal

from dqpaint.core import tables
from dqpaint.errors import UsageError
from dqpaint.studies.experiment.axes import Axis, split_outside
from dqpaint.studies.experiment.cells import Cell, TableFigure, rounded
from dqpaint.studies.experiment.statistics import (
    LEVEL,
    REPEATED,
    Interval,
    Test,
    holm,
    paired_t,
    spread,
    welch,
    why_untested,
    wilcoxon,
)

Method = Literal["t", "wilcoxon"]
MOST_SHOWN = 24  # rows of tests in a terminal
NAMES = {"t": "Student's paired t-test", "wilcoxon": "Wilcoxon's signed-rank test"}


@dataclass(frozen=True)
class Chosen:
    """Which pairs are tested, and how.

    Attributes:
        axis: in which the two of a pair differ.
        pairs: of its values; None is every pair.
        method: of the test of runs with the same seeds.
    """

    axis: str
    pairs: tuple[tuple[str, str], ...] | None
    method: Method = "t"


@dataclass(frozen=True)
class Difference:
    """What is said of two cells of a family.

    Attributes:
        family: what the two have in common; nothing where there is one family.
        names: of the two.
        values: of the figure in their runs (N,) and (M,).
        paired: whether they were compared run by run.
        test: of the second less the first; None where there is nothing to test.
        why: there is none.
        p: its chance, raised for all tests of the family.
        left_out: runs of both that are no result, or have no partner.
    """

    family: str
    names: tuple[str, str]
    values: tuple[tuple[float, ...], tuple[float, ...]]
    paired: bool
    test: Test | None
    why: str = ""
    p: float = math.nan
    left_out: int = 0

    @property
    def verdict(self) -> str:
        """Whether they differ, in a word or two."""
        if self.test is None:
            return f"not tested: {self.why}"
        if self.p >= LEVEL:
            return "not shown"
        largest = max(abs(sum(values) / len(values)) for values in self.values)
        small = abs(self.test.difference) <= REPEATED * largest
        return f"yes, but by less than {REPEATED:.1%}" if small else "yes"


def choose(
    axes: Sequence[Axis], baseline: str | None, pairs: str | None, method: Method = "t"
) -> Chosen:
    """Which pairs of the axes' values are tested.

    Args:
        axes: of which each has several values, or one is alone.
        baseline: a value that all others of its axis are compared with.
        pairs: of values of one axis: `hinf:p,hinf:pff`.
        method: of the test of runs with the same seeds.

    Raises:
        UsageError: both are given, or a name that is no value.
    """
    if baseline is not None and pairs is not None:
        raise UsageError("--baseline compares all with one, --pairs names the pairs: not both")
    values = {axis.name: axis.texts for axis in axes}
    if baseline is not None:
        for name, texts in values.items():
            if baseline in texts:
                others = [text for text in texts if text != baseline]
                return Chosen(name, tuple((baseline, text) for text in others), method)
        raise UsageError(f"baseline '{baseline}' is none of what is compared: {_said(values)}")
    if pairs is not None:
        found = [_read_pair(text.strip(), values) for text in split_outside(pairs)]
        if len({axis for axis, _ in found}) > 1:
            raise UsageError(f"pairs '{pairs}': all differ in one thing, laws or plants or arms")
        return Chosen(found[0][0], tuple(dict.fromkeys(pair for _, pair in found)), method)
    return Chosen("controller" if "controller" in values else axes[0].name, None, method)


def _read_pair(text: str, values: Mapping[str, Sequence[str]]) -> tuple[str, tuple[str, str]]:
    """An axis and two of its values, from `hinf:p`; a value may have colons of its own."""
    for colon in re.finditer(":", text):
        one, other = text[: colon.start()].strip(), text[colon.end() :].strip()
        for name, texts in values.items():
            if one in texts and other in texts and one != other:
                return name, (one, other)
    raise UsageError(f"pairs '{text}' is not A:B of two that are compared: {_said(values)}")


def _said(values: Mapping[str, Sequence[str]]) -> str:
    return "; ".join(", ".join(texts) for texts in values.values())


def families(found: Sequence[Cell], axis: str) -> dict[str, dict[str, Cell]]:
    """Cells by what they have in common but for an axis, then by their value of it."""
    groups: dict[str, dict[str, Cell]] = defaultdict(dict)
    for cell in found:
        rest = ", ".join(value for name, value in cell.choice.items() if name != axis)
        groups[rest][cell.choice[axis]] = cell
    return groups


def differences(
    found: Sequence[Cell], figure: TableFigure, chosen: Chosen | None = None
) -> list[Difference]:
    """The chosen pairs, each family for itself; none where no cell has several runs.

    Args:
        found: cells.
        figure: that is compared.
        chosen: pairs; None are those of all laws, or else of the first axis. Of all pairs of a
            family the smaller mean is first.
    """
    if all(len(cell.results) < 2 for cell in found):
        return []
    if chosen is None:
        chosen = choose([Axis(name, ()) for name in found[0].choice], None, None)
    lines: list[Difference] = []
    for family, members in families(found, chosen.axis).items():
        if chosen.pairs is None:
            known = [cell for cell in members.values() if cell.results]
            known.sort(key=lambda cell: (math.isnan(m := cell.spread(figure).mean), m))
            named = list(combinations((cell.choice[chosen.axis] for cell in known), 2))
        else:
            named = list(chosen.pairs)
        lines += _corrected([_difference(family, members, two, figure, chosen.method)
                             for two in named])  # fmt: skip
    return lines


def _difference(
    family: str,
    members: Mapping[str, Cell],
    names: tuple[str, str],
    figure: TableFigure,
    method: Method,
) -> Difference:
    one, other = (members[name] for name in names)
    a, b = one.by_seed(figure), other.by_seed(figure)
    common = sorted(a.keys() & b.keys())
    paired = len(common) > 1
    first, second = (tuple(v[k] for k in (common if paired else sorted(v))) for v in (a, b))
    out = sum(map(len, (one.results, other.results))) - len(first) - len(second)
    why = why_untested(first, second, paired)
    test = None
    if why is None:
        if paired:
            test = (wilcoxon if method == "wilcoxon" else paired_t)(second, first)
        else:
            test = welch(spread(second), spread(first))
    return Difference(family, names, (first, second), paired, test, why or "", left_out=out)


def _corrected(lines: list[Difference]) -> list[Difference]:
    tested = [line for line in lines if line.test is not None]
    raised = iter(holm([line.test.p for line in tested if line.test is not None]))
    return [line if line.test is None else replace(line, p=next(raised)) for line in lines]


def difference_rows(lines: Sequence[Difference], unit: str = "") -> list[list[str]]:
    """Headings and rows of text."""
    of = f" [{unit}]" if unit else ""
    heads = ["within", "A", "B", f"B - A{of}", "95 %", "B / A", "effect size, 95 %", "test",
             "p (Holm)", "differ"]  # fmt: skip
    found = [heads]
    for line in lines:
        test, (a, b) = line.test, line.values
        ratio = sum(b) / len(b) / (sum(a) / len(a)) if a and b and sum(a) > 0 else math.nan
        told = [f"{ratio:.3g}" if math.isfinite(ratio) else "-"]
        if test is None:
            gap = sum(b) / len(b) - sum(a) / len(a) if a and b else math.nan
            told = [f"{gap:.4g}" if math.isfinite(gap) else "-", "-", *told, "-", "-", "-"]
        else:
            low, high = test.interval
            half = (high - low) / 2
            gap_text, _, low_text, high_text = rounded(test.difference, half, low, high)
            known = math.isfinite(half)
            told = [
                gap_text, f"{low_text} to {high_text}" if known else "-", *told,
                f"{'d_z' if line.paired else 'd'} {test.effect:.3g}{_ends(test.effect_interval)}",
                _test_text(line, test), f"{line.p:.2g}",
            ]  # fmt: skip
        out = f" ({line.left_out} runs left out)" if line.left_out else ""
        found.append([line.family, *line.names, *told, line.verdict + out])
    return found if any(row[0] for row in found[1:]) else [row[1:] for row in found]


def _ends(ends: Interval) -> str:
    low, high = ends
    return f", {low:.2g} to {high:.2g}" if math.isfinite(low + high) else ""


def _test_text(line: Difference, test: Test) -> str:
    if math.isnan(test.freedom):
        return f"W = {test.t:g}, {len(line.values[0])} pairs"
    return f"t({test.freedom:.3g}) = {test.t:.3g}"


def about(lines: Sequence[Difference], heading: str, method: Method = "t") -> str:
    """What a table of differences says, and how."""
    kinds = []
    if any(line.paired and line.test for line in lines):
        kinds.append(f"{NAMES[method]} of runs with the same seeds")
    if any(line.test and not line.paired for line in lines):
        kinds.append("Welch's t-test of runs without common seeds")
    parts = [f"Whether the mean of {heading} differs by more than its spread explains"]
    if kinds:
        several = len({line.family for line in lines}) > 1
        within = ", for each of the families (`within`) by itself" if several else ""
        parts[0] += f": {'; '.join(kinds)}; two-sided, p raised after Holm{within}, at {LEVEL:.0%}"
        parts.append(
            "Effect sizes: d_z is the mean difference by the standard deviation of the "
            "differences, d (Cohen's) that by the root of the mean variance"
        )
    if any(line.why in ("hardly any spread", "the same runs") for line in lines):
        parts.append(
            "Not tested: runs whose seeds change nothing or hardly anything, less than "
            f"{REPEATED:.1%} of the mean, are one run written down several times; their difference "
            "stands as that of one run, and no chance was measured. --spread posture,place has "
            "them begin and lie elsewhere"
        )
    if any(line.left_out for line in lines):
        parts.append("Runs that are no result, and those without a partner, are left out")
    return ". ".join(parts) + "."


def terminal_rows(lines: Sequence[Difference], unit: str = "") -> list[str]:
    """The table as aligned text, of no more rows than can be read."""
    rows = difference_rows(lines[:MOST_SHOWN], unit)
    more = len(lines) - MOST_SHOWN
    said = [f"and {more} more in the files; --baseline or --pairs asks for fewer"]
    return [*tables.align(rows), *(said if more > 0 else [])]


def csv(lines: Sequence[Difference], name: str) -> bytes:
    """All numbers of the differences, in the units of the summary."""
    heads = ["figure", "family", "A", "B", "paired", "n_A", "n_B", "left_out", "difference",
             "difference_95_low", "difference_95_high", "statistic", "freedom", "p", "p_holm",
             "effect", "effect_95_low", "effect_95_high", "differ"]  # fmt: skip
    rows: list[list[object]] = [list(heads)]
    for line in lines:
        test = line.test or Test(math.nan, math.nan, math.nan)
        rows.append([
            name, line.family, *line.names, line.paired,
            *map(len, line.values), line.left_out, test.difference, *test.interval, test.t,
            test.freedom, test.p, line.p, test.effect, *test.effect_interval, line.verdict,
        ])  # fmt: skip
    return tables.encode_csv(rows)

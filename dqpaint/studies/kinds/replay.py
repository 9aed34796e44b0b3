"""A paper's experiment -> its numbers beside ours, and the verdicts of both on its claims."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from itertools import combinations
from typing import Any

import numpy as np

from dqpaint.core import tables
from dqpaint.studies.experiment import cells
from dqpaint.studies.experiment.statistics import Spread
from dqpaint.studies.kinds.study_result import ANY_WIDTH, StudyResult
from dqpaint.studies.replay.claims import (
    ClaimVerdict,
    Numbers,
    grid_lines,
    judge,
    printed_elsewhere,
    published,
    told_apart,
)
from dqpaint.studies.replay.in_words import in_words
from dqpaint.studies.replay.measures import MEASURES, MeasureRequest, MeasureResult
from dqpaint.studies.replay.papers import Claim, Figure, Paper, read_paper
from dqpaint.studies.report.page import Block, Rows, Tables, Words, files_of

RULE = (
    "holds, fails: as these numbers stand; not shown: they differ by less than chance explains "
    "(Welch, 5 % for all steps of a claim or all pairs of a table together, Holm), or by less than "
    "0.1 %; the paper's own numbers are held to the same rules"
)
ASSUMED = "Assumed, for the paper does not say it:"
LEAST_ORDERED = 3  # cells, of which an order says something
BARS = (
    "Bars begin at 0, each column to its own scale; a line across the end is the standard "
    "deviation. Where numbers are more than 20 times apart, a dot stands on a logarithmic line "
    "from the least to the largest. A click on a heading sorts its table."
)


@dataclass(frozen=True, kw_only=True)
class Replay(StudyResult):
    """A finished replay.

    Attributes:
        paper: the experiment.
        measured: here.
        verdicts: of each of its claims: the claim, by the paper's numbers, by ours.
    """

    paper: Paper
    measured: MeasureResult
    verdicts: tuple[tuple[Claim, ClaimVerdict, ClaimVerdict], ...]

    @property
    def title(self) -> str:
        """The heading of its pages."""
        return f"{self.name}: {self.paper.title}"

    def table_text(self, width: int = ANY_WIDTH) -> str:
        """Numbers, verdicts and what was not tested, for a terminal."""
        paper, measured = self.paper, self.measured
        ours = measured.ours.replace("\n", "\n          ")
        parts = [f"{self.title}\n{paper.source}\n  theirs  {paper.theirs}\n  here    {ours}"]
        parts += _assumed("  - ", self)
        parts += [f"{_aligned(rows)}\n{in_order(self, figure)}".rstrip()
                  for figure, rows in numbers(self)]  # fmt: skip
        parts += [f"{figure.says}\n{_aligned(rows)}" for figure, rows in surfaces(self)]
        lines = tables.align(verdict_rows(self))
        if max(map(len, lines)) > width:
            lines = [
                f"{claim.says}{f' ({claim.where})' if claim.where else ''}\n"
                f"  paper  {theirs}\n  here   {ours}" for claim, theirs, ours in self.verdicts
            ]  # fmt: skip
        parts += ["\n".join([*lines, RULE, summary(self.verdicts)]), *_listed("  - ", self)]
        parts += filter(None, [last_sentence(self)])
        return "\n\n".join(parts)

    def files_and_blocks(self) -> tuple[dict[str, bytes], list[Block]]:
        """Tables, verdicts and pictures by the ends of their names, and the same for a page."""
        made = {
            **files_of(self.measured.shown),
            "-table.csv": numbers_csv(self),
            "-claims.csv": verdicts_csv(self),
            "-table.md": markdown(self).encode(),
        }
        return made, blocks(self)


def _aligned(rows: Sequence[Sequence[str]]) -> str:
    return "\n".join(tables.align(rows))


def replay(name: str, request: MeasureRequest) -> Replay:
    """Do a paper's experiment again.

    Args:
        name: of the replay.
        request: the number of runs, the folder, and settings other than the paper's.

    Raises:
        UnknownNameError: there is none of that name.
        DqpaintError: a fault in the choices or the folder, or nothing could be run.
    """
    paper = read_paper(name)
    found = MEASURES[paper.measure](paper, request)
    return Replay(
        name=name, cells=found.cells, folder=request.folder, paper=paper, measured=found,
        verdicts=judge_claims(paper, found.numbers),
    )  # fmt: skip


def judge_claims(
    paper: Paper, ours: Numbers
) -> tuple[tuple[Claim, ClaimVerdict, ClaimVerdict], ...]:
    """Every claim, by the paper's numbers and by ours."""
    theirs, other = published(paper), printed_elsewhere(paper)
    return tuple(
        (claim, judge(claim, paper, theirs, other), judge(claim, paper, ours, theirs))
        for claim in paper.claims
    )


def numbers(replayed: Replay) -> list[tuple[Figure, list[list[str]]]]:
    """A table a figure: cell, the paper's number, ours, and ours by the paper's, if it prints any.

    The cells of a grid have tables of their own, see `surfaces`.
    """
    theirs, ours = published(replayed.paper), replayed.measured.numbers
    grid = _grid(replayed.paper)
    found = []
    for figure in replayed.paper.figures:
        pairs = {
            name: (theirs.get(name, {}).get(figure.name), ours.get(name, {}).get(figure.name))
            for name in dict.fromkeys([*theirs, *ours])
            if name not in grid
        }
        head = [figure.says, f"paper: {figure.paper}" if figure.paper else "paper", "here",
                "here / paper"]  # fmt: skip
        rows = [[n, _said(a), _said(b), _quotient(a, b)] for n, (a, b) in pairs.items() if a or b]
        if not any(a for a, _ in pairs.values()):
            head, rows = [head[0], head[2]], [[row[0], row[2]] for row in rows]
        if rows:
            found.append((figure, [head, *rows]))
    return found


def in_order(replayed: Replay, figure: Figure) -> str:
    """How much of the paper's order is found here, in a sentence; empty where there is none.

    Means are told apart by the rule of `RULE`, theirs and ours alike, all pairs together. Pairs of
    cells of different groups cannot but differ, and are left out.
    """
    theirs, ours = published(replayed.paper), replayed.measured.numbers
    both = [
        (cell.group, theirs[cell.name][figure.name], ours[cell.name][figure.name])
        for cell in replayed.paper.cells
        if figure.name in cell.published and figure.name in ours.get(cell.name, {})
    ]
    if len(both) < LEAST_ORDERED:
        return ""
    every = list(combinations(both, 2))
    pairs = [(a, b) for a, b in every if a[0] == b[0]]
    by_paper = told_apart([(a[1], b[1]) for a, b in pairs])
    here = told_apart([(a[2], b[2]) for a, b in pairs])
    apart = [(pair, found) for pair, there, found in zip(pairs, by_paper, here, strict=True)
             if there]  # fmt: skip
    known = [pair for pair, found in apart if found]
    same = sum((a[1].mean < b[1].mean) == (a[2].mean < b[2].mean) for a, b in known)
    text = (
        f"Of {len(apart)} pairs that the paper tells apart, {same} stand in its order here, "
        f"{len(known) - same} in the other, {len(apart) - len(known)} are alike"
    )
    left = len(every) - len(pairs)
    return f"{text}; {left} that cannot but differ are not counted." if left else f"{text}."


def surfaces(replayed: Replay) -> list[tuple[Figure, list[list[str]]]]:
    """A table a figure of a grid: the first axis downwards, the second to the right."""
    paper, ours = replayed.paper, replayed.measured.numbers
    if not paper.axes:
        return []
    first, second = paper.axes
    lines = grid_lines(paper, second)
    found = []
    for figure in paper.figures:
        head = [f"{first} \\ {second}", *(f"{value:g}" for value in paper.axes[second])]
        rows = [
            [f"{value:g}", *(_said(ours.get(name, {}).get(figure.name)) for name in line)]
            for value, line in zip(paper.axes[first], lines, strict=True)
        ]
        if any(figure.name in ours.get(name, {}) for line in lines for name in line):
            found.append((figure, [head, *rows]))
    return found


def _grid(paper: Paper) -> set[str]:
    """The names of the cells of a grid."""
    return {name for axis in paper.axes for line in grid_lines(paper, axis) for name in line}


def _said(value: Spread | None) -> str:
    if value is None or not np.isfinite(value.mean):
        return "-"
    known = value if np.isfinite(value.std) else Spread(1, value.mean, value.std)
    return cells.spread_text(known)


def _quotient(theirs: Spread | None, ours: Spread | None) -> str:
    if theirs is None or ours is None or not theirs.mean or not np.isfinite(ours.mean):
        return "-"
    return f"{ours.mean / theirs.mean:.3g}"


def verdict_rows(replayed: Replay) -> list[list[str]]:
    """The claims: what is said, where, by the paper's numbers, by ours."""
    rows = [["claim", "in", "by the paper's numbers", "here"]]
    for claim, theirs, ours in replayed.verdicts:
        rows.append([claim.says, claim.where or "-", str(theirs), str(ours)])
    return rows


def settings_rows(paper: Paper) -> list[list[str]]:
    """What is run for each cell, and where its numbers stand; empty if nothing is run."""
    rows = [["cell", "table", "run with"]]
    rows += [
        [
            cell.name,
            cell.table or "-",
            ", ".join(filter(None, [cell.drawing, _chosen(cell.settings)])),
        ]
        for cell in paper.cells
    ]
    return rows if any(cell.settings for cell in paper.cells) else []


def _chosen(settings: Mapping[str, Any]) -> str:
    """Settings in a line: `p, k = 50, start home, disturb twist (z = -0.05)`."""
    parts = []
    for name, value in settings.items():
        if name == "controller":
            parts.append(str(value))
        elif name == "gains":
            parts += [f"{gain} = {_number(one)}" for gain, one in value.items()]
        elif isinstance(value, Mapping):
            parts += [f"{name} {key} ({_chosen({'gains': one})})" for key, one in value.items()]
        else:
            parts.append(f"{name} {_number(value)}")
    return ", ".join(parts) or "-"


def _number(value: object) -> str:
    return f"{value:g}" if isinstance(value, float) else str(value)


def summary(verdicts: Sequence[tuple[Claim, ClaimVerdict, ClaimVerdict]]) -> str:
    """How many claims hold, in a line."""
    words = [ours.word for _, _, ours in verdicts]
    pairs = [(theirs.word, ours.word) for _, theirs, ours in verdicts]
    told = [pair for pair in pairs if "no numbers" not in pair]
    text = f"{words.count('holds')} of {len(words)} claims hold here"
    if lost := words.count("no numbers"):
        text += f", {lost} cannot be told"
    same = sum(theirs == ours for theirs, ours in told)
    return f"{text}; {same} of {len(told)} as by the paper's own numbers" if told else text


def last_sentence(replayed: Replay) -> str:
    """What of the paper holds here, in plain words."""
    measured = replayed.measured
    where = "on the paper's own arm, " if replayed.paper.assumed and measured.cells else ""
    if measured.departures:
        where = f"with {', '.join(measured.departures)}, "
    lost = sum(cell.name not in measured.numbers for cell in replayed.paper.cells)
    return in_words(replayed.verdicts, where, lost, len(replayed.paper.cells))


def _assumed(bullet: str, replayed: Replay) -> list[str]:
    """What the paper leaves open and is chosen here, and what a person chose otherwise."""
    lines = [f"{bullet}{one}" for one in replayed.paper.assumed]
    lines += [f"{bullet}chosen for this run: {one}" for one in replayed.measured.departures]
    gap = "\n" if bullet.startswith(" ") else "\n\n"
    return [gap.join([ASSUMED, "\n".join(lines)])] if lines else []


def _listed(bullet: str, replayed: Replay) -> list[str]:
    """What has no numbers, and what cannot be tested."""
    lost = [f"{bullet}{name}: {why}" for name, why in replayed.measured.lost.items()]
    parts = [
        ("Runs and their means:", [f"{bullet}{line.strip()}" for line in replayed.hidden]),
        ("To be known of some runs:", lost),
        ("Not tested, for it cannot be:", [f"{bullet}{one}" for one in replayed.paper.open]),
    ]
    gap = "\n" if bullet.startswith(" ") else "\n\n"
    return [gap.join([head, "\n".join(lines)]) for head, lines in parts if lines]


def markdown(replayed: Replay) -> str:
    """The whole of it as a page."""
    paper, measured = replayed.paper, replayed.measured
    parts = [f"# {replayed.title}", paper.source,
             "\n".join([f"- theirs: {paper.theirs}",
                        *(f"- here: {line}" for line in measured.ours.split("\n"))]),
             *_assumed("- ", replayed)]  # fmt: skip
    for figure, rows in numbers(replayed):
        parts += [tables.markdown(rows), *filter(None, [in_order(replayed, figure)])]
    for figure, rows in surfaces(replayed):
        parts += [f"{figure.says}:", tables.markdown(rows)]
    parts += [tables.markdown(verdict_rows(replayed)), f"{RULE}. {summary(replayed.verdicts)}."]
    parts += _listed("- ", replayed)
    if run_with := settings_rows(paper):
        parts += ["What each cell was run with:", tables.markdown(run_with)]
    parts += filter(None, [last_sentence(replayed)])
    return "\n\n".join(parts) + "\n"


def numbers_csv(replayed: Replay) -> bytes:
    """Every number, all digits: cell, figure, table, the paper's, ours."""
    both = published(replayed.paper), replayed.measured.numbers
    where = {cell.name: cell.table for cell in replayed.paper.cells}
    heads = [f"{whose}_{n}" for whose in ("paper", "here") for n in ("runs", "mean", "std")]
    rows: list[list[object]] = [["cell", "figure", "table", *heads]]
    for cell in dict.fromkeys(name for numbers in both for name in numbers):
        for figure in replayed.paper.figures:
            pair = [numbers.get(cell, {}).get(figure.name) for numbers in both]
            if any(pair):
                values = [value for one in pair for value in _row(one)]
                rows.append([cell, figure.name, where.get(cell, ""), *values])
    return tables.encode_csv(rows)


def _row(value: Spread | None) -> list[object]:
    if value is None or not np.isfinite(value.mean):
        return ["", "", ""]
    return [value.n, value.mean, value.std if np.isfinite(value.std) else ""]


def verdicts_csv(replayed: Replay) -> bytes:
    """The claims and both verdicts."""
    heads = ["claim", "kind", "figure", "where", "paper", "paper_why", "here", "here_why"]
    return tables.encode_csv([
        heads,
        *([claim.says, claim.kind, claim.figure, claim.where,
           theirs.word, theirs.why, ours.word, ours.why]
          for claim, theirs, ours in replayed.verdicts),
    ])  # fmt: skip


def blocks(replayed: Replay) -> list[Block]:
    """The whole of it for a page."""
    paper, measured = replayed.paper, replayed.measured
    compared = [
        Rows(one.says, rows, tuple(range(1, min(3, len(rows[0])))), in_order(replayed, one))
        for one, rows in numbers(replayed)
    ]
    shown: list[Block] = [
        Words(f"{paper.source}\nTheirs: {paper.theirs}\nHere: {measured.ours}"),
        *(Words(text) for text in _assumed("  - ", replayed)),
        Words(last_sentence(replayed) or f"{summary(replayed.verdicts)}."),
        Rows("What the paper claims", verdict_rows(replayed)),
        Words(f"{RULE}. {summary(replayed.verdicts)}."),
        Tables("Its numbers, and ours", compared),
        Words(BARS),
        *measured.shown.values(),
    ]  # fmt: skip
    if maps := surfaces(replayed):
        shown.append(Tables("The surfaces in numbers", [Rows(f.says, rows) for f, rows in maps]))
    shown += [Words(text) for text in _listed("  - ", replayed)]
    if run_with := settings_rows(paper):
        shown.append(Rows("What each cell was run with", run_with))
    return shown

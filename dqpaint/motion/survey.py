"""Program -> its errors, warnings and figures, without sampling all of it.

It says what `plan` would say. Straight lines, screws and arcs are finite wherever their numbers
are, and their boxes need their places alone, or those of their ends; only what is a formula or
looks somewhere is asked at every sample.
"""

from dataclasses import dataclass

import numpy as np

from dqpaint import dq
from dqpaint.diagnostics import Diagnostic, DiagnosticCollector, ErrorLimitError, ScriptError
from dqpaint.dq import Floats
from dqpaint.motion.corner_warnings import slow_strokes, velocity_jumps
from dqpaint.motion.geometry.batched_shapes import Flags
from dqpaint.motion.geometry.paths import Indices
from dqpaint.motion.sampling import blocks, every_sample, sample_rows
from dqpaint.motion.schedule import Schedule, schedule_strokes
from dqpaint.motion.stroke_errors import Faults, beyond_budget
from dqpaint.motion.stroke_light import unevenness
from dqpaint.program import Program

HARMLESS = 1e40  # numbers below that stay finite in all the products of a stroke


@dataclass(frozen=True)
class Survey:
    """The figures of a drawing.

    Attributes:
        program: what was looked at.
        samples: how many poses there are.
        seconds: how long it takes.
        length: of the path [m], dark parts included.
        box: the sides (3,) [m] of the box round the samples, in the drawing's own frame.
        unevenness: how much brighter strokes are near their ends than in the middle.
        notes: warnings about the drawing.
    """

    program: Program
    samples: int
    seconds: float
    length: float
    box: Floats
    unevenness: float
    notes: tuple[Diagnostic, ...]

    @property
    def period(self) -> float:
        """The sampling period [s]."""
        return self.program.period


def survey(program: Program) -> Survey:
    """The figures of a drawing.

    Raises:
        ScriptError: a stroke without a timetable, or more samples than the budget.
    """
    findings = DiagnosticCollector()
    faults: Faults = {}
    box = _Box()
    try:
        table = schedule_strokes(program, findings)
        doubtful = _doubtful(table) & (not beyond_budget(findings))
        for rows in sample_rows(table.select(doubtful), None, faults, split=True):
            box.add(dq.translation(rows.flow.pose))
        report_errors(faults, findings)
    except ErrorLimitError:
        pass
    if findings.errors:
        raise ScriptError(program.name, program.text, findings.ordered())
    for note in (*velocity_jumps(table), *slow_strokes(table)):
        findings.add(note)
    _extend_box(table, np.flatnonzero(~doubtful), box)
    samples = int(table.count.sum()) + 1
    return Survey(
        program,
        samples,
        (samples - 1) * program.period,
        float(sum(table.length.tolist())),
        box.sides,
        unevenness(table),
        program.notes + findings.ordered(),
    )


def report_errors(faults: Faults, findings: DiagnosticCollector) -> None:
    """Adds errors to the findings in the order of the strokes."""
    for stroke in sorted(faults):
        for diagnostic in faults[stroke]:
            findings.add(diagnostic)


class _Box:
    """The axis-aligned bounding box of points."""

    def __init__(self) -> None:
        self.least, self.most = np.full(3, np.inf), np.full(3, -np.inf)

    def add(self, points: Floats) -> None:
        """Extends the box by points (N, 3)."""
        self.least = np.minimum(self.least, points.min(axis=0))
        self.most = np.maximum(self.most, points.max(axis=0))

    @property
    def sides(self) -> Floats:
        """The sides (3,) [m]."""
        return np.asarray(self.most - self.least)


def _doubtful(table: Schedule) -> Flags:
    """Which strokes (S,) may become non-finite, or have no simple bound."""
    shapes = table.shapes
    largest = [shape.largest_parameter() for shape in shapes.families]
    of_segment = np.full(len(shapes.segments), np.inf)
    for family, sizes in enumerate(largest):
        own = shapes.family == family
        of_segment[own] = np.broadcast_to(sizes, shapes.member[own].max() + 1)[shapes.member[own]]
    with np.errstate(all="ignore"):
        of_segment = np.maximum(of_segment, 1.0 / (table.end - table.begin))
        of_stroke = np.maximum.reduceat(of_segment, table.first)
        rates = np.abs(table.rates).max(axis=1)
        harmless = (of_stroke < HARMLESS) & (rates * table.time**2 < HARMLESS)
        return np.asarray(~(harmless & (1.0 / table.time < HARMLESS)))


def _extend_box(table: Schedule, strokes: Indices, box: _Box) -> None:
    """Extends a box by strokes: by their ends, and by all samples where these may leave it."""
    if not len(strokes):
        return

    def add(stroke: Indices, tau: Floats) -> None:
        number, f = table.inside(stroke, table.progress(stroke, tau).value)
        box.add(table.shapes.points(number, f))

    add(np.repeat(strokes, 2), np.tile([0.0, 1.0], len(strokes)))
    alone = (table.size[strokes] == 1) & ~table.rates[strokes].any(axis=1)
    leaves = table.shapes.may_leave_box(table.first[strokes], box.least, box.most)
    others = strokes[leaves | ~alone]
    for some in blocks(table.count[others]):
        add(*every_sample(table.count, others[some]))

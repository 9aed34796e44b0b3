"""Program -> Motion: the reference at every sample, in the robot's base frame."""

from collections.abc import Sequence
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from dqpaint import dq
from dqpaint.diagnostics import Diagnostic, DiagnosticCollector, ErrorLimitError, ScriptError
from dqpaint.dq import Floats
from dqpaint.motion.corner_warnings import slow_strokes, velocity_jumps
from dqpaint.motion.geometry.shapes import pose_array
from dqpaint.motion.row_lines import RowLines
from dqpaint.motion.sampling import Rows, sample_rows
from dqpaint.motion.schedule import Schedule, schedule_strokes
from dqpaint.motion.stroke_errors import Faults, beyond_budget
from dqpaint.motion.stroke_light import make_stroke_light, unevenness
from dqpaint.motion.survey import report_errors
from dqpaint.motion.time_scaling import Ticks, TimeScaling
from dqpaint.program import AutoPlacement, Pose, Program, Step


@dataclass(frozen=True)
class Motion:
    """The reference of a drawing, one row a sample, in the base frame; the arrays are read-only.

    At a corner the pose is unique and the twist is that of the stroke that begins there, so that
    row k and its twist lead to row k + 1.

    Attributes:
        period: [s].
        t: times (N,) [s], from 0.
        pose: reference poses (N, 8), signs continuous.
        twist: reference spatial twists (N, 6) [rad/s, m/s].
        acceleration: their time derivatives (N, 6) [rad/s^2, m/s^2].
        light: mean linear RGB (N, 3) from t_k until t_k+1; the last row is dark.
        source: the line of the drawing (N,) that determines the motion after row k.
        stroke: the number of the segment (N,), from 0.
        canvas: pose (8,) of the drawing frame in the base frame.
        front: orientation (4,) of the robot's own canvas: its front view is square on,
            wherever a `place` line puts the drawing.
        jump: whether a `step` jumps from row k to k + 1 (N,).
        clock: the drawing's own time (N,) [s]; equal to t without retiming.
        program: the planned program.
        length: of the path [m], dark parts included.
        unevenness: ratio of the brightness near the strokes' ends to the middle.
        notes: warnings about the drawing.
        exposure: of the film its light was solved for, light per area on the canvas to saturation
            [m^2 / (lamp s)]; None where it is chosen by the light.
    """

    period: float
    t: Floats
    pose: Floats
    twist: Floats
    acceleration: Floats
    light: Floats
    source: RowLines
    stroke: NDArray[np.int64]
    canvas: Floats
    front: Floats
    jump: NDArray[np.bool_]
    clock: Floats
    program: Program
    length: float
    unevenness: float = 1.0
    notes: tuple[Diagnostic, ...] = field(default=())
    exposure: float | None = None

    def __post_init__(self) -> None:
        for array in vars(self).values():
            if isinstance(array, np.ndarray):
                array.setflags(write=False)

    @property
    def samples(self) -> int:
        """The number of samples."""
        return len(self.t)

    @property
    def seconds(self) -> float:
        """The duration [s]."""
        return float(self.t[-1])

    @property
    def points(self) -> Floats:
        """The reference positions of the light (N, 3) [m]."""
        return dq.translation(self.pose)

    @property
    def lit(self) -> NDArray[np.bool_]:
        """Whether the light shines from t_k until t_k+1 (N,)."""
        return np.asarray(self.light.any(axis=1))

    @property
    def photo_corners(self) -> Floats:
        """The corners (P, 4, 3) of each photograph [m]: lower left, right, upper right, left."""
        found = [
            np.array(photo.corner) + np.array([np.zeros(3), right, np.add(right, up), up])
            for photo in self.program.photos
            for right, up in ((np.array(photo.right), np.array(photo.up)),)
        ]
        local = np.array(found).reshape(-1, 4, 3)
        turned = dq.rotate(dq.rotation(self.canvas), local)
        return np.asarray(turned + dq.translation(self.canvas))

    @property
    def photo_frames(self) -> Floats:
        """The corners (P, 4, 3) of each photograph, wider by what its light may lie beside it."""
        corners = np.array(self.photo_corners)
        for four, photo in zip(corners, self.program.photos, strict=True):
            right, up = four[1] - four[0], four[3] - four[0]
            right *= photo.detail / np.linalg.norm(right)
            up *= photo.detail / np.linalg.norm(up)
            four += np.array([-right - up, right - up, right + up, up - right])
        return corners

    @property
    def box(self) -> Floats:
        """The sides (3,) [m] of the box round the drawing, in its own frame."""
        points = dq.translation(dq.mul(dq.conj(self.canvas), self.pose))
        return np.asarray(np.ptp(points, axis=0))


def plan(program: Program, canvas: Floats, scaling: TimeScaling | None = None) -> Motion:
    """The motion of a program.

    Args:
        program: from `dqpaint.language`.
        canvas: pose (8,) of the robot's canvas in its base frame; a `place` line goes before it.
        scaling: of the drawing's own clock, where it is slowed down.

    Raises:
        ScriptError: a stroke without a timetable, or more samples than the budget.
    """
    findings = DiagnosticCollector()
    faults: Faults = {}
    table, ticks, sheet = None, None, None
    try:
        table = schedule_strokes(program, findings)
        ticks = _ticks(table, scaling)
        sheet = _MotionRows(table, ticks, _placed(program, canvas))
        for rows in sample_rows(table, ticks, faults) if not beyond_budget(findings) else ():
            if not (faults or findings.errors):
                sheet.add(rows)
        report_errors(faults, findings)
    except ErrorLimitError:
        pass
    if findings.errors or table is None or sheet is None:
        raise ScriptError(program.name, program.text, findings.ordered())
    paces = None if ticks is None else np.array([tick.end_rates for tick in ticks])
    for note in (*velocity_jumps(table, paces), *slow_strokes(table)):
        findings.add(note)
    return sheet.motion(canvas, findings.ordered())


def _ticks(table: Schedule, scaling: TimeScaling | None) -> list[Ticks] | None:
    """The sample times of each stroke under retiming; a step is never slowed."""
    if scaling is None:
        return None
    first = np.cumsum(table.count) - table.count
    return [
        Ticks(np.arange(2) / 1) if isinstance(segment.path, Step) else scaling.ticks(begin, count)
        for segment, begin, count in zip(
            table.firsts, first.tolist(), table.count.tolist(), strict=True
        )
    ]


def _placed(program: Program, canvas: Floats) -> Floats:
    """The drawing frame (8,) in the base frame; at the canvas if its placement is not yet known."""
    match program.placement:
        case Pose():
            return pose_array(program.placement)
        case AutoPlacement(orientation=turned) if turned is not None:
            return dq.pose_from(dq.translation(canvas), np.array(turned))
        case _:
            return canvas


class _MotionRows:
    """The rows of a motion, filled block by block."""

    def __init__(self, table: Schedule, ticks: Sequence[Ticks] | None, placed: Floats) -> None:
        self._table, self._ticks, self._placed = table, ticks, placed
        counts = table.count if ticks is None else np.array([tick.count for tick in ticks])
        n = int(counts.sum()) + 1
        self._pose, self._twist, self._slope = (np.empty((n, width)) for width in (8, 6, 6))
        self._light, self._number = np.zeros((n, 3)), np.empty(n, dtype=np.int64)
        self._clock = np.empty(n)
        self._begun = np.cumsum(table.count) - table.count  # samples before each stroke
        self._glow = make_stroke_light(table)
        self._rows = 0

    def add(self, rows: Rows) -> None:
        """Adds rows; the end of a stroke is the start of the next, but for the last stroke."""
        table, begin = self._table, self._rows
        new = ~rows.last
        end = begin + int(new.sum())
        self._light[begin:end] = self._glow.along(rows)
        if rows.stroke[-1] == len(table) - 1:
            new[-1] = True
            end += 1
        stroke, here = rows.stroke[new], slice(begin, end)
        self._pose[here] = dq.mul(self._placed, rows.flow.pose[new])
        self._twist[here] = dq.adjoint(self._placed, rows.flow.twist[new])
        self._slope[here] = dq.adjoint(self._placed, rows.flow.slope[new])
        self._number[here] = table.parts(stroke, rows.fraction[new])
        samples = self._begun[stroke] + rows.tau[new] * table.count[stroke]
        self._clock[here] = samples * table.program.period
        self._rows = end

    def motion(self, canvas: Floats, findings: tuple[Diagnostic, ...]) -> Motion:
        """The complete motion, in the base frame."""
        table, program, number = self._table, self._table.program, self._number
        number[-1] = len(program.segments) - 1
        lines = RowLines.from_lines([segment.line for segment in program.segments])
        steps = np.array([isinstance(segment.path, Step) for segment in program.segments])
        t = np.arange(len(number), dtype=np.float64) * program.period
        slowed = self._ticks is not None and any(tick.rate is not None for tick in self._ticks)
        return Motion(
            period=program.period,
            t=t,
            pose=dq.continuous(self._pose),
            twist=self._twist,
            acceleration=self._slope,
            light=self._light,
            source=lines[number],
            stroke=number,
            canvas=np.array(self._placed),
            front=np.array(dq.rotation(canvas)),
            jump=steps[number],
            clock=self._clock if slowed else t,
            program=program,
            length=float(sum(table.length.tolist())),
            unevenness=unevenness(table),
            notes=program.notes + findings,
        )

"""Program -> Motion: what the light is asked to do at every sample, in the robot's base frame."""

from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from dqpaint import dq
from dqpaint.dq import Floats
from dqpaint.language.diagnostics import Diagnostic, ScriptError
from dqpaint.language.findings import EnoughError, Findings
from dqpaint.language.program import Auto, Pose, Program, Step
from dqpaint.motion.corners import jumps, slow
from dqpaint.motion.glow import ends_over_middle, glow
from dqpaint.motion.lengths import flow_by_length, length_fraction
from dqpaint.motion.pace import Pace, Ticks
from dqpaint.motion.runs import part_at
from dqpaint.motion.shapes import Flow, pose_array
from dqpaint.motion.timetable import Stroke, StrokeError, stroke_errors, timetable


@dataclass(frozen=True)
class Motion:
    """What was asked, one row a sample, in the base frame; the arrays are read-only.

    At a corner the pose is one and the twist is the one of the stroke that begins there, so that
    row k and its twist lead to row k + 1.

    Attributes:
        period: [s].
        t: times (N,) [s], from 0.
        pose: desired poses (N, 8), signs continuous.
        twist: desired spatial twists (N, 6) [rad/s, m/s].
        acceleration: their plain derivatives (N, 6) [rad/s^2, m/s^2].
        light: mean linear RGB (N, 3) from t_k until t_k+1; the last row is dark.
        line: the line of the file (N,) that asks for what follows row k.
        stroke: the number of the segment (N,), from 0.
        canvas: pose (8,) of the drawing frame in the base frame.
        front: orientation (4,) of the robot's own canvas: it is seen square on from the front,
            wherever a `place` line puts the drawing.
        jump: whether a `step` jumps from row k to k + 1 (N,).
        clock: the drawing's own time (N,) [s]; it is t, unless the drawing was slowed down.
        program: what was planned.
        length: of the path [m], dark parts included.
        unevenness: how much brighter strokes are near their ends than in the middle.
        notes: warnings about the drawing.
    """

    period: float
    t: Floats
    pose: Floats
    twist: Floats
    acceleration: Floats
    light: Floats
    line: NDArray[np.int64]
    stroke: NDArray[np.int64]
    canvas: Floats
    front: Floats
    jump: NDArray[np.bool_]
    clock: Floats
    program: Program
    length: float
    unevenness: float = 1.0
    notes: tuple[Diagnostic, ...] = field(default=())

    def __post_init__(self) -> None:
        for array in vars(self).values():
            if isinstance(array, np.ndarray):
                array.setflags(write=False)

    @property
    def points(self) -> Floats:
        """The asked places of the light (N, 3) [m]."""
        return dq.translation(self.pose)

    @property
    def lit(self) -> NDArray[np.bool_]:
        """Whether the light shines from t_k until t_k+1 (N,)."""
        return np.asarray(self.light.any(axis=1))

    @property
    def box(self) -> Floats:
        """The sides (3,) [m] of the box round the drawing, in its own frame."""
        points = dq.translation(dq.mul(dq.conj(self.canvas), self.pose))
        return np.asarray(np.ptp(points, axis=0))


def plan(program: Program, canvas: Floats, pace: Pace | None = None) -> Motion:
    """The motion a program asks for.

    Args:
        program: from `dqpaint.language`.
        canvas: pose (8,) of the robot's canvas in its base frame; a `place` line goes before it.
        pace: of the drawing's own clock, where it is slowed down.

    Raises:
        ScriptError: a stroke without a timetable, or more samples than the budget.
    """
    findings = Findings()
    strokes: list[Stroke] = []
    flows: list[tuple[Flow, Floats]] = []
    ticks: list[Ticks] = []
    try:
        strokes = timetable(program, findings)
        first = 0
        for stroke in strokes:
            ticks.append(_ticks(stroke, first, pace))
            first += stroke.count
            try:
                with stroke_errors(stroke.segment):
                    flows.append(_paced(stroke, ticks[-1], program.period))
                    check_finite(flows[-1][0])
            except StrokeError as fault:
                for diagnostic in fault.diagnostics:
                    findings.add(diagnostic)
    except EnoughError:
        pass
    if findings.errors:
        raise ScriptError(program.name, program.text, findings.ordered())
    for note in (
        *jumps(strokes, [flow for flow, _ in flows], program.period),
        *slow(strokes, program.period),
    ):
        findings.add(note)
    return _assemble(program, strokes, ticks, flows, canvas, findings.ordered())


def _ticks(stroke: Stroke, first: int, pace: Pace | None) -> Ticks:
    """When the samples of a stroke are; a jump is never slowed."""
    if pace is None or isinstance(stroke.segment.path, Step):
        return Ticks(stroke.samples)
    return pace.ticks(first, stroke.count)


def _paced(stroke: Stroke, ticks: Ticks, period: float) -> tuple[Flow, Floats]:
    flow, fraction = flow_at(stroke, ticks.tau, period)
    if ticks.rate is None or ticks.slope is None:
        return flow, fraction
    return flow.at_rates(ticks.rate, ticks.slope), fraction


def check_finite(flow: Flow) -> None:
    """Raise FloatingPointError where a stroke leaves the numbers."""
    if not all(np.isfinite(part).all() for part in (flow.pose, flow.twist, flow.slope)):
        raise FloatingPointError("a stroke is not finite")


def flow_at(stroke: Stroke, tau: Floats, period: float) -> tuple[Flow, Floats]:
    """A stroke at fractions tau (N,) of its time: its flow per second, the fraction of its length.

    In the drawing frame. The fraction of the length is exact where the light needs it: in a
    gradient, and where it is even.
    """
    progress = stroke.progress(tau, period)
    if stroke.by_length:
        flow, fraction = flow_by_length(stroke.shape, stroke.extent, progress.value), progress.value
    else:
        flow = stroke.shape.flow(progress.value)
        light = stroke.segment.light
        matters = light is not None and (light.first != light.last or light.even)
        fraction = progress.value
        if matters:
            fraction = length_fraction(stroke.shape, stroke.extent, progress.value)
    return flow.at_rates(progress.rate, progress.slope), fraction


def _placed(program: Program, canvas: Floats) -> Floats:
    """The drawing frame (8,) in the base frame; one that is still to be found is on the canvas."""
    match program.placement:
        case Pose():
            return pose_array(program.placement)
        case Auto(orientation=turned) if turned is not None:
            return dq.pose_from(dq.translation(canvas), np.array(turned))
        case _:
            return canvas


def _assemble(
    program: Program,
    strokes: list[Stroke],
    ticks: list[Ticks],
    flows: list[tuple[Flow, Floats]],
    canvas: Floats,
    findings: tuple[Diagnostic, ...],
) -> Motion:
    placed = _placed(program, canvas)
    counts = np.array([tick.count for tick in ticks])
    n = int(counts.sum()) + 1
    pose, twist, acceleration = np.empty((n, 8)), np.empty((n, 6)), np.empty((n, 6))
    light, number = np.zeros((n, 3)), np.zeros(n, dtype=np.int64)
    clock = np.zeros(n)
    first = segments = begun = 0
    for stroke, tick, (flow, fraction) in zip(strokes, ticks, flows, strict=True):
        last = first + tick.count
        clock[first : last + 1] = (begun + tick.tau * stroke.count) * program.period
        begun += stroke.count
        # the end row is written too, and again by the stroke that begins there
        pose[first : last + 1] = flow.pose
        twist[first : last + 1] = flow.twist
        acceleration[first : last + 1] = flow.slope
        light[first:last] = glow(stroke, flow, fraction, program.period)
        number[first : last + 1] = segments
        if len(stroke.segments) > 1:
            number[first : last + 1] += part_at(stroke.edges, fraction)
        first, segments = last, segments + len(stroke.segments)
    number[-1] = segments - 1
    lines = np.array([segment.line for segment in program.segments])
    steps = np.array([isinstance(segment.path, Step) for segment in program.segments])
    t = np.arange(n, dtype=np.float64) * program.period
    slowed = any(tick.rate is not None for tick in ticks)
    return Motion(
        period=program.period,
        t=t,
        pose=dq.continuous(dq.mul(placed, pose)),
        twist=dq.adjoint(placed, twist),
        acceleration=dq.adjoint(placed, acceleration),
        light=light,
        line=lines[number],
        stroke=number,
        canvas=np.array(placed),
        front=np.array(dq.rotation(canvas)),
        jump=steps[number],
        clock=clock if slowed else t,
        program=program,
        length=sum(stroke.extent.length for stroke in strokes),
        unevenness=max(ends_over_middle(stroke, program.period) for stroke in strokes),
        notes=program.notes + findings,
    )

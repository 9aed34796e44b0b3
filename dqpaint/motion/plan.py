"""Program -> Motion: what the light is asked to do at every sample, in the robot's base frame."""

from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from dqpaint import dq
from dqpaint.dq import Floats
from dqpaint.language.diagnostics import Diagnostic, ScriptError
from dqpaint.language.findings import EnoughError, Findings
from dqpaint.language.program import Auto, Pose, Program, Step
from dqpaint.motion.lengths import flow_by_length, length_fraction
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
        program: what was planned.
        length: of the path [m], dark parts included.
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
    program: Program
    length: float
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


def plan(program: Program, canvas: Floats) -> Motion:
    """The motion a program asks for.

    Args:
        program: from `dqpaint.language`.
        canvas: pose (8,) of the robot's canvas in its base frame; a `place` line goes before it.

    Raises:
        ScriptError: a stroke without a timetable, or more samples than the budget.
    """
    findings = Findings()
    strokes: list[Stroke] = []
    flows: list[tuple[Flow, Floats]] = []
    try:
        strokes = timetable(program, findings)
        for stroke in strokes:
            try:
                with stroke_errors(stroke.segment):
                    flows.append(flow_at(stroke, stroke.samples, program.period))
                    check_finite(flows[-1][0])
            except StrokeError as fault:
                for diagnostic in fault.diagnostics:
                    findings.add(diagnostic)
    except EnoughError:
        pass
    if findings.errors:
        raise ScriptError(program.name, program.text, findings.ordered())
    return _assemble(program, strokes, flows, canvas, findings.ordered())


def check_finite(flow: Flow) -> None:
    """Raise FloatingPointError where a stroke leaves the numbers."""
    if not all(np.isfinite(part).all() for part in (flow.pose, flow.twist, flow.slope)):
        raise FloatingPointError("a stroke is not finite")


def flow_at(stroke: Stroke, tau: Floats, period: float) -> tuple[Flow, Floats]:
    """A stroke at fractions tau (N,) of its time: its flow per second, the fraction of its length.

    In the drawing frame. The fraction of the length is exact where the light needs it: in a
    gradient.
    """
    progress = stroke.progress(tau, period)
    if stroke.by_length:
        flow, fraction = flow_by_length(stroke.shape, stroke.extent, progress.value), progress.value
    else:
        flow = stroke.shape.flow(progress.value)
        light = stroke.segment.light
        graded = light is not None and light.first != light.last
        fraction = progress.value
        if graded:
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
    flows: list[tuple[Flow, Floats]],
    canvas: Floats,
    findings: tuple[Diagnostic, ...],
) -> Motion:
    placed = _placed(program, canvas)
    counts = np.array([stroke.count for stroke in strokes])
    n = int(counts.sum()) + 1
    pose, twist, acceleration = np.empty((n, 8)), np.empty((n, 6)), np.empty((n, 6))
    light = np.zeros((n, 3))
    first = 0
    for stroke, (flow, fraction) in zip(strokes, flows, strict=True):
        last = first + stroke.count
        # the end row is written too, and again by the stroke that begins there
        pose[first : last + 1] = flow.pose
        twist[first : last + 1] = flow.twist
        acceleration[first : last + 1] = flow.slope
        colours = stroke.segment.light
        if colours is not None:
            # a law may run beyond the ends of a stroke; its colours do not
            middle = np.clip(0.5 * (fraction[1:] + fraction[:-1]), 0.0, 1.0)[:, None]
            light[first:last] = (1 - middle) * colours.first + middle * np.array(colours.last)
        first = last
    lines = np.array([stroke.segment.line for stroke in strokes])
    number = np.repeat(np.arange(len(strokes)), counts)
    number = np.append(number, number[-1])
    return Motion(
        period=program.period,
        t=np.arange(n, dtype=np.float64) * program.period,
        pose=dq.continuous(dq.mul(placed, pose)),
        twist=dq.adjoint(placed, twist),
        acceleration=dq.adjoint(placed, acceleration),
        light=light,
        line=lines[number],
        stroke=number,
        canvas=np.array(placed),
        front=np.array(dq.rotation(canvas)),
        jump=np.array([isinstance(stroke.segment.path, Step) for stroke in strokes])[number],
        program=program,
        length=sum(stroke.extent.length for stroke in strokes),
        notes=program.notes + findings,
    )

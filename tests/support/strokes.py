"""One segment of every kind, from a general start pose, for the tests of motion."""

import math
from dataclasses import dataclass, replace

import numpy as np

from dqpaint import dq
from dqpaint.diagnostics import SourceLine, Span
from dqpaint.diagnostics.collector import DiagnosticCollector
from dqpaint.motion.geometry.batched_shapes import shape
from dqpaint.motion.geometry.shapes import Flow
from dqpaint.motion.profiles import Progress
from dqpaint.motion.schedule import Schedule, schedule_strokes
from dqpaint.program import piecewise, taylor
from dqpaint.program.program import (
    Arc,
    CruiseSpeed,
    Curve,
    Duration,
    FixedOrientation,
    FollowHeading,
    Light,
    Look,
    LookLine,
    Pose,
    Profile,
    Program,
    Screw,
    ScrewTo,
    Segment,
    SlerpOrientation,
    Straight,
)

START = Pose((0.11, -0.07, 0.05), tuple(np.array([0.3, -0.5, 0.7, 0.4]) / math.sqrt(0.99)))
TURNED = tuple(np.array([0.1, 0.6, -0.2, 0.5]) / math.sqrt(0.66))
AXIS = tuple(np.array([1.0, -2.0, 2.0]) / 3)


def formula(t):
    """A crooked space curve through START at t = 0.2, using every function of the language."""
    x = 0.1 * taylor.sin(3 * t) + 0.02 * taylor.exp(-1.0 * t) + 0.01 * taylor.absolute(t - 9)
    y = 0.08 * taylor.cos(2 * t) * taylor.sqrt(t + 1.0) + 0.01 * taylor.tan(0.3 * t)
    z = 0.05 * t * t + 0.02 * taylor.ln(t + 2) + 0.01 * taylor.atan(t) / (1 + t)
    z = z + 0.01 * taylor.asin(0.3 * t) + 0.01 * taylor.acos(0.2 * t) + 0.01 * taylor.power(t, 3)
    z = z + 0.01 * taylor.minimum(t, 5.0 - t) + 0.01 * taylor.maximum(t, -1.0)
    z = z + 0.01 * taylor.power(t + 1.0, 0.5)
    at = np.array([float(c) for c in _raw(0.2)])
    return tuple(c + (p - a) for c, p, a in zip((x, y, z), START.position, at, strict=True))


def _raw(t):
    x = 0.1 * math.sin(3 * t) + 0.02 * math.exp(-t) + 0.01 * abs(t - 9)
    y = 0.08 * math.cos(2 * t) * math.sqrt(t + 1) + 0.01 * math.tan(0.3 * t)
    z = 0.05 * t * t + 0.02 * math.log(t + 2) + 0.01 * math.atan(t) / (1 + t)
    z += 0.01 * math.asin(0.3 * t) + 0.01 * math.acos(0.2 * t) + 0.01 * t**3
    z += 0.01 * min(t, 5 - t) + 0.01 * max(t, -1) + 0.01 * math.sqrt(t + 1)
    return x, y, z


BEZIER = np.array([START.position, (0.3, 0.1, -0.2), (-0.1, 0.25, 0.1), (0.2, 0.1, 0.0)])
HALF_AXES = np.array([[0.08, 0.02, -0.01], [0.03, -0.05, 0.06]])  # conjugate, not square

PATHS = {
    "line": Straight((0.12, 0.05, -0.09)),
    "turn": Straight((0.0, 0.0, 0.0)),
    "circle": Arc((0.05, 0.02, -0.03), AXIS, 2.1),
    "helix": Arc((0.05, 0.02, -0.03), AXIS, -3.3, rise=0.07),
    "spiral": Arc((0.05, 0.02, -0.03), AXIS, 5.0, rise=-0.02, grow=0.06),
    "screw": Screw((0.4, 0.1, -0.2), AXIS, 1.7, 0.08),
    "screw-to": ScrewTo(),
    "curve": Curve(formula, 0.2, 1.4),
    "bezier": piecewise.bezier(BEZIER),
    "ellipse": piecewise.arc(
        START.position - np.cos(0.4) * HALF_AXES[0] - np.sin(0.4) * HALF_AXES[1],
        *(*HALF_AXES, 0.4, -3.9),
    ),
}
TOOLS = {
    "keep": FixedOrientation(),
    "turn": SlerpOrientation(),
    "follow": FollowHeading((0.6, 0.0, 0.8)),
    "look": Look((0.5, 0.9, -1.3), (0.0, 0.6, 0.8)),
    "look-line": LookLine((0.9, -0.4, 0.8), AXIS),
}
PROFILES = {
    "constant": Profile("constant"),
    "trapezoid": Profile("trapezoid"),
    "cubic": Profile("cubic"),
    "cubic-rates": Profile("cubic", (0.02, 0.04)),
    "quintic": Profile("quintic"),
    "quintic-rates": Profile("quintic", (0.02, 0.04, -0.01, 0.03)),
    "smooth": Profile("smooth", acceleration=0.4, jerk=1.5),
}
CRUISING = ("trapezoid", "cubic", "smooth")
RIGID = {"screw", "screw-to"}
CHAINS = {"bezier", "ellipse"}  # what is made of pieces has corners, in general
KINDS = [
    (path, tool)
    for path in PATHS
    for tool in TOOLS
    if (path not in RIGID or tool == "follow")
    and (path != "turn" or tool == "turn")
    and (path not in CHAINS or tool != "follow")
]


def segment(path, tool, profile="trapezoid", timing=None, start=START):
    """The stroke of these kinds, with its end pose as the language would compute it."""
    made = Segment(
        path=PATHS[path],
        tool=TOOLS[tool],
        profile=PROFILES[profile],
        timing=timing or (CruiseSpeed(0.08, 0.9) if profile in CRUISING else Duration(2.504)),
        light=Light((1.0, 0.2, 0.0), (0.0, 0.3, 1.0)),
        start=start,
        end=Pose((0.2, 0.1, -0.3), TURNED),
        span=Span(0, 4),
        line=SourceLine(0, 1),
    )
    if tool in ("look", "look-line"):  # the start lies on the look, as the language makes sure
        form = shape(made)
        r = form.orientations(np.zeros(1), form.positions(np.zeros(1)))[0][0]
        made = replace(made, start=Pose(start.position, tuple(r)))
    last = shape(made).flow(np.ones(1)).pose[0]
    return replace(made, end=Pose(tuple(dq.translation(last)), tuple(last[:4])))


def program(*segments, period=0.008, placement=None):
    """A drawing of these strokes."""
    return Program(
        "test.traj", "line", period, None, None, placement, segments[0].start, segments, ()
    )


@dataclass(frozen=True)
class Stroke:
    """One stroke of a timetable."""

    table: Schedule
    number: int

    @property
    def count(self) -> int:
        return int(self.table.count[self.number])

    @property
    def length(self) -> float:
        return float(self.table.length[self.number])

    @property
    def edges(self):
        return self.table.edges(self.number)

    @property
    def breakpoints(self):
        """The fractions of its time at which its jerk jumps; none of a profile alone."""
        number, pace = self.table.paced[self.number], self.table.pace
        if number < 0:
            return np.empty(0)
        own = slice(pace.first[number], pace.last[number] + 1)
        return pace.time[own] / pace.seconds[number]

    @property
    def samples(self):
        return np.arange(self.count + 1) / self.count

    def progress(self, tau) -> Progress:
        return self.table.progress(np.full(len(tau), self.number), tau)

    def flow(self, tau) -> Flow:
        return self._flow(tau)[0]

    def fraction(self, tau):
        return self._flow(tau)[1]

    def _flow(self, tau):
        faults = {}
        found = self.table.flow(np.full(len(tau), self.number), tau, faults)
        assert not faults
        return found


def strokes_of(drawing):
    """The strokes of a program without a fault."""
    findings = DiagnosticCollector()
    table = schedule_strokes(drawing, findings)
    assert not findings.errors
    return [Stroke(table, number) for number in range(len(table))]

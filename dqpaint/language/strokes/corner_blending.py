"""Segments with `blend` -> segments whose corners are replaced by Bezier curves.

Two straight lines are joined by the arc of a circle that touches both; where an arc or a helix is
one of the two, by the cubic Bezier curve that touches both and would be nearest to an arc between
lines. Strokes that are joined become one continuous stroke: one profile runs over all of them. A
stroke that is too short for its corners is an error; nothing is rounded less than was asked.
"""

import math
from collections.abc import Sequence
from dataclasses import replace
from itertools import pairwise
from typing import NamedTuple

from dqpaint.diagnostics import Diagnostic, DiagnosticCollector
from dqpaint.language.pen import tool_orientation
from dqpaint.language.pen.pen import Rounding, evenly
from dqpaint.language.strokes import arcs
from dqpaint.language.values import vectors
from dqpaint.program import (
    LOOK_MODES,
    STANDING,
    Arc,
    ContinuousStroke,
    CruiseSpeed,
    Curve,
    Duration,
    FollowHeading,
    Formula,
    Light,
    Path,
    PiecewiseCurve,
    Pose,
    Quaternion,
    Samples,
    Segment,
    SlerpOrientation,
    Straight,
    Taylor,
    Timing,
    Tool,
    Vector,
)

NO_WAY = 1e-15  # [m]: an arc of the least angle there is has a length of zero
SMOOTH = 1e-6  # [rad]: less than this is no corner
BACK = 1e-3  # [rad] from a half turn: the way turns back, and the tool stops there
MOST = 0.49  # of a stroke's length for a corner that is rounded as little as may be
CLOSE = 1e-12  # of a stroke's length: what rounding may leave of it


class _Joint(NamedTuple):
    """The transition between two segments."""

    joined: bool  # the second goes on without a stop
    cut: float  # so much of the first one's end and of the second one's start is left out [m]


_NO_JOINT = _Joint(joined=False, cut=0.0)


def round_corners(
    segments: Sequence[Segment], corners: Sequence[Rounding], findings: DiagnosticCollector
) -> list[Segment]:
    """The segments with rounded corners.

    Args:
        segments: as they were drawn.
        corners: how the end of each is to be rounded.
        findings: takes what can't be done.
    """
    joints = [
        _joint(a, b, corner, findings)
        for (a, b), corner in zip(pairwise(segments), corners[:-1], strict=True)
    ]
    shares = [
        _shares(segment, before.cut, after.cut, findings)
        for segment, before, after in zip(
            segments, [_NO_JOINT, *joints], [*joints, _NO_JOINT], strict=True
        )
    ]
    if findings.errors:
        return list(segments)
    out: list[Segment] = []
    number = max((s.stroke.number for s in segments if s.stroke is not None), default=0)
    first = 0
    for last, joint in enumerate([*joints, _NO_JOINT]):
        if not joint.joined:
            group = slice(first, last + 1)
            pieces = _pieces(segments[group], shares[group], joints[first:last])
            number += 1
            acceleration = corners[first].acceleration
            out += _as_stroke(segments[group], pieces, number, acceleration, findings)
            first = last + 1
    return out


def _pieces(
    segments: Sequence[Segment],
    shares: Sequence[tuple[float, float]],
    joints: Sequence[_Joint],
) -> list[Segment]:
    """The shortened segments in a row, with the curves round the corners between them."""
    pieces = []
    for i, (segment, (lower, upper)) in enumerate(zip(segments, shares, strict=True)):
        if lower < upper:
            pieces.append(_subsegment(segment, lower, upper))
        if i < len(joints) and joints[i].cut:
            pieces.append(_corner_segment(segment, upper, segments[i + 1], shares[i + 1][0]))
    return pieces


def _joint(a: Segment, b: Segment, corner: Rounding, findings: DiagnosticCollector) -> _Joint:
    """Whether and how a corner is rounded: not where the pen is lifted, nor at a pause.

    Imported strokes keep their own start and end.
    """
    size = corner.blend
    if not size and corner.deviation and a.stroke is not None and a.stroke is b.stroke:
        return _near_joint(a, b, corner.deviation)
    if isinstance(a.path, PiecewiseCurve) or isinstance(b.path, PiecewiseCurve):
        return _NO_JOINT
    lifted = (a.light is None) != (b.light is None)
    if not size or lifted or a.stroke != b.stroke or _rests(a) or _rests(b):
        return _NO_JOINT
    if not (_is_known(a.path) and _is_known(b.path)):
        return _warn(findings, a, "E285", "this corner can't be rounded: only those between lines "
                     "and arcs can", "switch it off before: blend off")  # fmt: skip
    turn = vectors.angle_between(_direction(a, 1.0), _direction(b, 0.0))
    if turn > math.pi - SMOOTH:
        help = "switch it off before: blend off"
        return _warn(findings, a, "E286", "the way turns back here, which no arc rounds", help)
    return _Joint(joined=True, cut=size if turn > SMOOTH else 0.0)


def _near_joint(a: Segment, b: Segment, deviation: float) -> _Joint:
    """A corner within a stroke, no farther from the path than `deviation` [m], where one can be.

    An arc that touches two lines of the turn t at the distance c from their corner is
    c tan(t / 4) away from it. It takes less than half of a line, for there is one at each end.
    """
    if not (_is_known(a.path) and _is_known(b.path)):
        return _NO_JOINT
    turn = vectors.angle_between(_direction(a, 1.0), _direction(b, 0.0))
    if not SMOOTH < turn < math.pi - BACK:
        return _NO_JOINT
    reach = deviation / math.tan(0.25 * turn)
    return _Joint(joined=True, cut=min(reach, MOST * _length(a), MOST * _length(b)))


def _warn(
    findings: DiagnosticCollector, segment: Segment, code: str, message: str, help: str
) -> _Joint:
    findings.add(Diagnostic(code, message, segment.span, "", help))
    return _NO_JOINT


def _rests(segment: Segment) -> bool:
    path = segment.path
    return isinstance(path, STANDING) or (_is_known(path) and _length(segment) < NO_WAY)


def _is_known(path: Path) -> bool:
    return isinstance(path, Straight) or (isinstance(path, Arc) and path.grow == 0.0)


def _shares(
    segment: Segment, first: float, last: float, findings: DiagnosticCollector
) -> tuple[float, float]:
    """The rest of a segment that is shortened at its start and its end [m]."""
    if not first and not last:
        return 0.0, 1.0
    length = _length(segment)
    lower, upper = first / length, 1.0 - last / length
    if lower <= upper - CLOSE:
        return lower, upper
    if lower <= upper + CLOSE:
        return lower, lower  # nothing
    ends = "each end" if first and last else "its start" if first else "its end"
    findings.add(
        Diagnostic(
            "E284",
            f"this stroke is too short for its rounded corners: it is {_mm(length)} long",
            segment.span,
            f"blend {_mm(last or first)} takes that much from {ends}",
            f"at most: blend {_mm(_round_down(length / (2.0 if first and last else 1.0)))}",
        )
    )
    return 0.0, 1.0


def _mm(size: float) -> str:
    return f"{1e3 * size:.4g} mm"


def _round_down(size: float) -> float:
    """Rounded down to three digits, so that the suggested size works."""
    unit = 10.0 ** (math.floor(math.log10(size)) - 2)
    return math.floor(size / unit * (1.0 + CLOSE)) * unit


# The geometry of a line or an arc, by the share of its length.


def _length(segment: Segment) -> float:
    path = segment.path
    if isinstance(path, Arc):
        radius = vectors.length(
            vectors.across(vectors.minus(segment.start.position, path.centre), path.axis)
        )
        return math.hypot(radius * path.angle, path.rise)
    return vectors.length(vectors.minus(segment.end.position, segment.start.position))


def _direction(segment: Segment, share: float) -> Vector:
    path = segment.path
    if not isinstance(path, Arc):
        assert isinstance(path, Straight)
        return vectors.unit(path.by)
    arm = vectors.minus(arcs.point_at(path, segment.start.position, share), path.centre)
    most = max(abs(path.angle), abs(path.rise))  # divided by it no angle is too small to multiply
    round_ = vectors.times(path.angle / most, vectors.cross(path.axis, arm))
    return vectors.unit(vectors.plus(round_, vectors.times(path.rise / most, path.axis)))


def _pose(segment: Segment, share: float) -> Pose:
    if share <= 0.0:
        return segment.start
    if share >= 1.0:
        return segment.end
    path, start = segment.path, segment.start
    if isinstance(path, Arc):
        position = arcs.point_at(path, start.position, share)
    else:
        assert isinstance(path, Straight)
        position = vectors.plus(start.position, vectors.times(share, path.by))
    return Pose(position, _orientation(segment, share, position))


def _orientation(segment: Segment, share: float, position: Vector) -> Quaternion:
    tool, start = segment.tool, segment.start.orientation
    if isinstance(tool, LOOK_MODES):
        return tool_orientation.orientation_at(tool, position, segment.span)
    if isinstance(tool, SlerpOrientation):
        return vectors.part_of_turn(start, segment.end.orientation, share)
    if isinstance(tool, FollowHeading) and isinstance(segment.path, Arc):
        turn = vectors.turn_about(segment.path.axis, share * segment.path.angle)
        return vectors.turn_product(turn, start)
    return start


def _subsegment(segment: Segment, lower: float, upper: float) -> Segment:
    """A segment between two fractions of its length."""
    if (lower, upper) == (0.0, 1.0):
        return segment
    share, path = upper - lower, segment.path
    if isinstance(path, Arc):
        path = replace(path, angle=share * path.angle, rise=share * path.rise)
    else:
        assert isinstance(path, Straight)
        path = Straight(vectors.times(share, path.by))
    light = segment.light
    if light is not None and not _of_run(segment):
        light = light.part(lower, upper)
    start, end = _pose(segment, lower), _pose(segment, upper)
    return replace(segment, path=path, light=light, start=start, end=end)


def _of_run(segment: Segment) -> bool:
    return segment.stroke is not None and segment.light == segment.stroke.light


# The piece that goes round the corner.


def _corner_segment(a: Segment, leaves: float, b: Segment, joins: float) -> Segment:
    """From a fraction of one segment's length to a fraction of the next one's."""
    start, end = _pose(a, leaves), _pose(b, joins)
    light = a.light
    if light is not None and b.light is not None and not (_of_run(a) and _of_run(b)):
        light = Light(light.at(leaves), b.light.at(joins), light.even)
    path = _blend_curve(
        a, b, _direction(a, leaves), _direction(b, joins), start.position, end.position
    )
    tool = _tool(a.tool, b.tool, start, end)
    return replace(a, path=path, tool=tool, light=light, start=start, end=end)


def _tool(a: Tool, b: Tool, start: Pose, end: Pose) -> Tool:
    """A tool that looks still looks; another rotates evenly from one stroke to the next."""
    if a == b and isinstance(a, LOOK_MODES):
        return a
    return tool_orientation.rotation_between(start.orientation, end.orientation)[0]


def _blend_curve(
    a: Segment, b: Segment, out: Vector, into: Vector, start: Vector, end: Vector
) -> Path:
    turn = vectors.angle_between(out, into)
    chord = vectors.length(vectors.minus(end, start))
    if isinstance(a.path, Straight) and isinstance(b.path, Straight):
        axis = vectors.unit(vectors.cross(out, into))
        radius = 0.5 * chord / math.sin(0.5 * turn)
        return Arc(vectors.plus(start, vectors.times(radius, vectors.cross(axis, out))), axis, turn)
    handle = chord / (3.0 * math.cos(0.25 * turn) ** 2)
    near = vectors.plus(start, vectors.times(handle, out))
    far = vectors.minus(end, vectors.times(handle, into))
    return Curve(bezier(start, near, far, end), 0.0, 1.0)


def bezier(*points: Vector) -> Formula:
    """The cubic Bezier curve with these four control points, over 0 to 1."""
    p0, p1, p2, p3 = points
    c1 = vectors.times(3.0, vectors.minus(p1, p0))
    c2 = vectors.times(3.0, vectors.plus(vectors.minus(p2, p1), vectors.minus(p0, p1)))
    c3 = vectors.minus(vectors.minus(p3, p0), vectors.times(3.0, vectors.minus(p2, p1)))

    def formula(t: Taylor) -> tuple[Taylor, Taylor, Taylor]:
        x, y, z = (
            d0 + t * (d1 + t * (d2 + t * d3)) for d0, d1, d2, d3 in zip(p0, c1, c2, c3, strict=True)
        )
        return x, y, z

    return formula


# Time: one profile over what has been joined.


def _as_stroke(
    segments: Sequence[Segment],
    pieces: list[Segment],
    number: int,
    acceleration: float,
    findings: DiagnosticCollector,
) -> list[Segment]:
    """The pieces of joined segments, with the time of all of them."""
    if len(segments) == 1 or segments[0].stroke is not None:
        return pieces
    profile, timing = segments[0].profile, _total_timing(segments)
    other = next((s for s in segments if s.profile != profile), None)
    if timing is None:
        other = next((s for s in segments if s.timing != segments[0].timing), segments[-1])
    if timing is None or other is not None:
        assert other is not None
        what = "times" if timing is None else "profiles"
        message = f"a rounded corner joins two strokes with different {what}"
        help = "say it once for both: stroke … end, or switch it off before: blend off"
        findings.add(Diagnostic("E287", message, other.span, "", help))
        return pieces
    profile = replace(profile, acceleration=acceleration)
    stroke = ContinuousStroke(number, profile, timing)
    return [
        replace(
            piece, timing=timing, stroke=stroke, profile=profile,
            light=evenly(piece.light) if acceleration else piece.light,
        )
        for piece in pieces
    ]  # fmt: skip


def _total_timing(segments: Sequence[Segment]) -> Timing | None:
    """The timing of segments in a row: their speed, or the time of a statement's legs together."""
    timings = [segment.timing for segment in segments]
    if isinstance(timings[0], CruiseSpeed):
        return timings[0] if all(timing == timings[0] for timing in timings) else None
    if any(segment.span != segments[0].span for segment in segments):
        return None
    seconds = [timing.seconds for timing in timings if isinstance(timing, Duration)]
    if len(seconds) == len(timings):
        return Duration(math.fsum(seconds))
    counts = [timing.count for timing in timings if isinstance(timing, Samples)]
    return Samples(sum(counts)) if len(counts) == len(timings) else None

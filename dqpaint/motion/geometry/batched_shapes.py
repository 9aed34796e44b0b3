"""Segments of a drawing -> their shapes; segments of one kind are computed in one batch.

A drawing of ten thousand lines has only a few kinds: their parameters are in arrays, one row per
segment, and a formula is evaluated for all rows in one call. A curve is its own kind. A new kind
of path is a line in `PATH_KINDS`.
"""

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from dqpaint import dq
from dqpaint.dq import Floats
from dqpaint.motion.geometry.arc_length import (
    Extent,
    flow_by_length,
    measure_stroke,
    measure_uniform,
)
from dqpaint.motion.geometry.orientations import orientation_along
from dqpaint.motion.geometry.paths import (
    Arcs,
    Formula,
    Indices,
    Positions,
    arc_positions,
    column,
    paths_of,
    straight_positions,
)
from dqpaint.motion.geometry.piecewise_paths import Pieces, piecewise_positions
from dqpaint.motion.geometry.shapes import Bends, Flow, Jump, PositionAndOrientation, Rigid, Shape
from dqpaint.motion.stroke_errors import Faults, StrokeError, pole, stroke_errors
from dqpaint.program import (
    Arc,
    CruiseSpeed,
    Curve,
    Dwell,
    FixedOrientation,
    FollowHeading,
    Path,
    PiecewiseCurve,
    Screw,
    ScrewTo,
    Segment,
    Step,
    Straight,
    Vector,
)

Kind = tuple[object, ...]
Flags = NDArray[np.bool_]
Rows = Indices | slice


def shape(segment: Segment) -> Shape:
    """The shape of one segment."""
    return _shape((segment,)).select(0)


@dataclass(frozen=True, eq=False)
class Shapes:
    """The shapes of all segments of a drawing, grouped by kind.

    Attributes:
        segments: all of them (M).
        families: the shapes of those of one kind.
        family: which of these each segment belongs to (M,); -1 where it has no shape.
        member: and its row there (M,).
        length: of each path [m] (M,).
        angle: that each tool turns through [rad] (M,).
        nonuniform: the extents of those whose point does not run at one speed, by their number.
    """

    segments: tuple[Segment, ...]
    families: list[Shape]
    family: Indices
    member: Indices
    length: Floats
    angle: Floats
    nonuniform: dict[int, Extent]

    def shape(self, number: int) -> Shape:
        """The shape of one segment."""
        family: Shape = self.families[self.family[number]]
        return family.select(int(self.member[number]))

    def flow(self, number: Indices, f: Floats, by_length: Flags, faults: Faults) -> Flow:
        """The flow of segments at fractions f (N,), per unit of f.

        Args:
            number: the segment of each row (N,).
            f: of its parameter.
            by_length: of which segments (M,) it is the fraction of their length instead.
            faults: gets what goes wrong, by the segment; there the rows are not finite.
        """
        pose, twist, slope = np.empty((len(f), 8)), np.empty((len(f), 6)), np.empty((len(f), 6))
        for rows, first, whole in self._groups(number, by_length):
            try:
                with stroke_errors(self.segments[first]):
                    if whole:
                        flow = flow_by_length(self.shape(first), self.nonuniform[first], f[rows])
                    else:
                        family = self.families[self.family[first]]
                        flow = family.select(self.member[number[rows]]).flow(f[rows])
            except StrokeError as fault:
                faults.setdefault(first, fault.diagnostics)
                pose[rows] = twist[rows] = slope[rows] = np.nan
            else:
                pose[rows], twist[rows], slope[rows] = flow.pose, flow.twist, flow.slope
        return Flow(pose, twist, slope)

    def pieces(self, family: int) -> Pieces | None:
        """The positions of a family of piecewise curves."""
        form = self.families[family]
        places = form.positions if isinstance(form, PositionAndOrientation) else None
        return places if isinstance(places, Pieces) else None

    def bends(self, number: Indices, piece: Indices, g: Floats, by_length: Flags) -> Bends:
        """The bends of segments (N,); they are not finite where something is wrong.

        Piecewise curves are looked at by the parameters g (N,) of their pieces (N,), which needs
        no way back from a length; any other segment at fractions of its length.
        """
        out = Bends(*(np.empty((len(g), 3)) for _ in Bends._fields))
        for family, rows in group_equal(self.family[number]):
            some, form = number[rows], self.families[family]
            if self.pieces(family):
                assert isinstance(form, PositionAndOrientation)
                try:
                    with stroke_errors(self.segments[some[0]]):
                        found = form.select(self.member[some]).bends(piece[rows], g[rows])
                except StrokeError:
                    found = Bends(*[np.full(3, np.nan)] * len(out))
            else:
                found = self.flow(some, g[rows], by_length, {}).bends(self.length[some])
            for values, own in zip(out, found, strict=True):
                values[rows] = own
        return out

    def points(self, number: Indices, f: Floats) -> Floats:
        """The positions (N, 3) [m] on segments with uniform speed."""
        out = np.empty((len(f), 3))
        for family, rows in group_equal(self.family[number]):
            out[rows] = self.families[family].select(self.member[number[rows]]).points(f[rows])
        return out

    def may_leave_box(self, number: Indices, least: Floats, most: Floats) -> Flags:
        """Whether segments (N,) may leave a box that contains their ends."""
        out = np.ones(len(number), dtype=bool)
        for family, rows in group_equal(self.family[number]):
            form = self.families[family]
            if form.straight:
                out[rows] = False
            elif isinstance(form, PositionAndOrientation) and isinstance(form.positions, Arcs):
                lower, upper = form.positions.select(self.member[number[rows]]).bounds()
                out[rows] = ((lower < least) | (upper > most)).any(axis=1)
        return out

    def _groups(self, number: Indices, by_length: Flags) -> Iterator[tuple[Rows, int, bool]]:
        """Rows that are computed together, the first of their segments, and whether by length."""
        for family, rows in group_equal(self.family[number]):
            some = number[rows]
            if self.families[family].uniform or not by_length[some].any():
                yield rows, int(some[0]), False
                continue
            for of, part in group_equal(np.where(by_length[some], some, -1)):
                inner = np.arange(len(number))[rows][part]
                yield inner, int(number[inner][0]), bool(of >= 0)


def gather_shapes(segments: tuple[Segment, ...], faults: Faults, most: float = np.inf) -> Shapes:
    """The shapes and lengths of segments; errors are recorded for each segment.

    Curves are measured one by one, which takes a while: not those that come after `most` seconds
    of curves, with which the drawing is too long.
    """
    kinds: dict[Kind, list[int]] = {}
    for number, segment in enumerate(segments):
        kinds.setdefault(_kind(number, segment), []).append(number)
    n = len(segments)
    families: list[Shape] = []
    family, member = np.full(n, -1, dtype=np.intp), np.zeros(n, dtype=np.intp)
    length, angle = np.zeros(n), np.zeros(n)
    uneven: dict[int, Extent] = {}
    spent = 0.0  # seconds of curves, at least
    for members in kinds.values():
        try:
            with stroke_errors(segments[members[0]]):
                made = _shape([segments[number] for number in members])
                if made.uniform:
                    length[members], angle[members] = made.speeds(np.zeros(len(members)))
                elif made.uniform_position:
                    length[members], angle[members] = measure_uniform(made, len(members))
                elif spent <= most:
                    for row, number in enumerate(members):
                        extent = measure_stroke(made.select(row))
                        spent += _least_seconds(segments[number], extent)
                        if not extent.converged:
                            raise StrokeError(pole(segments[number]))
                        length[number], angle[number] = extent.length, extent.angle
                        if not extent.uniform:
                            uneven[number] = extent
        except StrokeError as fault:
            faults[members[0]] = fault.diagnostics
            continue
        family[members], member[members] = len(families), np.arange(len(members))
        families.append(made)
    return Shapes(segments, families, family, member, length, angle, uneven)


def _least_seconds(segment: Segment, extent: Extent) -> float:
    """The least duration of a segment that follows from its length."""
    timing = segment.timing
    if segment.stroke is not None or not isinstance(timing, CruiseSpeed):
        return 0.0
    return extent.length / timing.speed


def _kind(number: int, segment: Segment) -> Kind:
    alike = PATH_KINDS[type(segment.path)].alike
    return (number,) if alike is None else (type(segment.path), *alike(segment))


def _shape(segments: Sequence[Segment]) -> Shape:
    """The shape of segments of one kind, one a row."""
    start = dq.pose_from(
        column([s.start.position for s in segments]),
        column([s.start.orientation for s in segments]),
    )
    return PATH_KINDS[type(segments[0].path)].shape(segments, start)


# One function for each kind of path: segments, and the poses (K, 8) where they start -> shape.


def _dwell(segments: Sequence[Segment], start: Floats) -> Shape:
    return Rigid(start, np.zeros((len(segments), 6)))


def _step(segments: Sequence[Segment], start: Floats) -> Shape:
    return Jump(start, _ends(segments))


def _screw_to(segments: Sequence[Segment], start: Floats) -> Shape:
    return Rigid(start, 2 * dq.log(dq.mul(_ends(segments), dq.conj(start))))


def _screw(segments: Sequence[Segment], start: Floats) -> Shape:
    screws = paths_of(segments, Screw)
    return Rigid(start, _screws([(s.point, s.axis, s.angle, s.advance) for s in screws]))


def _straight(segments: Sequence[Segment], start: Floats) -> Shape:
    if not isinstance(segments[0].tool, FixedOrientation | FollowHeading):
        return _loose(segments, straight_positions(segments))
    by = column([path.by for path in paths_of(segments, Straight)])
    return Rigid(start, np.concatenate([np.zeros_like(by), by], axis=1))


def _arc(segments: Sequence[Segment], start: Floats) -> Shape:
    arcs = paths_of(segments, Arc)
    if not isinstance(segments[0].tool, FollowHeading) or arcs[0].grow != 0:
        return _loose(segments, arc_positions(segments))
    return Rigid(start, _screws([(a.centre, a.axis, a.angle, a.rise) for a in arcs]))


def _curve(segments: Sequence[Segment], _start: Floats) -> Shape:
    (curve,) = paths_of(segments, Curve)
    return _loose(segments, Formula(curve))


def _piecewise(segments: Sequence[Segment], _start: Floats) -> Shape:
    return _loose(segments, piecewise_positions(paths_of(segments, PiecewiseCurve)))


def _loose(segments: Sequence[Segment], places: Positions) -> Shape:
    return PositionAndOrientation(places, orientation_along(segments, places))


def _of_one_tool(segment: Segment) -> Kind:
    return (type(segment.tool),)


def _arcs_alike(segment: Segment) -> Kind:
    return type(segment.tool), isinstance(segment.path, Arc) and segment.path.grow != 0


class PathKind(NamedTuple):
    """How the shapes of one kind of path are made and batched.

    Attributes:
        shape: of segments that are alike, from the poses where they start.
        alike: what segments have in common that are computed at once, besides their kind of path;
            None: each is computed by itself.
    """

    shape: Callable[[Sequence[Segment], Floats], Shape]
    alike: Callable[[Segment], Kind] | None = lambda _segment: ()


PATH_KINDS: dict[type[Path], PathKind] = {
    Dwell: PathKind(_dwell),
    Step: PathKind(_step),
    ScrewTo: PathKind(_screw_to),
    Screw: PathKind(_screw),
    Straight: PathKind(_straight, _of_one_tool),
    Arc: PathKind(_arc, _arcs_alike),
    PiecewiseCurve: PathKind(_piecewise, _of_one_tool),
    Curve: PathKind(_curve, None),
}


def _ends(segments: Sequence[Segment]) -> Floats:
    return dq.pose_from(
        column([s.end.position for s in segments]), column([s.end.orientation for s in segments])
    )


def _screws(lines: Sequence[tuple[Vector, Vector, float, float]]) -> Floats:
    """The displacements (K, 6) of rotations and advances along lines; an angle may be zero."""
    points, axes, angles, advances = (column(values) for values in zip(*lines, strict=True))
    turn = angles[:, None] * dq.twist_from_screw(axes, points)
    return np.asarray(
        turn + advances[:, None] * np.concatenate([np.zeros_like(axes), axes], axis=1)
    )


def group_equal(values: Indices) -> Iterator[tuple[int, Rows]]:
    """Each distinct value and its rows, in order."""
    if not len(values):
        return
    if (values == values[0]).all():
        yield int(values[0]), slice(None)
        return
    order = np.argsort(values, kind="stable")
    found, begins = np.unique(values[order], return_index=True)
    for value, rows in zip(found, np.split(order, begins[1:]), strict=True):
        yield int(value), rows

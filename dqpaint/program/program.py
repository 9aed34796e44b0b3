"""The compiled drawing, from the language to the motion: plain data in SI units.

Every point, direction and orientation is in the drawing frame (x to the right of the picture,
y up, z towards the viewer); `with` blocks are already worked in. Lengths are metres, angles
radians, times seconds, colours linear RGB with 1 for full brightness. What the strokes mean as
motion is said in `dqpaint.motion`.
"""

from collections.abc import Callable
from dataclasses import dataclass
from itertools import pairwise
from typing import NamedTuple

import numpy as np

from dqpaint.core import DEFAULT_MAX_SAMPLES, record, replaced
from dqpaint.diagnostics import Diagnostic, SourceLine, Span, line_name
from dqpaint.program import colours
from dqpaint.program.colours import Colour as Colour
from dqpaint.program.taylor import Floats, Taylor
from dqpaint.program.walls import Wall

Vector = tuple[float, float, float]
Quaternion = tuple[float, float, float, float]
Formula = Callable[[Taylor], tuple[Taylor, Taylor, Taylor]]


class Pose(NamedTuple):
    """A position [m] and an orientation (unit quaternion, scalar first)."""

    position: Vector
    orientation: Quaternion


IDENTITY = Pose((0.0, 0.0, 0.0), (1.0, 0.0, 0.0, 0.0))


# Where the point of light goes.


@record
class Straight:
    """A straight line; `by` [m] from start to end. Zero length is a rotation on the spot."""

    by: Vector


@record
class Arc:
    """A rotation by `angle` [rad] about the line through `centre` along the unit vector `axis`.

    Evenly with the angle the point advances by `rise` [m] in all along the axis, and its distance
    from the axis changes by `grow` [m] in all: circle, helix, flat spiral, cone.
    """

    centre: Vector
    axis: Vector
    angle: float
    rise: float = 0.0
    grow: float = 0.0


@record
class Curve:
    """A formula of one parameter, run from `lower` to `upper`."""

    formula: Formula
    lower: float
    upper: float


@record
class Screw:
    """A rigid rotation by `angle` [rad] about a line and a translation by `advance` [m] along it.

    The line goes through `point` along the unit vector `axis`.
    """

    point: Vector
    axis: Vector
    angle: float
    advance: float


@record
class ScrewTo:
    """The screw motion from the start pose to the end pose, the short way (ScLERP)."""


@record
class Dwell:
    """The tool stays at the start pose."""


@record
class Step:
    """A jump of the reference to the end pose, within one sample."""


@dataclass(frozen=True, slots=True, eq=False)
class PiecewiseCurve:
    """Smooth pieces end to end: one profile for all, without a stop at smooth joints.

    Over its own g in [0, 1] a piece is at  c0 + c1 g + c2 g^2 + c3 g^3 + u cos(a) + v sin(a)  with
    a = a0 + g a1: a straight line, a Bezier curve, an arc of a circle or of any ellipse. Where the
    direction changes between two pieces it jumps, as at the corner of a letter. The tool keeps,
    turns evenly or looks; it can't follow corners.

    Attributes:
        cubic: c0 to c3 of each piece (M, 4, 3) [m], in the drawing frame.
        ellipse: u and v of each piece (M, 2, 3) [m]; zero for pieces that are not arcs.
        angles: a0 and a1 of each piece (M, 2) [rad].
    """

    cubic: Floats
    ellipse: Floats
    angles: Floats

    def __eq__(self, other: object) -> bool:
        return isinstance(other, PiecewiseCurve) and all(
            np.array_equal(mine, theirs)
            for mine, theirs in (
                (self.cubic, other.cubic),
                (self.ellipse, other.ellipse),
                (self.angles, other.angles),
            )
        )

    def __hash__(self) -> int:
        return hash(self.cubic.tobytes())


Path = Straight | Arc | Curve | Screw | ScrewTo | Dwell | Step | PiecewiseCurve
STANDING = (Dwell, Step)  # paths on which the point does not travel


# Orientation along the path. `Screw` and `ScrewTo` define it themselves and have `FollowHeading`.


@record
class FixedOrientation:
    """The orientation does not change."""


@record
class SlerpOrientation:
    """The orientation rotates evenly along the path, the short way, to the end orientation."""


@record
class FollowHeading:
    """The tool rotates with an arc about its axis, or with a curve's heading about `axis`."""

    axis: Vector = (0.0, 0.0, 1.0)


@record
class Look:
    """The tool's z axis points at `point`; its y axis is as close as possible to `up`."""

    point: Vector
    up: Vector


@record
class LookLine:
    """The tool's z axis points at the line through `point`; its x axis is parallel to `along`."""

    point: Vector
    along: Vector


Tool = FixedOrientation | SlerpOrientation | FollowHeading | Look | LookLine
LOOK_MODES = (Look, LookLine)  # what a tool does whose turn depends on where it is


# How long it takes.


@record
class Duration:
    """`in T`: a time [s], rounded up to whole samples."""

    seconds: float


@record
class Samples:
    """`samples N`: exactly N new samples."""

    count: int


@record
class CruiseSpeed:
    """The largest speed [m/s] of the point, or [rad/s] if only the tool rotates."""

    speed: float
    turnspeed: float


Timing = Duration | Samples | CruiseSpeed


@record
class Profile:
    """A profile by name, with its boundary rates in SI units (m, or rad if `angular`).

    `rates` is empty (rest to rest), (v0, v1) for cubic, (v0, v1, a0, a1) for quintic.

    With an `acceleration` [m/s^2] the stroke goes from rest to rest as fast as its speed and that
    acceleration allow, along the path and across it, and slows down ahead of its corners; 0 is
    the profile alone, which jumps there. With a `jerk` [m/s^3] the acceleration along the path
    changes no faster than that; 0 is no limit.
    """

    name: str
    rates: tuple[float, ...] = ()
    angular: bool = False
    acceleration: float = 0.0
    jerk: float = 0.0


SMOOTH = Profile("smooth", acceleration=2.0, jerk=20.0)


@record
class Light:
    """The colours at the first and at the last point of a stroke, interpolated by length.

    `even` dims the light where the tool is slow, so that the line is equally bright all along.
    `photo` is the number of the program's photograph, from 1, whose light this is; 0 for none.
    `between` has colours on the way, each at its share of the length, 0 to 1, in order.
    """

    first: Colour
    last: Colour
    even: bool = False
    photo: int = 0
    between: tuple[tuple[float, Colour], ...] = ()

    @property
    def changes(self) -> bool:
        """Whether it is another colour somewhere on the way."""
        return self.first != self.last or bool(self.between)

    @property
    def stops(self) -> tuple[tuple[float, Colour], ...]:
        """All colours with their shares of the length, from 0 to 1."""
        return (0.0, self.first), *self.between, (1.0, self.last)

    def at(self, share: float) -> Colour:
        """The colour at a share of the length."""
        if not self.changes:
            return self.first
        pairs = pairwise(self.stops)
        (a, before), (b, after) = next((x, y) for x, y in pairs if share <= y[0] or y[0] >= 1.0)
        return colours.mix(before, after, (share - a) / (b - a))

    def part(self, lower: float, upper: float) -> "Light":
        """The light of a part of the length, between two shares."""
        if not self.changes:
            return self
        inside = tuple(
            ((share - lower) / (upper - lower), colour)
            for share, colour in self.between
            if lower < share < upper
        )
        return replaced(self, first=self.at(lower), last=self.at(upper), between=inside)

    def dimmed(self, brightness: float) -> "Light":
        """The same colours, their light multiplied by `brightness`."""
        first, last = (colours.dim(colour, brightness) for colour in (self.first, self.last))
        between = tuple((share, colours.dim(colour, brightness)) for share, colour in self.between)
        return replaced(self, first=first, last=last, between=between)


# Light. Brushes are in the tool frame.


BrushValue = float | str | Vector | tuple[Colour, ...]


@record
class Brush:
    """A brush, by its registered name in `dqpaint.brushes`.

    Attributes:
        name: of the brush.
        values: names and values that are not the usual ones, in the brush's order: metres, unit
            vectors in the tool frame, linear colours, paths of files.
        several: whether it has lamps apart from each other, so that a turn on the spot draws.
    """

    name: str = "point"
    values: tuple[tuple[str, BrushValue], ...] = ()
    several: bool = False


@record
class Strobe:
    """Flashing light: on for the share `duty` (0 to 1) of each period of the run's clock."""

    frequency: float  # [Hz]
    duty: float = 0.5


@record
class ContinuousStroke:
    """One profile for several consecutive segments, without a stop between them.

    Profile and timing are those of the whole. A segment whose light is `light` has its part of that
    gradient, which goes over the whole length.
    """

    number: int  # which of the drawing's
    profile: Profile
    timing: Timing
    light: Light | None = None


@record
class Segment:
    """One stroke or pause: its path, orientation, timing and light."""

    path: Path
    tool: Tool
    profile: Profile
    timing: Timing
    light: Light | None  # None: dark
    start: Pose
    end: Pose
    span: Span  # its words in the file
    line: SourceLine  # where these words begin
    brush: Brush = Brush()
    strobe: Strobe | None = None  # None: it burns steadily
    stroke: ContinuousStroke | None = None  # None: it has profile and timing for itself
    jumps: bool = False  # where its velocity jumps, that is meant


@dataclass(frozen=True, eq=False)
class Photo:
    """A photograph that strokes are to paint; how brightly they shine is solved for.

    Attributes:
        name: of its file, as written.
        picture: (H, W, 3) sRGB from 0 to 1.
        corner: its lower left corner, in the drawing frame [m].
        right: from there to the lower right corner [m].
        up: and to the upper left one [m].
        colours: how many colours the lamp has; None: any colour.
        colour: linear, of a lamp of one colour.
        style: how it is drawn.
        detail: the distance between neighbouring strokes [m].
        span: the statement, in the text.
    """

    name: str
    picture: Floats
    corner: Vector
    right: Vector
    up: Vector
    colours: int | None
    colour: Colour
    style: str
    detail: float
    span: Span


@record
class AutoPlacement:
    """`place auto`: the placement that suits the arm best, computed for the arm."""

    orientation: Quaternion | None  # of the drawing in the base frame; None: the robot's canvas'
    span: Span | None


@record
class Program:
    """A whole drawing."""

    name: str  # as it is shown in messages: usually the path that was given
    text: str
    period: float  # [s]
    robot: str | None  # the file's own `robot` line
    robot_span: Span | None  # and the name in it
    placement: (
        Pose | AutoPlacement | None
    )  # the drawing in the robot's base frame; None: on its canvas
    start: Pose
    segments: tuple[Segment, ...]
    notes: tuple[Diagnostic, ...]  # warnings; errors are raised
    most_samples: int = DEFAULT_MAX_SAMPLES
    walls: tuple[Wall, ...] = ()
    task: str | None = None  # the file's own `task` line
    dark_saved: float = 0.0  # [m] of dark ways, by the order of lines that come from elsewhere
    photos: tuple[Photo, ...] = ()

    def line_name(self, line: SourceLine) -> str:
        """The name of a line for people: `12`, or `petal.traj:3`."""
        return line_name(self.text, line)

    def line_reference(self, line: SourceLine) -> int | str:
        """The name of a line for programs: a number for a line of the main file."""
        return self.line_name(line) if line.file else line.line

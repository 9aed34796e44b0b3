"""Walls of a drawing, from the language to the arm: shapes that it must not enter or leave.

Lengths are metres, angles radians, in the drawing's frame, or in the robot's base frame.
"""

from pathlib import Path
from typing import Literal

from dqpaint.core import record
from dqpaint.diagnostics import SourceLine, Span

Three = tuple[float, float, float]
Holder = Literal["arm", "tool", "beam"]
"""What is kept: the light and all links, the light alone, or the beam along the tool's z axis."""


@record
class HalfSpace:
    """The side of a plane to which its unit normal points: normal.p >= offset."""

    normal: Three
    offset: float


@record
class Room:
    """The inside of a box with two opposite corners."""

    low: Three
    high: Three


@record
class Block:
    """The outside of a box with two opposite corners."""

    low: Three
    high: Three


@record
class Ball:
    """The outside of a sphere."""

    centre: Three
    radius: float


@record
class Rod:
    """The outside of a capsule: what is within `radius` of the way from `start` to `end`."""

    start: Three
    end: Three
    radius: float


@record
class Pillar:
    """The outside of a cylinder without ends: within `radius` of a line along a unit vector."""

    point: Three
    axis: Three
    radius: float


@record
class Hull:
    """The outside of the convex hull of a mesh, whose numbers are multiplied by `scale` [m]."""

    file: Path
    at: Three
    scale: float


@record
class Cone:
    """Directions of the tool's z axis within `angle` of a unit vector."""

    axis: Three
    angle: float


@record
class Apart:
    """Links of the arm that stay `distance` apart from each other."""

    distance: float


WallShape = HalfSpace | Room | Block | Ball | Rod | Pillar | Hull | Cone | Apart


@record
class Wall:
    """What an arm is kept from.

    Attributes:
        shape: where it may be.
        holder: what of the arm is kept there.
        base: whether its coordinates are the base's, not the drawing's.
        shift: by which it moves [m], evenly from the beginning of the run ...
        seconds: ... for this time [s]; 0 where it stands.
        text: of its statement.
        line: of the drawing.
        span: of its statement.
    """

    shape: WallShape
    holder: Holder
    base: bool
    shift: Three
    seconds: float
    text: str
    line: SourceLine
    span: Span

"""Modal settings of strokes: speed, profile, tool, blend, light, brush, strobe."""

import math

from dqpaint.core import record
from dqpaint.program import (
    Brush,
    FixedOrientation,
    FollowHeading,
    Light,
    Look,
    LookLine,
    Profile,
    Quaternion,
    Strobe,
    colours,
)


@record
class TurnTo:
    """`tool ORIENTATION`, in the drawing frame."""

    orientation: Quaternion


ToolMode = FixedOrientation | FollowHeading | Look | LookLine | TurnTo


REST_TO_REST, KEEP = Profile("trapezoid"), FixedOrientation()
POINT = Brush()
WHITE = Light(colours.WHITE, colours.WHITE)


@record
class StrokeState:
    """The settings of strokes at one point of the file, in SI units and the drawing frame.

    Attributes:
        speed: [m/s] of the point.
        turnspeed: [rad/s] of a turn on the spot.
        profile: of every stroke.
        tool: what it does meanwhile.
        light: None is dark.
        shone: the light that was named last: what `on` means.
        brush: what shines.
        strobe: None is steady.
        blend: the distance [m] within which corners are rounded.
    """

    speed: float = 0.1
    turnspeed: float = math.radians(60.0)
    profile: Profile = REST_TO_REST
    tool: ToolMode = KEEP
    light: Light | None = WHITE
    shone: Light = WHITE
    brush: Brush = POINT
    strobe: Strobe | None = None
    blend: float = 0.0

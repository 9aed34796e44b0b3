"""Modal settings of strokes: speed, profile, tool, blend, corner, light, brush, strobe."""

import math

from dqpaint.core import record, replaced
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


@record
class Corner:
    """How what runs through corners takes them.

    Attributes:
        deviation: how far the path may be from a corner [m]; 0 stops there.
        jump: its velocity jumps, and that is meant.
    """

    deviation: float
    jump: bool = False


ACCELERATION = 2.0  # [m/s^2] of what runs through corners, unless the arm can do less
CORNER = Corner(1e-4)
REST_TO_REST, KEEP = Profile("trapezoid"), FixedOrientation()
GENTLE = Profile("trapezoid", acceleration=ACCELERATION)
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
        corner: how they are run through; None for what the profile does by itself.
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
    corner: Corner | None = None

    @property
    def look_ahead(self) -> Corner | None:
        """How what runs through corners slows down for them; None if its velocity jumps there."""
        if self.corner is not None:
            return None if self.corner.jump else self.corner
        return None if self.profile.name == "constant" or self.profile.rates else CORNER

    @property
    def through_corners(self) -> Profile:
        """The profile of what runs through corners."""
        return replaced(self.profile, acceleration=self.acceleration)

    @property
    def acceleration(self) -> float:
        """Of what runs through corners [m/s^2]; 0 if its velocity jumps there."""
        return self.profile.acceleration or (ACCELERATION if self.look_ahead else 0.0)

    @property
    def dark_way(self) -> Profile:
        """The profile of the dark moves between lines that come from elsewhere."""
        return REST_TO_REST if self.look_ahead is None else GENTLE

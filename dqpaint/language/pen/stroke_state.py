"""What holds until something else is said: speed, profile, tool, blend, light, brush, strobe."""

import math

from dqpaint.core import record, replaced
from dqpaint.diagnostics import problem
from dqpaint.language.syntax.tree import (
    BlendWords,
    BrushWords,
    ColourWords,
    Expression,
    LightWords,
    Part,
    StrobeWords,
    ToolWords,
)
from dqpaint.language.values import typed_values
from dqpaint.language.values.scope import Scope
from dqpaint.language.values.vectors import Frame, Y
from dqpaint.program import (
    Bar,
    Brush,
    Colour,
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
from dqpaint.program import Point as Dot


@record
class TurnTo:
    """`tool ORIENTATION`, in the drawing frame."""

    orientation: Quaternion


ToolMode = FixedOrientation | FollowHeading | Look | LookLine | TurnTo


REST_TO_REST, KEEP = Profile("trapezoid"), FixedOrientation()
POINT = Dot()
WHITE = Light(colours.WHITE, colours.WHITE)


@record
class StrokeState:
    """What holds for strokes at one place of the file, in SI units and the drawing frame.

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


PERIOD = 0.008  # [s]
LARGEST_LAMP = 10.0  # [m]
SLOWEST_STROBE, FASTEST_STROBE = 1e-3, 1e6  # [Hz]


def changed(state: StrokeState, part: Part, scope: Scope, frame: Frame) -> StrokeState:
    """The state after a modal line, or for a statement with this clause."""
    value = part.value
    if isinstance(value, ToolWords):
        return replaced(state, tool=tool_mode(value, scope, frame))
    if isinstance(value, LightWords):
        light = light_of(value, state, scope)
        named = value.first.word != "on"  # `on 40%` is 40% of what was named, however often
        shone = light if light is not None and named else state.shone
        return replaced(state, light=light, shone=shone)
    if isinstance(value, BrushWords):
        return replaced(state, brush=brush_of(value, scope))
    if isinstance(value, StrobeWords):
        return replaced(state, strobe=strobe_of(value, scope))
    if isinstance(value, BlendWords):
        size = 0.0 if value.size is None else typed_values.positive(value.size, scope, "blend")
        return replaced(state, blend=size)
    if part.word == "profile":
        return replaced(state, profile=typed_values.profile(value, scope))
    size = typed_values.positive(value, scope, part.word)
    if part.word == "speed":
        return replaced(state, speed=size)
    return replaced(state, turnspeed=size)


def tool_mode(words: ToolWords, scope: Scope, frame: Frame) -> ToolMode:
    """What stands after `tool`, in the drawing frame."""
    values = words.values
    match words.mode:
        case "keep":
            return FixedOrientation()
        case "follow":
            return FollowHeading()
        case "look":
            up = typed_values.direction(values[1], scope, "up") if len(values) > 1 else Y
            point = typed_values.place(values[0], scope, "look")
            return Look(frame.point(point), frame.direction(up))
        case "look line":
            point = typed_values.place(values[0], scope, "look line")
            along = typed_values.direction(values[1], scope, "along")
            return LookLine(frame.point(point), frame.direction(along))
        case _:
            return TurnTo(frame.orientation(typed_values.orientation(values[0], scope, "tool")))


def light_of(words: LightWords, state: StrokeState, scope: Scope) -> Light | None:
    """What stands after `light`; None if it is off from end to end."""
    first = _shade(words.first, state.shone.first, scope)
    last = first
    if words.last is not None:
        last = _shade(words.last, state.shone.last, scope, after_to=True)
    elif words.first.word == "on":
        last = colours.dimmed(state.shone.last, words.first.brightness)
    even = words.even or (words.first.word == "on" and state.shone.even)
    return Light(first, last, even) if (first, last) != (colours.DARK, colours.DARK) else None


def brush_of(words: BrushWords, scope: Scope) -> Brush:
    """What stands after `brush`; it stands in the tool's frame and is never scaled."""
    if words.kind == "point":
        return Dot(_size_of_lamp(words.size, scope, "brush point") if words.size else 0.0)
    assert words.size is not None
    size = _size_of_lamp(words.size, scope, "brush bar")
    if words.along is None:
        return Bar(size)
    return Bar(size, typed_values.direction(words.along, scope, "along"))


def _size_of_lamp(node: Expression, scope: Scope, word: str) -> float:
    size = typed_values.positive(node, scope, word)
    if size > LARGEST_LAMP:
        message = f"a lamp is at most {LARGEST_LAMP:g} m large"
        raise problem("E258", message, node.span, "", "for example: brush bar 120 mm along x")
    return size


def strobe_of(words: StrobeWords, scope: Scope) -> Strobe | None:
    """What stands after `strobe`."""
    if words.frequency is None:
        return None
    frequency = typed_values.positive(words.frequency, scope, "strobe")
    if not SLOWEST_STROBE <= frequency <= FASTEST_STROBE:
        message = f"a strobe flashes {SLOWEST_STROBE:g} to {FASTEST_STROBE:,.0f} times a second"
        raise problem("E259", message, words.frequency.span, "", "for example: strobe 10 Hz 30%")
    return Strobe(frequency, words.duty)


def _shade(shade: ColourWords, on: Colour, scope: Scope, after_to: bool = False) -> Colour:
    if shade.word == "off":
        return colours.DARK
    colour = on if shade.value is None else typed_values.colour(shade.value, scope, after_to)
    return colours.dimmed(colour, shade.brightness)


def standing(light: Light | None) -> Light | None:
    """The light of a pause under this light: what the stroke before it ended with."""
    if light is None or light.even or light.last == colours.DARK:
        return None  # a light that is even over the way does not shine where there is none
    return Light(light.last, light.last)

"""Modal words and their values -> state of strokes."""

from dqpaint.core import replaced
from dqpaint.diagnostics import problem
from dqpaint.language.pen.pen import Pen
from dqpaint.language.pen.stroke_state import Corner, StrokeState, ToolMode, TurnTo
from dqpaint.language.strokes.brush_values import brush_of
from dqpaint.language.syntax.tree import (
    BlendWords,
    BrushWords,
    ColourWords,
    CornerWords,
    LightWords,
    Part,
    StrobeWords,
    ToolWords,
)
from dqpaint.language.values import typed_values
from dqpaint.language.values.scope import Scope
from dqpaint.language.values.vectors import Frame, Y
from dqpaint.program import (
    Colour,
    FixedOrientation,
    FollowHeading,
    Light,
    Look,
    LookLine,
    Strobe,
    colours,
)

SLOWEST_STROBE, FASTEST_STROBE = 1e-3, 1e6  # [Hz]


def apply_clause(
    state: StrokeState, part: Part, scope: Scope, pen: Pen, frame: Frame
) -> StrokeState:
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
        return replaced(state, brush=brush_of(value, scope, pen))
    if isinstance(value, StrobeWords):
        return replaced(state, strobe=strobe_of(value, scope))
    if isinstance(value, BlendWords):
        size = 0.0 if value.size is None else typed_values.positive(value.size, scope, "blend")
        return replaced(state, blend=size)
    if isinstance(value, CornerWords):
        if value.deviation is None:
            return replaced(state, corner=Corner(0.0, jump=True))
        size = typed_values.not_negative(value.deviation, scope, "corner")
        return replaced(state, corner=Corner(size))
    if part.word == "profile":
        return replaced(state, profile=typed_values.profile(value, scope))
    size = typed_values.positive(value, scope, part.word)
    if part.word == "speed":
        return replaced(state, speed=size)
    return replaced(state, turnspeed=size)


def tool_mode(words: ToolWords, scope: Scope, frame: Frame) -> ToolMode:
    """The tool mode of a clause, in the drawing frame."""
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
    """The light of a clause; None if it is off from end to end."""
    first = _shade(words.first, state.shone.first, scope)
    last = first
    if words.last is not None:
        last = _shade(words.last, state.shone.last, scope, after_to=True)
    elif words.first.word == "on":
        last = colours.dim(state.shone.last, words.first.brightness)
    even = words.even or (words.first.word == "on" and state.shone.even)
    return Light(first, last, even) if (first, last) != (colours.DARK, colours.DARK) else None


def strobe_of(words: StrobeWords, scope: Scope) -> Strobe | None:
    """The strobe of a clause."""
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
    return colours.dim(colour, shade.brightness)


def pause_light(light: Light | None) -> Light | None:
    """The light of a pause: the last colour of the stroke before it."""
    if light is None or light.even or light.last == colours.DARK:
        return None  # light that is even along the path is off where the path has no length
    return Light(light.last, light.last)

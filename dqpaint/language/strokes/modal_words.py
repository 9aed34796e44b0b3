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
    Name,
    Part,
    StrobeWords,
    ToolWords,
)
from dqpaint.language.values import typed_values
from dqpaint.language.values.scope import Scope
from dqpaint.language.values.vectors import Frame, Y, times
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
            # It is the tool's x, of whose image the opposite is taken (`Frame.orientation`).
            return LookLine(frame.point(point), times(frame.hand, frame.direction(along)))
        case _:
            return TurnTo(frame.orientation(typed_values.orientation(values[0], scope, "tool")))


def light_of(words: LightWords, state: StrokeState, scope: Scope) -> Light | None:
    """The light of a clause; None if it is off from end to end."""
    if not words.rest and words.first.word == "on":
        return replaced(
            state.shone.dimmed(words.first.brightness), even=words.even or state.shone.even
        )
    rainbow = _is_rainbow(words, scope)
    named = [] if rainbow else [_shade(words.first, state.shone.first, scope)]
    named += [_shade(shade, state.shone.last, scope, after_to=True) for shade in words.rest]
    if rainbow:
        named = [colours.dim(colour, words.first.brightness) for colour in colours.RAINBOW]
    stops = gradient(named, "hue long" if rainbow else words.way)
    even = words.even or (words.first.word == "on" and state.shone.even)
    if all(colour == colours.DARK for _, colour in stops):
        return None
    return Light(stops[0][1], stops[-1][1], even, between=tuple(stops[1:-1]))


def _is_rainbow(words: LightWords, scope: Scope) -> bool:
    """Whether it is `light rainbow`, and the file has no such name."""
    value = words.first.value
    named = isinstance(value, Name) and value.name == "rainbow" and not words.rest
    return named and not scope.defines("rainbow")


HUES = 24  # colours for each way round the hues, between which light is mixed


def gradient(named: list[Colour], way: str) -> list[tuple[float, Colour]]:
    """Colours, evenly apart, and those between them on a way by hue, with their shares."""
    if not way or len(named) < 2:
        last = max(len(named) - 1, 1)
        stops = [(i / last, colour) for i, colour in enumerate(named)]
        return stops if len(stops) > 1 else [*stops, (1.0, named[0])]
    pieces = HUES * (len(named) - 1)
    stops = [(0.0, named[0])]
    for i in range(1, pieces + 1):
        leg = (i - 1) // HUES
        share = (i - leg * HUES) / HUES
        mixed = colours.by_hue(named[leg], named[leg + 1], share, way == "hue long")
        stops.append((i / pieces, named[leg + 1] if share == 1.0 else mixed))
    return stops


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

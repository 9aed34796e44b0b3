"""What holds until something else is said: speed, law, tool, light."""

import math
from dataclasses import dataclass, replace

from dqpaint.language import colours, reading
from dqpaint.language.program import (
    Colour,
    Follow,
    Keep,
    Law,
    Light,
    Look,
    LookLine,
    Quaternion,
)
from dqpaint.language.scope import Scope
from dqpaint.language.space import Frame, Y
from dqpaint.language.syntax import LightWords, Part, Shade, ToolWords


@dataclass(frozen=True, slots=True)
class Towards:
    """`tool ORIENTATION`, in the drawing frame."""

    orientation: Quaternion


ToolMode = Keep | Follow | Look | LookLine | Towards


REST_TO_REST, KEEP = Law("trapezoid"), Keep()
WHITE = Light(colours.WHITE, colours.WHITE)


@dataclass(frozen=True, slots=True)
class Settings:
    """The settings at one place of the file, in SI units and the drawing frame.

    Attributes:
        speed: [m/s] of the point.
        turnspeed: [rad/s] of a turn on the spot.
        law: of every stroke.
        tool: what it does meanwhile.
        light: None is dark.
        shone: the light that was named last: what `on` means.
    """

    speed: float = 0.1
    turnspeed: float = math.radians(60.0)
    law: Law = REST_TO_REST
    tool: ToolMode = KEEP
    light: Light | None = WHITE
    shone: Light = WHITE


PERIOD = 0.008  # [s]


def changed(settings: Settings, part: Part, scope: Scope, frame: Frame) -> Settings:
    """The settings after a setting line, or for a statement with this clause."""
    value = part.value
    if isinstance(value, ToolWords):
        return replace(settings, tool=tool_mode(value, scope, frame))
    if isinstance(value, LightWords):
        light = light_of(value, settings, scope)
        named = value.first.word != "on"  # `on 40%` is 40% of what was named, however often
        shone = light if light is not None and named else settings.shone
        return replace(settings, light=light, shone=shone)
    if part.word == "law":
        return replace(settings, law=reading.law(value, scope))
    size = reading.positive(value, scope, part.word)
    if part.word == "speed":
        return replace(settings, speed=size)
    return replace(settings, turnspeed=size)


def tool_mode(words: ToolWords, scope: Scope, frame: Frame) -> ToolMode:
    """What stands after `tool`, in the drawing frame."""
    values = words.values
    match words.mode:
        case "keep":
            return Keep()
        case "follow":
            return Follow()
        case "look":
            up = reading.direction(values[1], scope, "up") if len(values) > 1 else Y
            point = reading.place(values[0], scope, "look")
            return Look(frame.point(point), frame.direction(up))
        case "look line":
            point = reading.place(values[0], scope, "look line")
            along = reading.direction(values[1], scope, "along")
            return LookLine(frame.point(point), frame.direction(along))
        case _:
            return Towards(frame.orientation(reading.orientation(values[0], scope, "tool")))


def light_of(words: LightWords, settings: Settings, scope: Scope) -> Light | None:
    """What stands after `light`; None if it is off from end to end."""
    first = _shade(words.first, settings.shone.first, scope)
    last = first
    if words.last is not None:
        last = _shade(words.last, settings.shone.last, scope, after_to=True)
    elif words.first.word == "on":
        last = colours.dimmed(settings.shone.last, words.first.brightness)
    return Light(first, last) if (first, last) != (colours.DARK, colours.DARK) else None


def _shade(shade: Shade, on: Colour, scope: Scope, after_to: bool = False) -> Colour:
    if shade.word == "off":
        return colours.DARK
    colour = on if shade.value is None else reading.colour(shade.value, scope, after_to)
    return colours.dimmed(colour, shade.brightness)


def standing(light: Light | None) -> Light | None:
    """The light of a pause under this setting: what the stroke before it ended with."""
    if light is None or light.last == colours.DARK:
        return None
    return Light(light.last, light.last)

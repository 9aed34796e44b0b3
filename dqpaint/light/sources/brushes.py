"""Brushes: what a tool can carry, by name, each a few choices that become `Emitters`.

A new brush is a class here under `@BRUSHES.add(name)`: fields with their descriptions, and
`emitters`. It is read from texts such as `bar:length=300mm,leds=40`.
"""

from __future__ import annotations

import re
from functools import partial
from pathlib import Path
from typing import Annotated, Any, cast

import numpy as np
from pydantic import AfterValidator, BaseModel, BeforeValidator, ConfigDict, Field, ValidationError

from dqpaint.core import FILE, Registry, find_in_file, reason, subclass
from dqpaint.errors import DqpaintError, UsageError
from dqpaint.light.arrays import Floats
from dqpaint.light.sources.emitters import Emitters
from dqpaint.program import Bar as BarWords
from dqpaint.program import Brush as BrushWords
from dqpaint.program import Colour
from dqpaint.program import colours as named

LEDS_PER_METRE = 144.0
"""Of the densest common LED strips."""
UNITS = {"mm": 1e-3, "cm": 1e-2, "m": 1.0}
AXES = {
    sign + axis: tuple((-1.0 if sign else 1.0) * float(axis == other) for other in "xyz")
    for sign in ("", "-")
    for axis in "xyz"
}


def _parse_length(given: object) -> object:
    if not isinstance(given, str):
        return given
    found = re.fullmatch(r"\s*([0-9.eE+-]+)\s*(mm|cm|m)\s*", given)
    if found is None:
        raise ValueError(f"'{given}' is not a length with a unit, for example 300mm")
    try:
        return float(found[1]) * UNITS[found[2]]
    except ValueError:
        raise ValueError(f"'{given}' is not a length with a unit, for example 300mm") from None


def _parse_direction(given: object) -> object:
    if isinstance(given, str) and given not in AXES:
        raise ValueError(f"'{given}' is no axis of the tool; known: {', '.join(AXES)}")
    return AXES[given] if isinstance(given, str) else given


def _parse_colours(given: object) -> object:
    if not isinstance(given, str):
        return given
    found = []
    for word in given.split("/"):
        shade = named.NAMES.get(word.strip()) or named.from_hex(word.strip().removeprefix("#"))
        if shade is None:
            raise ValueError(f"no colour named '{word}'; write a CSS name or ff8800")
        found.append(shade)
    return tuple(found)


def _more_than_one(leds: int) -> int:
    if leds == 1:
        raise ValueError("should be 2 or more, or 0 for 144 a metre; one is a point")
    return leds


Length = Annotated[
    float, BeforeValidator(_parse_length), Field(gt=0.0, le=10.0, allow_inf_nan=False)
]
Direction = Annotated[tuple[float, float, float], BeforeValidator(_parse_direction)]
Shades = Annotated[tuple[Colour, ...], BeforeValidator(_parse_colours)]
Lobe = Annotated[float, Field(ge=0.0, le=200.0, allow_inf_nan=False)]
Leds = Annotated[int, Field(ge=0, le=2000), AfterValidator(_more_than_one)]
X: tuple[float, float, float] = (1.0, 0.0, 0.0)
Z = np.array([0.0, 0.0, 1.0])


HOW = "a brush is a subclass of dqpaint.light.sources.Brush with a method emitters"


class Brush(BaseModel):
    """What every brush has; each field's description says what it is."""

    model_config = ConfigDict(extra="forbid", frozen=True)

    lobe: Lobe = Field(0.0, description="m of a beam cos^m; 0 shines to all sides")

    def emitters(self) -> Emitters:
        """The lamps."""
        raise NotImplementedError


BRUSHES: Registry[type[Brush]] = Registry("brush", "dqpaint.brushes", partial(subclass, Brush))


@BRUSHES.add("point")
class Point(Brush):
    """A single LED at the tool's tip."""

    def emitters(self) -> Emitters:
        """One lamp."""
        return Emitters(lobe=self.lobe)


@BRUSHES.add("ball")
class Ball(Brush):
    """A diffuse ball: an even disc from wherever it is seen."""

    size: Length = Field(0.04, description="its diameter")

    def emitters(self) -> Emitters:
        """One lamp with a size."""
        return Emitters(lobe=self.lobe, size=self.size)


class Line(Brush):
    """Lamps on a straight line, centred on the tool."""

    length: Length = Field(0.2, description="from end to end")
    along: Direction = Field(X, description="axis of the tool it lies along: x, y, z, -x, ...")
    colours: Shades = Field(
        (named.WHITE,),
        description="from one end to the other, a/b/c; the stroke's colour dims them",
    )

    def lamps_on_line(self, leds: int, tints: Floats, joined: float) -> Emitters:
        """As many lamps, with tints (R, leds, 3) of 1 for full brightness."""
        along = np.array(self.along) / np.linalg.norm(self.along)
        across = Z - along * along[2]  # a bar shines towards the tool's z, as far as it can
        if across @ across < 1e-12:
            across = X - along * along[0]
        u = (np.arange(leds) + 0.5) / leds - 0.5
        places = self.length * u[:, None] * along
        normal = across / np.linalg.norm(across)
        return Emitters(places, tints / leds, 0.0, joined, normal, self.lobe)

    def gradient(self, leds: int) -> Floats:
        """(1, leds, 3) the colours from end to end."""
        stops = np.linspace(0.0, 1.0, len(self.colours))
        u = (np.arange(leds) + 0.5) / leds
        shades = np.array(self.colours)
        return np.stack([np.interp(u, stops, channel) for channel in shades.T], axis=1)[None]

    def led_count(self, leds: int) -> int:
        """How many LEDs there are where none are asked for."""
        return leds or max(2, round(self.length * LEDS_PER_METRE))


@BRUSHES.add("bar")
class Bar(Line):
    """A bar of LEDs behind a little diffusion: threads on a veil."""

    leds: Leds = Field(0, description="how many; 0 is 144 a metre")
    joined: Annotated[float, Field(ge=0.0, le=1.0)] = Field(
        0.45, description="share of the light between the LEDs, 0 to 1"
    )

    def emitters(self) -> Emitters:
        """LEDs and what joins them."""
        leds = self.led_count(self.leds)
        return self.lamps_on_line(leds, self.gradient(leds), self.joined)


@BRUSHES.add("ribbon")
class Ribbon(Line):
    """An even line of light without gaps."""

    def emitters(self) -> Emitters:
        """Only what joins."""
        fine = 128 if len(self.colours) > 1 else 2
        return self.lamps_on_line(fine, self.gradient(fine), 1.0)


@BRUSHES.add("pixelstick")
class Pixelstick(Line):
    """A bar of LEDs that shows an image column by column along its way."""

    image: str = Field("", description="a picture file; without one, a pattern of stripes")
    times: Annotated[int, Field(ge=1, le=100)] = Field(1, description="how often along the way")
    leds: Leds = Field(0, description="how many; 0 is 144 a metre")
    joined: Annotated[float, Field(ge=0.0, le=1.0)] = Field(
        0.5, description="share of the light between the LEDs, 0 to 1"
    )

    def emitters(self) -> Emitters:
        """A row of tints for each column of the image."""
        leds = self.led_count(self.leds)
        columns = _columns(self.image, leds) if self.image else striped_image(leds)
        return self.lamps_on_line(
            leds, np.tile(columns, (self.times, 1, 1)) * self.gradient(leds), self.joined
        )


@BRUSHES.add("fibre")
class Fibre(Brush):
    """A brush of glass fibres: fine soft parallel lines, dimmer at the rim."""

    width: Length = Field(0.02, description="diameter of the brush")
    fibres: Annotated[int, Field(ge=1, le=2000)] = Field(48, description="how many")
    seed: Annotated[int, Field(ge=0)] = Field(1, description="of the fibres' places")

    def emitters(self) -> Emitters:
        """Fibres scattered over a disc across the tool's z."""
        random = np.random.default_rng(self.seed)
        k = np.arange(self.fibres) + 0.5
        radius = np.sqrt(k / self.fibres)
        turn = k * np.pi * (3.0 - np.sqrt(5.0)) + random.normal(0.0, 0.25, self.fibres)
        radius = np.clip(radius + random.normal(0.0, 0.05, self.fibres), 0.0, 1.0)
        places = (
            0.5 * self.width * radius[:, None] * np.stack([np.cos(turn), np.sin(turn), 0 * turn], 1)
        )
        power = (1.0 - 0.8 * radius**2) * random.uniform(0.35, 1.0, self.fibres)
        tints = np.repeat((power / power.sum())[None, :, None], 3, axis=2)
        return Emitters(places, tints, lobe=self.lobe)


MOST_COLUMNS = 2000
"""Columns of an image at most."""


def _columns(path: str, leds: int) -> Floats:
    """(R, leds, 3) an image file in linear light: its columns in order, its foot first."""
    import cv2

    try:
        data = np.frombuffer(Path(path).read_bytes(), np.uint8)
    except (OSError, ValueError) as problem:
        reason = problem.strerror if isinstance(problem, OSError) else str(problem)
        raise DqpaintError(f"image '{path[:60]}' cannot be read: {reason}") from None
    image = cv2.imdecode(data, cv2.IMREAD_COLOR) if len(data) else None
    if image is None:
        raise DqpaintError(
            f"image '{path[:60]}' is not a picture that can be read; use PNG or JPEG"
        )
    encoded = np.asarray(image[::-1, :, ::-1], dtype=np.float64) / 255.0
    linear = np.where(encoded <= 0.04045, encoded / 12.92, ((encoded + 0.055) / 1.055) ** 2.4)
    size = (min(image.shape[1], MOST_COLUMNS), leds)
    sized = cv2.resize(linear, size, interpolation=cv2.INTER_AREA)
    return np.clip(cast(Floats, sized), 0.0, 1.0).transpose(1, 0, 2)


def striped_image(leds: int) -> Floats:
    """(110, leds, 3) a woven pattern: bands along the way, hues across it."""
    row, u = np.arange(110)[:, None], (np.arange(leds) + 0.5)[None, :] / leds
    level = np.where(row % 2 == 0, 1.0, 0.12)
    hue = 0.13 + 0.42 * (0.5 + 0.5 * np.cos(2.0 * np.pi * (u + 0.25 * np.sin(row / 17.0))))
    flat = [named.from_hsv(float(h), 0.9, 1.0) for h in np.broadcast_to(hue, (110, leds)).ravel()]
    return np.array(flat).reshape(110, leds, 3) * level[..., None]


def read_brush(text: str) -> Brush:
    """The brush of a text `NAME[:key=value,...]`.

    Raises:
        UsageError: an unknown brush or choice, or a value that is none.
    """
    name, _, rest = text.strip().partition(":")
    if own := re.fullmatch(rf"({FILE})(?::(.*))?", text.strip()):
        name, rest = own[1], own[2] or ""
        thing, _, _ = find_in_file("brush", name, _is_brush, HOW)
        kind = subclass(Brush, name, thing)
    else:
        kind = BRUSHES[name.strip()]
    given: dict[str, Any] = {}
    for part in rest.split(",") if rest.strip() else []:
        key, sign, value = part.partition("=")
        if not sign:
            raise UsageError(
                f"brush '{text}': '{part.strip()}' is not key=value; {_choices(name, kind)}"
            )
        if key.strip() in given:
            raise UsageError(f"brush '{text}': {key.strip()} is given twice")
        given[key.strip()] = value.strip()
    try:
        return kind.model_validate(given)
    except ValidationError as problem:
        first = problem.errors()[0]
        key = str(first["loc"][0])
        if first["type"] == "extra_forbidden":
            raise UsageError(f"brush '{name}' has no '{key}'; {_choices(name, kind)}") from None
        fault = reason(first)
        shown = "" if fault.startswith(("'", "no ")) else f"'{given.get(key)}' "
        raise UsageError(f"brush '{name}': {key} {shown}{fault}") from None


def _is_brush(thing: object) -> bool:
    return isinstance(thing, type) and issubclass(thing, Brush)


def _choices(name: str, kind: type[Brush]) -> str:
    return f"{name} has: {', '.join(kind.model_fields)}"


def program_brush(words: BrushWords) -> Brush:
    """The brush that a drawing's text asks for."""
    if isinstance(words, BarWords):
        return Bar.model_validate({"length": words.length, "along": words.along})
    return (
        Ball.model_validate({"size": words.size}) if words.size > 0.0 else Point.model_validate({})
    )


def describe_fields(kind: type[Brush]) -> list[str]:
    """What can be said of a brush, with its default, in words."""
    return [
        f"{name} = {_format_default(field.default, field.description or '')}"
        for name, field in kind.model_fields.items()
    ]


def _format_default(default: object, about: str) -> str:
    if default == X:
        return f"x  {about}"
    if default == (named.WHITE,):
        return f"white  {about}"
    length = isinstance(default, float) and about.startswith(
        ("its diameter", "diameter", "from end")
    )
    value = (
        f"{1e3 * float(str(default)):g}mm"
        if length
        else f"{default:g}"
        if isinstance(default, float | int)
        else str(default)
    )
    return f"{value}  {about}"

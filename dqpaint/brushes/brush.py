"""The base of all brushes, the types of their values and their registry: `bar` -> a model."""

import re
from functools import partial
from typing import Annotated, ClassVar, NamedTuple

from pydantic import AfterValidator, BaseModel, BeforeValidator, ConfigDict, Field
from pydantic.fields import FieldInfo

from dqpaint.brushes.emitters import Emitters
from dqpaint.core import Registry, subclass
from dqpaint.program import Colour
from dqpaint.program import colours as named

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
        raise ValueError(f"'{given}' is not an axis of the tool; known: {', '.join(AXES)}")
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
        raise ValueError("should be 2 or more, or 0 for 144 per metre; for one LED use brush point")
    return leds


class Takes(NamedTuple):
    """The kind of a value in a drawing, if its type does not determine it."""

    kind: str  # length, direction, colours or file


Length = Annotated[
    float,
    BeforeValidator(_parse_length),
    Field(gt=0.0, le=10.0, allow_inf_nan=False),
    Takes("length"),
]
Direction = Annotated[
    tuple[float, float, float], BeforeValidator(_parse_direction), Takes("direction")
]
Shades = Annotated[tuple[Colour, ...], BeforeValidator(_parse_colours), Takes("colours")]
ImageFile = Annotated[str, Takes("file")]
Lobe = Annotated[float, Field(ge=0.0, le=200.0, allow_inf_nan=False)]
Leds = Annotated[int, Field(ge=0, le=2000), AfterValidator(_more_than_one)]
X: tuple[float, float, float] = (1.0, 0.0, 0.0)


class Brush(BaseModel):
    """The base of all brushes; each field's description says what it means.

    Attributes:
        several: whether it has lamps apart from each other, so that a turn on the spot draws.
    """

    model_config = ConfigDict(extra="forbid", frozen=True, defer_build=True)

    several: ClassVar[bool] = True

    lobe: Lobe = Field(0.0, description="exponent m of a beam cos^m; 0 shines to all sides")

    def emitters(self) -> Emitters:
        """The lamps of the brush."""
        raise NotImplementedError


BRUSHES: Registry[type[Brush]] = Registry("brush", "dqpaint.brushes", partial(subclass, Brush))


def takes(kind: type[Brush]) -> dict[str, str]:
    """The kind of each value of a brush in a drawing.

    Returns:
        By name: length, direction, colours, file, count, number or text.
    """
    return {name: _kind(field) for name, field in kind.model_fields.items()}


def _kind(field: FieldInfo) -> str:
    for one in field.metadata:
        if isinstance(one, Takes):
            return one.kind
    by_type: dict[object, str] = {int: "count", float: "number"}
    return by_type.get(field.annotation, "text")


def first_value(kind: type[Brush]) -> str | None:
    """The value of a brush that is written without its name; None if it has none of its own."""
    return next((name for name in kind.model_fields if name not in Brush.model_fields), None)

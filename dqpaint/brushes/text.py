"""A brush by name and values -> its model: from `bar:length=300mm,leds=40`, from a drawing."""

import re
from typing import Any

from pydantic import ValidationError

from dqpaint.brushes.brush import BRUSHES, Brush, X
from dqpaint.core import FILE_PATTERN, find_in_file, pydantic_reason, subclass
from dqpaint.errors import UsageError
from dqpaint.program import Brush as BrushWords
from dqpaint.program import colours as named

HOW = "a brush is a subclass of dqpaint.brushes.Brush with a method emitters"


def read_brush(text: str) -> Brush:
    """Parse the brush of a text `NAME[:key=value,...]`.

    Raises:
        UsageError: an unknown brush or key, or an invalid value.
    """
    name, _, rest = text.strip().partition(":")
    if own := re.fullmatch(rf"({FILE_PATTERN})(?::(.*))?", text.strip()):
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
        fault = pydantic_reason(first)
        shown = "" if fault.startswith(("'", "no ")) else f"'{given.get(key)}' "
        raise UsageError(f"brush '{name}': {key} {shown}{fault}") from None


def _is_brush(thing: object) -> bool:
    return isinstance(thing, type) and issubclass(thing, Brush)


def _choices(name: str, kind: type[Brush]) -> str:
    return f"{name} has: {', '.join(kind.model_fields)}"


def make_brush(words: BrushWords) -> Brush:
    """The brush of a drawing; its values were checked when the drawing was read."""
    return BRUSHES[words.name].model_validate(dict(words.values))


def describe_fields(kind: type[Brush]) -> list[str]:
    """The values of a brush with their defaults and meanings, as text."""
    return [
        f"{name} = {_format_default(field.default, field.description or '')}"
        for name, field in kind.model_fields.items()
    ]


def _format_default(default: object, about: str) -> str:
    if default == X:
        return f"x  {about}"
    if default == (named.WHITE,):
        return f"white  {about}"
    length = isinstance(default, float) and about.startswith(("diameter", "from end"))
    value = (
        f"{1e3 * float(str(default)):g}mm"
        if length
        else f"{default:g}"
        if isinstance(default, float | int)
        else str(default)
    )
    return f"{value}  {about}"

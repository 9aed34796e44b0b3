"""Text of a choice -> its name and values: `twist=sine,x=0.02`, `compliant:frequency=60`."""

import re
from collections.abc import Mapping
from typing import TYPE_CHECKING, Any, TypeVar

from dqpaint.errors import UsageError

if TYPE_CHECKING:  # help starts without pydantic: it takes longer to import than all else there
    from pydantic import BaseModel

FILE_PATTERN = r"[^:=,]+\.py(?::[^\W\d]\w*(?=:|$))?"  # FILE.py or FILE.py:NAME, before values
Values = Mapping[str, float | str]
M = TypeVar("M", bound="BaseModel")


def read_choice(kind: str, text: str, example: str) -> tuple[str, dict[str, float | str]]:
    """Name and values of a text like `twist=sine,x=0.02` or `twist:form=sine,x=0.02`, or a name.

    The name may be a file of the user's, as in `mine.py:Springy:frequency=60`.

    A value without a name has the name "".

    Args:
        kind: of the choice, for the messages.
        text: as typed.
        example: a text that is right.

    Raises:
        UsageError: anything else, or a value given twice.
    """
    parts = re.fullmatch(rf"\s*({FILE_PATTERN}|[\w-]+)\s*(?:[:=,](.+))?", text)
    if parts is None:
        raise UsageError(f"{kind} '{text}' is not NAME or NAME:KEY=VALUE, for example {example}")
    values: dict[str, float | str] = {}
    for item in (parts[2] or "").split(",") if parts[2] else ():
        key, sign, value = (part.strip() for part in item.rpartition("="))
        if not value or (sign and not key) or key in values:
            raise UsageError(f"{kind} '{text}': '{item.strip()}' is not KEY=VALUE, each once")
        values[key] = number_or_text(value)
    return parts[1], values


def choice_name(text: str) -> str:
    """The name alone of a choice with values: a registered one, or `FILE.py[:NAME]`."""
    found = re.match(rf"\s*({FILE_PATTERN}|[\w-]+)", text)
    return found[1] if found else ""


def number_or_text(value: str) -> float | str:
    """The value as a number, if it is one."""
    try:
        return float(value)
    except ValueError:
        return value


def pydantic_reason(fault: Mapping[str, Any]) -> str:
    """The message of a pydantic error (one of `errors()`), without pydantic's own prefix."""
    return str(fault["msg"]).removeprefix("Value error, ").removeprefix("Input ")


def make_choice(kind: str, name: str, model: type[M], values: Values) -> M:
    """The model of a choice from the values given; one without a name is the first field's.

    Raises:
        UsageError: an unknown value, or one outside its range; lists the known ones.
    """
    from pydantic import ValidationError

    named: dict[str, Any] = dict(values)
    if "" in named and model.model_fields:
        first_field = next(iter(model.model_fields))
        if first_field in named:
            raise UsageError(
                f"{kind} '{name}': {first_field} is given twice, as {named['']!r} without its name "
                f"and as {named[first_field]!r}"
            )
        named[first_field] = named.pop("")
    try:
        return model.model_validate(named)
    except ValidationError as problem:
        first = problem.errors()[0]
        field = ".".join(str(part) for part in first["loc"])
        if first["type"] == "extra_forbidden":
            fault = f"has no value named '{field}'" if field else "takes no value"
        elif first["type"] == "value_error":
            fault = f"{field} {pydantic_reason(first)}".strip()
        else:
            fault = f"{field} {first['input']!r} {pydantic_reason(first)}"
        fields = model.model_fields.items()
        known = ", ".join(f"{word} ({field.description})" for word, field in fields)
        known = f"; its values: {known}" if known else ""
        raise UsageError(f"{kind} '{name}': {fault}{known}") from None

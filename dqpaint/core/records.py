"""Records: values that never change, made by the hundred thousand when a long file is read."""

from dataclasses import dataclass
from typing import Any, TypeVar, dataclass_transform

Some = TypeVar("Some")


@dataclass_transform(frozen_default=True)
def record(cls: type[Some]) -> type[Some]:
    """A data class with slots that type checkers hold frozen.

    At run time it is not: a frozen one takes three times as long to make, and half of the time to
    read a file goes into making them.
    """
    return dataclass(slots=True, unsafe_hash=True)(cls)


def replaced(old: Some, **changes: Any) -> Some:
    """Another record, alike but for some values: `dataclasses.replace`, three times as fast."""
    new = object.__new__(type(old))
    for name in old.__slots__:  # type: ignore[attr-defined]  # every record has them
        setattr(new, name, getattr(old, name))
    for name, value in changes.items():
        setattr(new, name, value)
    return new

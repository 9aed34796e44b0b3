"""Class -> a record: a small, constant value, made by the hundred thousand for a long file."""

from dataclasses import dataclass
from typing import Any, TypeVar, dataclass_transform

Some = TypeVar("Some")


@dataclass_transform(frozen_default=True)
def record(cls: type[Some]) -> type[Some]:
    """A data class with slots that type checkers hold frozen.

    At run time it is mutable: with frozen data classes a drawing of 20,000 lines takes 0.87 s to
    read in place of 0.63 s.
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

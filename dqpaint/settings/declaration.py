"""One declaration of a setting -> its option, its key in files, its keyword, its documentation.

    ev: Annotated[float, Field(ge=-20, le=20), Option("exposure in stops", "STOPS")] = 0.0

declares a setting completely: pydantic checks it, and everything that lists settings reads it from
the field.
"""

from collections.abc import Callable, Iterator
from dataclasses import dataclass
from types import UnionType
from typing import Any, Literal, NamedTuple, Union, get_args, get_origin

from pydantic import BaseModel
from pydantic.fields import FieldInfo


class Variant(NamedTuple):
    """A further option that gives a field a value of its own: `--motion-ghost`."""

    name: str
    value: object
    help: str


@dataclass(frozen=True)
class Option:
    """Declaration of a setting for the command line, files and Python.

    Attributes:
        help: what it is, in one line.
        metavar: the form of its value.
        name: on the command line and in files, where it is not the field's.
        unsaid: the default as help names it, where the model has no value for it.
        many: whether it may be repeated on the command line.
        parts: the fields that it sets, where it sets more than its own.
        variant: a further option that sets it to one fixed value.
        read: reads the field's value from any form that may be given; raises UsageError.
        python: the type of the keyword, where it takes more than the field.
    """

    help: str
    metavar: str | None = None
    name: str = ""
    unsaid: str = ""
    many: bool = False
    parts: tuple[str, ...] = ()
    variant: Variant | None = None
    read: Callable[[object], Any] | None = None
    python: str = ""


class Setting(NamedTuple):
    """A field of a group that has an option."""

    field: str
    name: str  # as it is typed, without dashes before it
    option: Option
    info: FieldInfo
    group: type[BaseModel]

    @property
    def panel(self) -> str:
        """Its heading in help and documents."""
        return str(getattr(self.group, "panel", ""))

    @property
    def keyword(self) -> str:
        """Its name in Python."""
        return self.name if self.option.parts else self.field

    @property
    def alternatives(self) -> tuple[Any, ...]:
        """The types of its value: the members of a union, or the one type."""
        annotation = self.info.annotation
        union = get_origin(annotation) in (Union, UnionType)
        return get_args(annotation) if union else (annotation,)

    @property
    def kind(self) -> type[str | int | float | bool]:
        """The type of its value on the command line."""
        if self.option.parts:
            return str
        kinds = {
            kind
            for one in self.alternatives
            for kind in (map(type, get_args(one)) if get_origin(one) is Literal else [one])
        }
        return next((kind for kind in (bool, int, float) if kind in kinds), str)

    @property
    def default(self) -> Any:
        """Default value on the command line; None where the model has none."""
        if self.option.parts:
            fields = self.group.model_fields
            return "x".join(str(fields[part].default) for part in self.option.parts)
        default = self.info.get_default(call_default_factory=True)
        return None if default == {} else default


def settings_of(*groups: type[BaseModel]) -> Iterator[Setting]:
    """The settings of some groups, in their order."""
    for group in groups:
        for field, info in group.model_fields.items():
            for option in info.metadata:
                if isinstance(option, Option):
                    name = option.name or field.replace("_", "-")
                    yield Setting(field, name, option, info, group)

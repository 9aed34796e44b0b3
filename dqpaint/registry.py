"""One way to give a thing a name; an unknown name is answered with the known ones."""

from collections.abc import Callable, Iterator, Mapping
from typing import Generic, TypeVar

from dqpaint.errors import UnknownNameError

T = TypeVar("T")


class Registry(Mapping[str, T], Generic[T]):
    """Named things of one kind, in the order in which they were added."""

    def __init__(self, kind: str) -> None:
        self.kind = kind
        self._things: dict[str, T] = {}

    def add(self, name: str) -> Callable[[T], T]:
        """A decorator that gives the thing below it a name."""

        def record(thing: T) -> T:
            if name in self._things:
                raise ValueError(f"two {self.kind}s named '{name}'")
            self._things[name] = thing
            return thing

        return record

    def __getitem__(self, name: str) -> T:
        try:
            return self._things[name]
        except KeyError:
            raise UnknownNameError(self.kind, name, list(self._things)) from None

    def __contains__(self, name: object) -> bool:
        return name in self._things

    def __iter__(self) -> Iterator[str]:
        return iter(self._things)

    def __len__(self) -> int:
        return len(self._things)

"""One way to give a thing a name; an unknown name is answered with the known ones."""

import importlib
import pkgutil
from collections.abc import Callable, Iterator, Mapping
from functools import cached_property
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
            raise UnknownNameError(self.kind, name, list(self)) from None

    def __contains__(self, name: object) -> bool:
        return name in self._things

    def __iter__(self) -> Iterator[str]:
        return iter(self._things)

    def __len__(self) -> int:
        return len(self._things)


class Folder(Registry[T]):
    """Named things in the files of a package, in the order of their names.

    A file is read when it is needed: `pham-t` is looked for in `pham_t.py` first, and only who asks
    for all names, or for one that is elsewhere, has every file read.
    """

    def __init__(self, kind: str, package: str) -> None:
        super().__init__(kind)
        self._package = package

    @cached_property
    def _files(self) -> list[str]:
        package = importlib.import_module(self._package)
        return sorted(found.name for found in pkgutil.iter_modules(package.__path__))

    def _read(self, file: str) -> None:
        importlib.import_module(f"{self._package}.{file}")

    def _read_all(self) -> None:
        for file in self._files:
            self._read(file)

    def _look_for(self, name: str) -> None:
        file = name.replace("-", "_")
        if name not in self._things and file in self._files:
            self._read(file)
        if name not in self._things:
            self._read_all()

    def __getitem__(self, name: str) -> T:
        self._look_for(name)
        return super().__getitem__(name)

    def __contains__(self, name: object) -> bool:
        self._look_for(str(name))
        return super().__contains__(name)

    def __iter__(self) -> Iterator[str]:
        self._read_all()
        return iter(sorted(self._things))

    def __len__(self) -> int:
        self._read_all()
        return super().__len__()

"""Name -> the registered object of a kind: built in, or from another package's entry points."""

import importlib
import pkgutil
from collections.abc import Callable, Iterator, Mapping
from functools import cached_property
from typing import TYPE_CHECKING, Any, Generic, TypeVar

from dqpaint.core.events import log
from dqpaint.errors import UnknownNameError, UsageError

if TYPE_CHECKING:
    from importlib.metadata import EntryPoint

T = TypeVar("T")


class Registry(Mapping[str, T], Generic[T]):
    """Named objects of one kind, in the order in which they were added; then those of plugins.

    Args:
        kind: what the things are called in messages, in the singular.
        group: of the entry points by which other packages bring more, such as
            `dqpaint.controllers`; None is closed to them.
        adapt: makes the thing of a kind from a name and what the entry point gives.

    A plugin is imported when its name is asked for, or all names. Its name never hides a built-in
    thing's, and one that two packages bring is refused.
    """

    def __init__(
        self,
        kind: str,
        group: str | None = None,
        adapt: Callable[[str, Any], T] = lambda _name, thing: thing,
    ) -> None:
        self.kind = kind
        self._group = group
        self._adapt = adapt
        self._things: dict[str, T] = {}
        self._origins: dict[str, str] = {}

    def add(self, name: str) -> Callable[[T], T]:
        """A decorator that gives the thing below it a name."""

        def record(thing: T) -> T:
            if name in self._things:
                raise ValueError(f"two {self.kind}s named '{name}'")
            self._things[name] = thing
            return thing

        return record

    def origin(self, name: str) -> str | None:
        """The package, with its version, that brought a thing; None for one that is built in."""
        self._look_for(name)
        return self._origins.get(name)

    @property
    def faults(self) -> list[str]:
        """The faults of plugins, one sentence each; imports all of them."""
        self._load_all()
        return self._faults

    @cached_property
    def _faults(self) -> list[str]:
        faults = []
        for name, brought in self._plugins.items():
            if self._is_built_in(name):
                faults += [
                    f"{self.kind} '{name}' of {_package(one)} is not used: dqpaint has its own"
                    for one in brought
                ]
                continue
            try:
                self._load(name)
            except UsageError as problem:
                faults.append(str(problem))
        return faults

    @cached_property
    def _plugins(self) -> "dict[str, list[EntryPoint]]":
        if self._group is None:
            return {}
        from importlib.metadata import entry_points  # slow, and only unknown names need it

        found: dict[str, list[EntryPoint]] = {}
        for one in entry_points(group=self._group):
            found.setdefault(one.name, []).append(one)
        return dict(sorted(found.items()))

    def _is_built_in(self, name: str) -> bool:
        return name in self._things and name not in self._origins

    def _load(self, name: str) -> None:
        """Import the plugin of a name.

        Raises:
            UsageError: two packages bring it, or it cannot be imported or used.
        """
        if name in self._things or name not in self._plugins:
            return
        first, *others = self._plugins[name]
        if others:
            packages = " and ".join(_package(one) for one in self._plugins[name])
            raise UsageError(f"{self.kind} '{name}' is brought by {packages}: remove one of them")
        before = set(self._things)
        try:
            thing = first.load()
            if name not in self._things:  # else the module has registered it itself
                self._things[name] = self._adapt(name, thing)
        except Exception as problem:
            fault = f"{type(problem).__name__}: {problem}".splitlines()[0]
            raise UsageError(
                f"{self.kind} '{name}' of {_package(first)} cannot be loaded: {fault}"
            ) from problem
        finally:  # a module that fails may have registered some before, or its package
            log("plugins", "%s '%s' of %s", self.kind, name, _package(first), detail=True)
            self._origins |= dict.fromkeys(set(self._things) - before, _package(first))

    def _look_for(self, name: str) -> None:
        """Load the object of a name, if there is one."""
        if name not in self._things:
            self._load(name)

    def _load_all(self) -> None:
        _ = self._faults

    def __getitem__(self, name: str) -> T:
        self._look_for(name)
        try:
            return self._things[name]
        except KeyError:
            raise UnknownNameError(self.kind, name, list(self)) from None

    def __contains__(self, name: object) -> bool:
        self._look_for(str(name))
        return name in self._things

    def __iter__(self) -> Iterator[str]:
        self._load_all()
        return iter(self._things)

    def __len__(self) -> int:
        self._load_all()
        return len(self._things)


class Folder(Registry[T]):
    """Named things in the files of a package, in the order of their names.

    A file is read when it is needed: `pham-t` is looked for in `pham_t.py` first, here or in a
    folder below. Only who asks for all names, or for one that is elsewhere, has every file read.

    Args:
        kind: as for `Registry`.
        package: whose files have the built-in things.
        group: as for `Registry`.
        adapt: as for `Registry`.
    """

    def __init__(
        self,
        kind: str,
        package: str,
        group: str | None = None,
        adapt: Callable[[str, Any], T] = lambda _name, thing: thing,
    ) -> None:
        super().__init__(kind, group, adapt)
        self._package = package

    @cached_property
    def _files(self) -> dict[str, str]:
        """The modules by the names of their files."""
        paths = importlib.import_module(self._package).__path__
        found = pkgutil.walk_packages(paths, f"{self._package}.")
        return {one.name.rpartition(".")[2]: one.name for one in found if not one.ispkg}

    def _read(self, file: str) -> None:
        importlib.import_module(self._files[file])

    def _look_for(self, name: str) -> None:
        file = name.replace("-", "_")
        if name not in self._things and file in self._files:
            self._read(file)
        if name not in self._things:
            self._read_all()
        super()._look_for(name)

    def _read_all(self) -> None:
        for file in self._files:
            self._read(file)

    def _load_all(self) -> None:
        self._read_all()
        super()._load_all()

    def __iter__(self) -> Iterator[str]:
        self._load_all()
        return iter(sorted(self._things))


def subclass(base: type[T], name: str, thing: object) -> type[T]:
    """A class of a plugin or a user's file, checked to be a subclass of `base`.

    Raises:
        UsageError: it is not.
    """
    if isinstance(thing, type) and issubclass(thing, base) and thing is not base:
        return thing
    raise UsageError(f"'{name}' is not a subclass of {base.__module__}.{base.__name__}")


def _package(one: "EntryPoint") -> str:
    """The distribution that an entry point belongs to, with its version."""
    return f"{one.dist.name} {one.dist.version}" if one.dist else one.value

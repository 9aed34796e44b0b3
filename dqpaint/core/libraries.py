"""The names of libraries -> their versions here, and modules that are imported when first used."""

from importlib import import_module
from types import ModuleType
from typing import Any

from dqpaint.errors import UsageError

LIBRARIES = {
    "mujoco": ("mujoco-core", "mujoco"),  # the engine, alone or with its shell
    "numpy": ("numpy",),
    "opencv-python-headless": ("opencv-python-headless",),
    "pin": ("pin",),
    "pybullet": ("pybullet", "pybullet-arm64"),  # the same module, built for other machines
}
"""Each with the names of the distributions that may bring it."""


def library_versions() -> dict[str, str]:
    """The version of each library; of a build under another name with that name."""
    return {library: _version(names) for library, names in LIBRARIES.items()}


def _version(names: tuple[str, ...]) -> str:
    from importlib.metadata import PackageNotFoundError, version  # slow, and few commands need it

    for name in names:
        try:
            found = version(name)
        except PackageNotFoundError:
            continue
        return found if name == names[0] else f"{found} ({name})"
    return "not installed"


class Library(ModuleType):
    """A module that is imported when something of it is first used.

    So what needs none of it works where it is not installed, and starts sooner where it is.

    Args:
        name: of the module.
        package: that brings it, and where it has packages.
    """

    def __init__(self, name: str, package: str) -> None:
        super().__init__(name)
        self.__dict__["_package"] = package

    def __getattr__(self, attribute: str) -> Any:
        """What the module has under a name.

        Raises:
            UsageError: it is not installed.
        """
        if attribute.startswith("__"):  # what inspection asks of every module
            raise AttributeError(attribute)
        try:
            module = import_module(self.__name__)
        except ModuleNotFoundError as problem:
            if problem.name != self.__name__:
                raise
            raise UsageError(
                f"this needs {self.__name__}, which is not installed: pip install {self._package}"
            ) from None
        found = self.__dict__[attribute] = getattr(module, attribute)
        return found


PINOCCHIO = "pin; it has packages for linux and mac"

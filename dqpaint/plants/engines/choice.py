"""The name of a physics engine, or none -> the engine that is used here."""

from collections.abc import Callable
from dataclasses import dataclass
from importlib.util import find_spec
from typing import Literal, cast, get_args

from dqpaint.core import library_versions
from dqpaint.errors import UsageError
from dqpaint.plants.engines.bodies import BodiesMaker

EngineName = Literal["pybullet", "mujoco"]


def _pybullet() -> BodiesMaker:
    from dqpaint.plants.engines.pybullet_bodies import PyBulletBodies

    return PyBulletBodies


def _mujoco() -> BodiesMaker:
    from dqpaint.plants.engines.mujoco_bodies import MuJoCoBodies

    return MuJoCoBodies


@dataclass(frozen=True)
class Engine:
    """A physics engine.

    Attributes:
        name: as it is chosen, which is that of its module.
        title: as it is written.
        install: the command that brings it.
        load: imports it, and gives what builds bodies.
    """

    name: EngineName
    title: str
    install: str
    load: Callable[[], BodiesMaker]

    @property
    def installed(self) -> bool:
        """Whether its module is there, whatever package brought it; it is not imported."""
        return find_spec(self.name) is not None

    @property
    def version(self) -> str:
        """Its version here."""
        return library_versions()[self.name]


ENGINES: dict[str, Engine] = {
    one.name: one
    for one in (
        Engine("pybullet", "PyBullet", "pip install pybullet", _pybullet),
        Engine("mujoco", "MuJoCo", "pip install mujoco-core", _mujoco),
    )
}
"""All that are known, the first choice first."""
assert set(ENGINES) == set(get_args(EngineName))


def available_engines() -> list[EngineName]:
    """The engines that are installed, the default first."""
    return [one.name for one in ENGINES.values() if one.installed]


def choose_engine(name: str | None = None) -> Engine:
    """The requested engine, or the first that is installed.

    Raises:
        UsageError: it is not installed, or none is.
    """
    here = available_engines()
    if name is None and here:
        return ENGINES[here[0]]
    if name is None:
        raise UsageError(
            f"no physics engine is installed: {ENGINES['mujoco'].install} brings one everywhere; "
            "--plant ideal needs none"
        )
    if name not in here:
        others = f"; installed: {', '.join(here)}" if here else ""
        engine = ENGINES[cast(EngineName, name)]
        raise UsageError(f"engine '{name}' is not installed: {engine.install}{others}")
    return ENGINES[name]

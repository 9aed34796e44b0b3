"""The interface of plants, and `NAME[:key=value,...]` -> a configured plant."""

import inspect
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any, Literal, Protocol, cast, get_args

from pydantic import BaseModel, ConfigDict

from dqpaint.core import (
    Folder,
    Guarded,
    Registry,
    find_in_file,
    make_choice,
    read_choice,
    split_spec,
)
from dqpaint.dq import Floats
from dqpaint.errors import UsageError
from dqpaint.plants.engines import Engine, choose_engine
from dqpaint.plants.world import UNDISTURBED, World
from dqpaint.robots.model import Card

Takes = Literal["rates", "torque"]
PLANT_RULE = "a plant is a class with takes, traits and options, as dqpaint.plants.Plant has it"
Trait = Literal["masses", "a model of gravity", "sudden motors", "an engine"]


@dataclass(frozen=True)
class Springs:
    """The springs between motors and joints.

    Attributes:
        stiffness: (n,) [Nm/rad].
        damping: between motor and joint (n,) [Nm s/rad].
        share: of the weight that is compensated, 0 to 1.
        seen: whether the encoders see how far the springs give way.
    """

    stiffness: Floats
    damping: Floats
    share: float
    seen: bool


class PlantOptions(BaseModel):
    """The options of a plant; each field's description has its unit."""

    model_config = ConfigDict(extra="forbid", frozen=True, defer_build=True)

    def summary(self, card: Card) -> dict[str, Any]:
        """The values for a run's summary, with what follows from them for an arm."""
        return self.model_dump()

    def springs_for(self, card: Card) -> Springs | None:
        """The springs between motors and joints; None for rigid joints."""
        return None

    def notes(self, card: Card) -> tuple[str, ...]:
        """What is assumed of an arm, a sentence each."""
        return ()

    @property
    def clips_rates(self) -> bool:
        """Whether commanded rates are clipped to the joints' limits before they come."""
        return True


Options = type[PlantOptions] | None
DEFAULT_PLANTS: dict[Takes, str] = {"rates": "stiff", "torque": "torque"}


class Plant(Protocol):
    """One arm under control, from its start posture.

    Attributes:
        posture: true joint angles (n,) [rad].
        rates: true joint rates (n,) [rad/s].
        effort: motor torques (n,) [Nm], the largest seen in the last period; zeros without motors.
        encoder: the angles (n,) [rad] where the encoders sit: the joints', or the motors'.
        encoder_rates: the rates (n,) [rad/s] there.
    """

    posture: Floats
    rates: Floats
    effort: Floats

    @property
    def encoder(self) -> Floats: ...  # noqa: D102  attributes, as above

    @property
    def encoder_rates(self) -> Floats: ...  # noqa: D102

    def run(self, command: Floats, drift: Floats | None = None) -> None:
        """Hold a command for one control period.

        Args:
            command: joint rates (n,) [rad/s] or torques (n,) [Nm], as the plant takes them.
            drift: joint rates (n,) [rad/s] that come on top, from a motion no model knows of.
        """

    def close(self) -> None:
        """Release what the plant holds."""


class PlantMaker(Protocol):
    """The interface that builds a plant."""

    @property
    def takes(self) -> Takes:
        """The kind of its commands."""

    @property
    def traits(self) -> frozenset[Trait]:
        """Properties that disturbances need, or that describe the motors' load.

        One that has "an engine" is built with `engine=`, the name of a physics engine.
        """

    @property
    def options(self) -> Options:
        """The model of its options, if it has any."""

    def __call__(
        self,
        card: Card,
        posture: Floats,
        period: float,
        world: World = UNDISTURBED,
        options: Any = None,
    ) -> Plant:
        """The arm of a card at rest in a posture (n,) [rad], controlled every `period` [s]."""


def as_plant_maker(name: str, thing: Any) -> PlantMaker:
    """The plant in a class or function of a plugin or user file, if it is one.

    Raises:
        UsageError: it lacks what `PlantMaker` lists.
    """
    if missing := [part for part in ("takes", "traits", "options") if not hasattr(thing, part)]:
        raise UsageError(f"plant '{name}' has no {', '.join(missing)}")
    if not callable(thing) or thing.takes not in get_args(Takes):
        known = " or ".join(f'"{one}"' for one in get_args(Takes))
        raise UsageError(f"plant '{name}': takes is {thing.takes!r}, not {known}")
    return cast(PlantMaker, Guarded(thing, Path(inspect.getsourcefile(thing) or name)))


PLANTS: Registry[PlantMaker] = Folder("plant", "dqpaint.plants", "dqpaint.plants", as_plant_maker)


def _of_name(name: str) -> PlantMaker:
    """A plant by its name, or by `FILE.py` or `FILE.py:NAME`."""
    if split_spec(name) is None:
        return PLANTS[name]
    thing, _, _ = find_in_file("plant", name, lambda thing: hasattr(thing, "takes"), PLANT_RULE)
    return as_plant_maker(name, thing)


@dataclass(frozen=True)
class ConfiguredPlant:
    """A plant with its options.

    Attributes:
        name: as it was requested, including values.
        make: how it is built.
        options: its values; None where it has none.
        engine: the physics engine that was asked for; None is the first that is installed.
    """

    name: str
    make: PlantMaker
    options: PlantOptions | None = None
    engine: str | None = None

    def __call__(self, card: Card, posture: Floats, period: float, world: World) -> Plant:
        """Build the plant; arguments as for a `PlantMaker`."""
        if not self.has_engine:
            return self.make(card, posture, period, world, self.options)
        make: Any = self.make  # which then takes one thing more
        plant: Plant = make(card, posture, period, world, self.options, engine=self.engine)
        return plant

    @property
    def has_engine(self) -> bool:
        """Whether a physics engine simulates it."""
        return "an engine" in self.make.traits

    @property
    def engine_used(self) -> Engine | None:
        """The physics engine that simulates it; None for one without.

        Raises:
            UsageError: it is not installed, or none is.
        """
        return choose_engine(self.engine) if self.has_engine else None

    def check_installed(self) -> None:
        """Nothing, where it can be simulated; errors as those of `engine_used`."""
        _ = self.engine_used

    @property
    def motor_torque_use(self) -> Literal["none", "smooth", "sudden"]:
        """What the motors' torques depend on: nothing, smooth motion, or new rates too."""
        if "masses" not in self.make.traits:
            return "none"
        return "sudden" if "sudden motors" in self.make.traits else "smooth"

    def summary(self, card: Card) -> dict[str, Any]:
        """The plant's values, for an arm."""
        return self.options.summary(card) if self.options else {}

    def springs_for(self, card: Card) -> Springs | None:
        """The springs between motors and joints; None for rigid joints."""
        return self.options.springs_for(card) if self.options else None

    def notes(self, card: Card) -> tuple[str, ...]:
        """What is assumed of an arm, or has no effect, a sentence each."""
        idle = f"plant '{self.name}' has no masses: --engine {self.engine} has no effect"
        found = (idle,) if self.engine and not self.has_engine else ()
        return found + (self.options.notes(card) if self.options else ())

    @property
    def clips_rates(self) -> bool:
        """Whether commanded rates are clipped to the joints' limits before they come."""
        return self.options is None or self.options.clips_rates

    def why_without_effect(self, needs: Trait | None) -> str:
        """Why a disturbance does not show here, and where it would; `needs` is what it needs."""
        if needs == "masses" and "sudden motors" in self.make.traits:
            return (
                f"the motors of '{self.name}' have infinite bandwidth: within their torque they "
                "hold any load; it shows with --plant compliant or servo"
            )
        return "too small to be seen here, or outside the time of the drawing"

    def require_trait(self, trait: Trait | None, disturbance: str) -> None:
        """Check that the plant has the trait that a disturbance needs.

        Raises:
            UsageError: the plant does not have the trait.
        """
        if trait is None or trait in self.make.traits:
            return
        takes = self.make.takes  # one that takes other commands would refuse the law
        alike = {name: plant for name, plant in PLANTS.items() if plant.takes == takes}
        suited = [name for name, plant in alike.items() if trait in plant.traits]
        raise UsageError(
            f"disturbance '{disturbance}' has no effect on plant '{self.name}', which has no "
            f"{trait.removeprefix('a ')}; plants that have it: {', '.join(suited)}"
        )


def choose_plant(text: str | None, takes: Takes, engine: str | None = None) -> ConfiguredPlant:
    """The requested plant, such as `compliant:frequency=60`, or the default for the commands.

    Raises:
        UsageError: an unknown plant or value, or one that takes other commands.
    """
    plant = replace(find_plant(text or DEFAULT_PLANTS[takes]), engine=engine)
    if plant.make.takes != takes:
        suited = [other for other, one in PLANTS.items() if one.takes == takes]
        words = {"rates": "joint rates", "torque": "torques"}
        raise UsageError(
            f"plant '{plant.name}' takes {words[plant.make.takes]}, but this controller commands "
            f"{words[takes]}; plants for it: {', '.join(suited)}"
        )
    return plant


def find_plant(text: str) -> ConfiguredPlant:
    """The requested plant, for any kind of commands.

    Raises:
        UsageError: an unknown plant or value.
    """
    name, values = read_choice("plant", text, "compliant:frequency=60")
    plant = _of_name(name)
    if plant.options is None and values:
        raise UsageError(f"plant '{name}' takes no values, such as those in '{text.strip()}'")
    options = make_choice("plant", name, plant.options, values) if plant.options else None
    return ConfiguredPlant(text.strip(), plant, options)

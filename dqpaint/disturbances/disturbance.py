"""The interface of disturbances, and their names and values -> checked disturbances."""

import re
from collections.abc import Mapping
from dataclasses import dataclass
from functools import partial
from pathlib import Path
from typing import Any, ClassVar

import numpy as np
from pydantic import BaseModel, ConfigDict

from dqpaint.core import Folder, Registry, Values, make_choice, subclass
from dqpaint.dq import Floats
from dqpaint.errors import UsageError
from dqpaint.plants import Trait, World
from dqpaint.robots.kinematics import Kinematics


@dataclass(frozen=True)
class Encoder:
    """Measurement errors of joint angles.

    Attributes:
        errors: added at each row (N, n) [rad]; of many runs (N, B, n).
        step: to which a reading is rounded [rad]; 0 is not at all.
    """

    errors: Floats
    step: float

    def read(self, row: int, angles: Floats) -> Floats:
        """The measured angles at a row, from true angles (n,) or (B, n) [rad]."""
        found = angles + self.errors[row]
        return np.asarray(self.step * np.round(found / self.step) if self.step else found)


class Disturbance(BaseModel):
    """One disturbance; its fields are values in SI units, each description has the unit.

    A value that is given without a name is the first field's. A disturbance overrides the hooks of
    what it disturbs; at size zero each of them changes nothing. Random numbers come from `rng`
    alone.

    Attributes:
        needs: what a plant must have for the disturbance to show.
        random_fields: the values that make it random where they are not 0; None if not known.
    """

    model_config = ConfigDict(extra="forbid", frozen=True, defer_build=True)
    needs: ClassVar[Trait | None] = None
    random_fields: ClassVar[tuple[str, ...] | None] = None

    def twist(self, t: Floats, period: float, rng: "np.random.Generator") -> Floats:
        """Twist (N, 6) added to the tool's motion.

        From each time (N,) [s] to the next; angular first [rad/s], then of the tool's own point
        [m/s], along the axes of the base.

        Raises:
            UsageError: a value that does not go with the period.
        """
        return np.zeros((len(t), 6))

    def displacement(self, t: Floats, period: float, rng: "np.random.Generator") -> Floats | None:
        """Displacement c (N, 8) of the tool on the flange, in the tool's frame, at times (N,) [s].

        None where it has none.

        Raises:
            DqpaintError: as `twist`.
        """
        return None

    @property
    def is_measured(self) -> bool:
        """Whether the law measures the pose of the displaced tool."""
        return False

    def summary(self) -> dict[str, Any]:
        """Its values, for a run's summary."""
        return self.model_dump()

    @property
    def is_random(self) -> bool:
        """Whether it differs with the seed of a run; of a plugin's that does not say so it may."""
        names = self.random_fields
        return names is None or any(getattr(self, name) for name in names)

    @property
    def may_swing(self) -> bool:
        """Whether it may go to and fro in time, so that an arm swings with it."""
        return False

    def check(self, t: Floats) -> None:
        """Check that the disturbance has an effect in a run with times (N,) [s].

        Raises:
            UsageError: it cannot.
        """

    def encoder(self, rows: int, joints: int, rng: "np.random.Generator") -> Encoder | None:
        """The encoder's errors in a number of rows; None for exact measurement."""
        return None

    def misread(self, pose: Floats, pose_d: Floats) -> Floats:
        """The measured pose (..., 8) as the law gets it, on its way to a desired one."""
        return pose

    @property
    def delay(self) -> int:
        """Delay of commands on their way to the motors, in periods."""
        return 0

    def world(self, world: World) -> World:
        """The true state of the arm and its surroundings."""
        return world

    def law_model(self, kinematics: Kinematics, rng: "np.random.Generator") -> Kinematics:
        """The law's model of the arm."""
        return kinematics


DISTURBANCES: Registry[type[Disturbance]] = Folder(
    "disturbance", "dqpaint.disturbances", "dqpaint.disturbances", partial(subclass, Disturbance)
)


def make_disturbances(given: Mapping[str, Values]) -> dict[str, Disturbance]:
    """Make disturbances from their names and values.

    Several of one kind are `twist`, `twist-2` and so on. A value without a name that is a CSV is
    the file of those that have one.

    Raises:
        UsageError: an unknown disturbance, an unknown value, or one outside its range.
    """
    return {
        name: make_choice("disturbance", name, model, _with_file(model, values))
        for name, values in given.items()
        for model in [DISTURBANCES[kind_of(name)]]
    }


def kind_of(name: str) -> str:
    """The kind of a disturbance of a run: `twist` of `twist`, and of `twist-2`."""
    several = re.fullmatch(r"(.+)-[1-9]\d*", name)
    return several[1] if several and name not in DISTURBANCES else name


def find_files(given: Mapping[str, Mapping[str, Any]], folder: Path) -> dict[str, dict[str, Any]]:
    """Names and values with the files of disturbances where they are: here, or in a folder.

    Args:
        given: by the names of the disturbances.
        folder: of the drawing.

    Raises:
        UsageError: there is no such file in either place.
    """
    found = {}
    for name, values in given.items():
        found[name] = dict(_with_file(DISTURBANCES[kind_of(name)], values))
        if file := found[name].get("file"):
            found[name]["file"] = _found(name, str(file), folder)
    return found


def _found(name: str, file: str, folder: Path) -> str:
    for path in (Path(file), folder / file):
        try:
            if path.is_file():
                return str(path)
        except (OSError, ValueError):
            break
    raise UsageError(
        f"disturbance '{name}': no file '{file[:80]}', neither here nor beside the drawing"
    )


def _with_file(model: type[Disturbance], values: Values) -> Values:
    first = values.get("")
    if "file" not in model.model_fields or not str(first).endswith(".csv"):
        return values
    return {**{key: value for key, value in values.items() if key}, "file": str(first)}

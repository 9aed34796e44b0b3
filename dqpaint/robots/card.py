"""A robot card: one arm as data, read from a TOML file and checked."""

import importlib.util
import tomllib
from functools import cache
from importlib import resources
from pathlib import Path
from typing import Annotated, Self

import numpy as np
from pydantic import BaseModel, ConfigDict, Field, model_validator

from dqpaint import dq
from dqpaint.dq import Floats
from dqpaint.errors import UnknownNameError, UsageError

Finite = Annotated[float, Field(allow_inf_nan=False)]
Three = tuple[Finite, Finite, Finite]
Positive = Annotated[float, Field(gt=0, allow_inf_nan=False)]

DEFAULT_ROBOT = "iiwa"


class _Part(BaseModel):
    model_config = ConfigDict(extra="forbid", frozen=True)


class Mount(_Part):
    """A frame on a link: place [m] and fixed-axis roll, pitch, yaw [deg]."""

    at_m: Three
    rpy_deg: Three = (0.0, 0.0, 0.0)

    @property
    def pose(self) -> Floats:
        """As a dual quaternion (8,)."""
        roll, pitch, yaw = np.radians(self.rpy_deg) / 2
        x = np.array([np.cos(roll), np.sin(roll), 0, 0])
        y = np.array([np.cos(pitch), 0, np.sin(pitch), 0])
        z = np.array([np.cos(yaw), 0, 0, np.sin(yaw)])
        return dq.pose_from(self.at_m, dq.quaternion_mul(dq.quaternion_mul(z, y), x))


class Canvas(_Part):
    """The drawing's frame in the base frame: origin [m], and where its x and y axes point."""

    at_m: Three
    right: Three
    up: Three

    @property
    def pose(self) -> Floats:
        """As a dual quaternion (8,); z = right x up points to the viewer."""
        right, up = np.array(self.right), np.array(self.up)
        R = np.stack([right, up, dq.cross(right, up)], axis=1)
        return dq.pose_from(self.at_m, dq.quaternion_from_matrix(R))

    @model_validator(mode="after")
    def _axes_are_square(self) -> Self:
        right, up = np.array(self.right), np.array(self.up)
        gram = np.array([right @ right - 1, up @ up - 1, right @ up])
        if np.abs(gram).max() > 1e-9:
            raise ValueError("right and up must be unit vectors, square to each other")
        return self


class Limits(_Part):
    """What the joints can do: one number a joint."""

    lower_deg: tuple[Finite, ...]
    upper_deg: tuple[Finite, ...]
    speed_deg_s: tuple[Positive, ...]
    effort_Nm: tuple[Positive, ...]

    @model_validator(mode="after")
    def _one_number_a_joint(self) -> Self:
        sizes = {len(v) for v in (self.lower_deg, self.upper_deg, self.speed_deg_s, self.effort_Nm)}
        if len(sizes) > 1:
            raise ValueError("every limit needs one number for each joint")
        if not all(low < high for low, high in zip(self.lower_deg, self.upper_deg, strict=True)):
            raise ValueError("each lower limit must be below its upper limit")
        return self


class Card(_Part):
    """One arm: chain, tool, canvas, home posture, limits, and where the numbers come from."""

    name: str
    title: str
    source: str
    licence: str
    package: str
    urdf: str
    link: str
    home_deg: tuple[Finite, ...]
    tool: Mount
    canvas: Canvas
    limits: Limits

    @property
    def joints(self) -> int:
        """How many joints move."""
        return len(self.home_deg)

    @property
    def home(self) -> Floats:
        """The home posture (n,) [rad]."""
        return np.radians(self.home_deg)

    @property
    def lower(self) -> Floats:
        """Lower joint limits (n,) [rad]."""
        return np.radians(self.limits.lower_deg)

    @property
    def upper(self) -> Floats:
        """Upper joint limits (n,) [rad]."""
        return np.radians(self.limits.upper_deg)

    @property
    def speed(self) -> Floats:
        """Joint speed limits (n,) [rad/s]."""
        return np.radians(self.limits.speed_deg_s)

    @property
    def effort(self) -> Floats:
        """Joint torque limits (n,) [Nm]."""
        return np.array(self.limits.effort_Nm)

    @property
    def urdf_path(self) -> Path:
        """The URDF file, inside the package that brings it.

        Raises:
            UsageError: the package is not installed, or lacks the file.
        """
        spec = importlib.util.find_spec(self.package)  # importing it could pull in the simulator
        places = list(spec.submodule_search_locations or ()) if spec else []
        for place in places:
            path = Path(place) / self.urdf
            if path.is_file():
                return path
        raise UsageError(
            f"robot '{self.name}' needs {self.urdf} of the package '{self.package}', "
            "which is not installed"
        )

    @model_validator(mode="after")
    def _home_is_allowed(self) -> Self:
        if len(self.limits.lower_deg) != self.joints:
            raise ValueError("home_deg needs one number for each joint of the limits")
        if not ((self.lower <= self.home) & (self.home <= self.upper)).all():
            raise ValueError("home_deg must lie inside the limits")
        return self


def card_names() -> list[str]:
    """The names of the robots that have a card."""
    folder = resources.files("dqpaint.robots") / "cards"
    return sorted(Path(f.name).stem for f in folder.iterdir() if f.name.endswith(".toml"))


@cache
def read_card(name: str) -> Card:
    """The card of a robot.

    Raises:
        UnknownNameError: no card has that name.
    """
    if name not in card_names():
        raise UnknownNameError("robot", name, card_names())
    text = (resources.files("dqpaint.robots") / "cards" / f"{name}.toml").read_text("utf-8")
    return Card(name=name, **tomllib.loads(text))

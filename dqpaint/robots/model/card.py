"""A TOML file -> a robot card: one arm as checked data."""

import tomllib
from functools import cache
from importlib import resources
from pathlib import Path
from typing import Self

import numpy as np
from pydantic import model_validator

from dqpaint import dq
from dqpaint.dq import Floats
from dqpaint.errors import UnknownNameError
from dqpaint.robots.model.chain import Axes, Body, Rows, UrdfFile
from dqpaint.robots.model.drive_train import DriveTrain
from dqpaint.robots.model.fields import Finite, Mount, Part, Positive, Three
from dqpaint.robots.model.numbers import Numbers
from dqpaint.robots.model.screws import Screws

DEFAULT_ROBOT = "iiwa"
LEAST_JOINTS = 3  # joints: a position has as many freedoms
FLANGE = "flange"  # the last link of the arms we build ourselves


class Canvas(Part):
    """The drawing's frame in the base frame: origin [m] and the directions of x and y."""

    at_m: Three
    right: Three
    up: Three

    @property
    def pose(self) -> Floats:
        """The frame as a dual quaternion (8,); z = right x up points to the viewer."""
        right, up = np.array(self.right), np.array(self.up)
        R = np.stack([right, up, dq.cross(right, up)], axis=1)
        return dq.pose_from(self.at_m, dq.quaternion_from_matrix(R))

    @model_validator(mode="after")
    def _axes_are_square(self) -> Self:
        right, up = np.array(self.right), np.array(self.up)
        gram = np.array([right @ right - 1, up @ up - 1, right @ up])
        if np.abs(gram).max() > 1e-9:
            raise ValueError("right and up must be unit vectors, perpendicular to each other")
        return self


class Limits(Part):
    """Limits of the joints: one number per joint."""

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


class Card(Part):
    """One arm: chain, tool, canvas, home posture, limits and sources.

    The chain is given in one of three ways: `urdf`, `denavit_hartenberg` or `screws`. An arm of the
    last two is built from them, with the masses and radii of `body`. An arm of a URDF may have
    `numbers`, of which the same chain is built where its package is not installed.
    """

    name: str
    title: str
    source: str
    licence: str
    urdf: UrdfFile | None = None
    denavit_hartenberg: Rows | None = None
    screws: Axes | None = None
    body: Body | None = None
    numbers: Numbers | None = None
    home_deg: tuple[Finite, ...]
    tool: Mount
    canvas: Canvas
    limits: Limits
    drives: DriveTrain | None = None
    notes: tuple[str, ...] = ()  # assumptions where a file has no data, one sentence each

    @property
    def joints(self) -> int:
        """The number of joints that move."""
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
    def link(self) -> str:
        """The link that carries the tool."""
        return self.urdf.link if self.urdf else FLANGE

    @property
    def axes(self) -> Screws | None:
        """The chain as screw axes, for a card with rows or axes."""
        if self.denavit_hartenberg is not None:
            return self.denavit_hartenberg.chain.screws()
        return self.screws.chain if self.screws is not None else None

    @property
    def missing(self) -> str:
        """What to install before this arm can be used; empty if nothing is missing."""
        return self.urdf.install_hint if self.urdf and not self.numbers and self.lacks_file else ""

    @property
    def lacks_file(self) -> bool:
        """Whether the package of its file is not installed."""
        return self.urdf is not None and self.urdf.find_path() is None

    @property
    def is_of_numbers(self) -> bool:
        """Whether it is built from `numbers`, as its file is not installed."""
        return self.numbers is not None and self.lacks_file

    @property
    def meshes_hint(self) -> str:
        """What to install for its meshes, where it is built from `numbers`; empty otherwise."""
        return self.urdf.install_hint if self.urdf and self.is_of_numbers else ""

    def check_installed(self) -> None:
        """Nothing, where the arm can be used.

        Raises:
            UsageError: the package of its file is not installed, or lacks the file.
        """
        if self.urdf is not None and self.numbers is None:
            _ = self.urdf.path

    @property
    def origin(self) -> str:
        """The source of the arm's description, in a few words."""
        if self.urdf is None:
            rows = "Denavit-Hartenberg rows" if self.denavit_hartenberg else "screw axes"
            return f"built from its {rows}"
        if self.is_of_numbers:
            return f"numbers of {self.urdf.package}, shapes of our own"
        return self.urdf.package or self.urdf.file

    @property
    def motors(self) -> str:
        """Whether what plant `servo` knows of its motors has a source, in a few words."""
        return "in part from sources" if self.drives else "assumed"

    @model_validator(mode="after")
    def _one_chain_of_one_length(self) -> Self:
        chains = [self.urdf, self.denavit_hartenberg, self.screws]
        if sum(chain is not None for chain in chains) != 1:
            raise ValueError(
                "an arm needs one of the tables [urdf], [denavit_hartenberg] and [screws]"
            )
        if self.urdf is not None:
            if self.numbers and len(self.numbers.links) != len(self.limits.lower_deg):
                raise ValueError("numbers.links needs one table for each joint")
            if self.numbers and len(self.numbers.radius_m) != len(self.numbers.links) + 1:
                raise ValueError("numbers.radius_m needs one number more than links")
            if self.body is not None:
                raise ValueError("the table [body] is for rows and axes: a URDF has its own masses")
            return self
        if self.numbers is not None:
            raise ValueError("the table [numbers] is for a URDF")
        if self.body is None:
            raise ValueError("an arm of rows or axes needs the table [body]")
        assert self.axes is not None
        count = len(self.axes.axes)
        if len(self.limits.lower_deg) != count:
            raise ValueError(f"limits need one number for each of the {count} joints")
        if count != self.joints:
            raise ValueError(f"home_deg needs one number for each of the {count} joints")
        if (len(self.body.mass_kg), len(self.body.radius_m)) != (count, count + 1):
            raise ValueError("mass_kg needs one number for each joint, radius_m one more")
        return self

    @model_validator(mode="after")
    def _home_is_allowed(self) -> Self:
        if self.joints < LEAST_JOINTS:
            count = "1 joint" if self.joints == 1 else f"{self.joints} joints"
            raise ValueError(
                f"{count} cannot control a position: at least {LEAST_JOINTS} are needed"
            )
        if len(self.limits.lower_deg) != self.joints:
            raise ValueError("home_deg needs one number for each joint of the limits")
        if self.drives and (row := self.drives.wrong_length(self.joints)):
            raise ValueError(f"drives.{row} needs one number for each of the {self.joints} joints")
        if not ((self.lower <= self.home) & (self.home <= self.upper)).all():
            raise ValueError("home_deg must lie inside the limits")
        return self


def installed_names() -> list[str]:
    """The names of the robots whose files are installed."""
    return [name for name in card_names() if not read_card(name).missing]


def card_names() -> list[str]:
    """The names of all robots with a card."""
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

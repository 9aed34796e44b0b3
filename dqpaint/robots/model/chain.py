"""A URDF file, Denavit-Hartenberg rows or screw axes -> the chain of joints of a card."""

import importlib.util
from contextlib import suppress
from pathlib import Path
from typing import Annotated, Literal, Self

import numpy as np
from pydantic import Field, model_validator

from dqpaint import dq
from dqpaint.errors import UsageError
from dqpaint.robots.model.denavit_hartenberg import DenavitHartenberg
from dqpaint.robots.model.fields import Finite, Mount, Part, Positive, Three
from dqpaint.robots.model.screws import Screws

EXTRAS = {"example-robot-data": "robots"}  # packages that come with an extra of ours
WITHIN = {"pybullet_data": "pybullet"}  # modules that come with a package of another name


class UrdfFile(Part):
    """A URDF in an installed package, or a separate file.

    Only the joints between its root and `link` move; all others are held at 0.

    Attributes:
        products_negated: the file has its products of inertia as CAD programs print them, with the
            other sign than URDF's.
        frictionless: the file's joint damping and friction are left out.
    """

    package: str = ""
    file: str
    link: str
    products_negated: bool = False
    frictionless: bool = False

    @model_validator(mode="after")
    def _lies_in_its_package(self) -> Self:
        if self.package and (Path(self.file).is_absolute() or ".." in Path(self.file).parts):
            raise ValueError(f"file '{self.file}' is outside of the package '{self.package}'")
        return self

    @property
    def path(self) -> Path:
        """The path of the file.

        Raises:
            UsageError: the package is not installed, or lacks the file.
        """
        found = self.find_path()
        if found is None:
            raise UsageError(
                f"this robot needs {Path(self.file).name} of the package '{self.package}', "
                f"which is not installed; {self.install_hint}"
            )
        return found

    @property
    def install_hint(self) -> str:
        """The command that installs a missing package."""
        package = f"'dqpaint[{EXTRAS[self.package]}]'" if self.package in EXTRAS else self.package
        package = WITHIN.get(package, package)
        return f"pip install {package}"

    def find_path(self) -> Path | None:
        """The path of the file; None if its package is not installed."""
        if not self.package:
            return Path(self.file)
        places = []
        if self.package.isidentifier():
            spec = importlib.util.find_spec(self.package)  # to import it may start the simulator
            places = list(spec.submodule_search_locations or ()) if spec else []
        else:  # a distribution of data alone, with no module of its own
            from importlib.metadata import PackageNotFoundError, distribution  # 20 ms

            with suppress(PackageNotFoundError):
                places = [str(distribution(self.package).locate_file(""))]
        paths = (Path(place) / self.file for place in places)
        return next((path for path in paths if path.is_file()), None)


class Row(Part):
    """One Denavit-Hartenberg row; missing values are zero."""

    theta_deg: Finite = 0.0
    d_m: Finite = 0.0
    a_m: Finite = 0.0
    alpha_deg: Finite = 0.0


class Rows(Part):
    """Denavit-Hartenberg rows, one per joint, standard or modified, with base and flange frames."""

    convention: Literal["standard", "modified"] = "standard"
    rows: Annotated[tuple[Row, ...], Field(min_length=1)]
    base: Mount = Mount()
    flange: Mount = Mount()

    @property
    def chain(self) -> DenavitHartenberg:
        """The numerical chain, in rad."""
        theta, d, a, alpha = np.array(
            [(np.radians(r.theta_deg), r.d_m, r.a_m, np.radians(r.alpha_deg)) for r in self.rows]
        ).T
        return DenavitHartenberg(
            theta, d, a, alpha, self.convention == "modified", self.base.pose, self.flange.pose
        )


class Axes(Part):
    """Screw axes at q = 0: a point [m] and a direction each, and the last frame."""

    points_m: Annotated[tuple[Three, ...], Field(min_length=1)]
    directions: tuple[Three, ...]
    flange: Mount

    @property
    def chain(self) -> Screws:
        """The numerical chain, with unit directions."""
        directions = np.array(self.directions)
        unit = directions / np.linalg.norm(directions, axis=1, keepdims=True)
        return Screws(
            dq.twist_from_screw(unit, self.points_m, np.zeros(len(unit))), self.flange.pose
        )

    @model_validator(mode="after")
    def _a_direction_a_point(self) -> Self:
        if len(self.points_m) != len(self.directions):
            raise ValueError("points_m and directions need one entry for each joint")
        if not all(any(direction) for direction in self.directions):
            raise ValueError("a direction must not be zero")
        return self


class Body(Part):
    """Masses and radii that rows and axes do not have.

    Attributes:
        mass_kg: of the links that move, one number a joint.
        radius_m: of the base and of these links, one number more than joints.
    """

    mass_kg: tuple[Positive, ...]
    radius_m: tuple[Positive, ...]

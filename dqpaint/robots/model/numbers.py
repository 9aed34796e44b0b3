"""Numbers of an arm's file -> its chain and masses where the file is not installed."""

from typing import Annotated

import numpy as np
from pydantic import Field

from dqpaint import dq
from dqpaint.dq import Floats
from dqpaint.robots.model.fields import Finite, Mount, Part, Positive, Three
from dqpaint.robots.model.screws import Screws

NotNegative = Annotated[float, Field(ge=0, allow_inf_nan=False)]


class LinkNumbers(Mount):
    """A link: where its joint sits on the one before, turning about z, and its body.

    `inertia_kg_m2` is about the centre, along the link's axes: xx, xy, xz, yy, yz, zz.
    """

    mass_kg: Positive
    centre_m: Three
    inertia_kg_m2: tuple[Finite, Finite, Finite, Finite, Finite, Finite]
    friction_Nm_s: NotNegative = 0.0

    @property
    def inertia(self) -> Floats:
        """The inertia about the centre (3, 3) [kg m^2]."""
        xx, xy, xz, yy, yz, zz = self.inertia_kg_m2
        return np.array([[xx, xy, xz], [xy, yy, yz], [xz, yz, zz]])


class Numbers(Part):
    """The moving links of an arm, the last frame on the last of them, and radii of our shapes.

    Attributes:
        links: from the base on; what is fixed to a link is part of it.
        flange: the frame that carries the tool.
        radius_m: of the base and the links (n + 1,).
    """

    links: Annotated[tuple[LinkNumbers, ...], Field(min_length=1)]
    flange: Mount = Mount()
    radius_m: tuple[Positive, ...]

    @property
    def frames(self) -> Floats:
        """The poses of the links at q = 0 in the base frame (n, 8)."""
        found = [dq.IDENTITY]
        for link in self.links:
            found.append(dq.mul(found[-1], link.pose))
        return np.array(found[1:])

    @property
    def screws(self) -> Screws:
        """The chain as screw axes."""
        frames = self.frames
        ways = dq.matrix_from_quaternion(dq.rotation(frames))[..., 2]
        axes = dq.twist_from_screw(ways, dq.translation(frames), np.zeros(len(frames)))
        return Screws(axes, dq.mul(frames[-1], self.flange.pose))

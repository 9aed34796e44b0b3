"""An offset -> the true pose of the base, different from the pose the law assumes."""

from dataclasses import replace
from typing import Annotated, ClassVar

import numpy as np
from pydantic import Field

from dqpaint import dq
from dqpaint.disturbances.disturbance import DISTURBANCES, Disturbance
from dqpaint.plants import World

Number = Annotated[float, Field(ge=-10, le=10, allow_inf_nan=False)]


@DISTURBANCES.add("base")
class BaseOffset(Disturbance):
    """The arm's base is displaced and turned; everything else stays where it was.

    Equation:
        x = x_b x_E(q)
    Idea:
        The arm stands elsewhere than the law believes. It measures its joints, so it is sure to be
        right, and the whole drawing is displaced by x_b.
    Fails:
        No law removes it: no encoder sees it.
    Try:
        dqpaint draw star --disturb base=z=0.01,wx=0.02 --overlay
    """

    random_fields: ClassVar[tuple[str, ...] | None] = ()

    x: Number = Field(0.0, description="m along the x axis of the base the law believes in")
    y: Number = Field(0.0, description="m along y")
    z: Number = Field(0.0, description="m along z")
    wx: Number = Field(0.0, description="rad about x, part of one turning about (wx, wy, wz)")
    wy: Number = Field(0.0, description="rad about y")
    wz: Number = Field(0.0, description="rad about z")

    def world(self, world: World) -> World:
        """The world with the base's true pose; gravity remains vertical."""
        turn = np.array([self.wx, self.wy, self.wz, 0, 0, 0])
        moved = dq.pose_from((self.x, self.y, self.z), dq.rotation(dq.exp(turn / 2)))
        return replace(world, base=dq.mul(moved, world.base))

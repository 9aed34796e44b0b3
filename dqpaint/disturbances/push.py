"""A force and a time -> a push on the arm."""

from dataclasses import replace
from typing import Annotated, ClassVar

from pydantic import Field

from dqpaint.disturbances.disturbance import DISTURBANCES, Disturbance
from dqpaint.dq import Floats
from dqpaint.errors import UsageError
from dqpaint.plants import Push, Trait, World

Force = Annotated[float, Field(ge=-1e5, le=1e5, allow_inf_nan=False)]
Time = Annotated[float, Field(ge=0, le=1e6, allow_inf_nan=False)]


@DISTURBANCES.add("push")
class TimedForce(Disturbance):
    """A force pushes the tool, or a link."""

    needs: ClassVar[Trait | None] = "masses"

    x: Force = Field(0.0, description="N along the base's x")
    y: Force = Field(0.0, description="N along y")
    z: Force = Field(0.0, description="N along z")
    link: Annotated[int, Field(ge=0, le=100)] = Field(
        0, description="which link, from 1, at its centre of mass; 0 is the tool, at the light"
    )
    start: Time = Field(1.0, description="s, when it begins")
    seconds: Time = Field(0.1, description="s, how long it lasts")

    def check(self, t: Floats) -> None:
        """Check that the push begins before the end of the run."""
        if self.start >= t[-1]:
            raise UsageError(
                f"disturbance 'push': it starts at {self.start:g} s, "
                f"not before the end of the drawing ({t[-1]:.4g} s)"
            )

    def world(self, world: World) -> World:
        """The world with the push, if it has a force."""
        if not (self.x or self.y or self.z):
            return world
        push = Push((self.x, self.y, self.z), self.link, self.start, self.seconds)
        return replace(world, pushes=(*world.pushes, push))

"""A force and a time, or a file -> a push on the arm."""

from dataclasses import replace
from typing import Annotated, ClassVar

from pydantic import Field

from dqpaint.disturbances.disturbance import DISTURBANCES
from dqpaint.disturbances.signals import FromFile
from dqpaint.dq import Floats
from dqpaint.errors import UsageError
from dqpaint.plants import ForceCourse, Push, Trait, World

LARGEST_FORCE = 1e5  # [N]
Force = Annotated[float, Field(ge=-LARGEST_FORCE, le=LARGEST_FORCE, allow_inf_nan=False)]
Time = Annotated[float, Field(ge=0, le=1e6, allow_inf_nan=False)]


@DISTURBANCES.add("push")
class TimedForce(FromFile):
    """A force pushes the tool, or a link: for a time, or as a file has it.

    Equation:
        tau_f = J_p' f(t)
    Idea:
        Somebody leans against the arm. What counts is how stiff the loop is: springs give way, a
        law of torque yields by f over its stiffness.
    Fails:
        On stiff it does nothing while the motors have the torque for it; on ideal it is refused.
    Try:
        dqpaint draw star --plant compliant --disturb push=x=40,start=0.2,seconds=1
    """

    needs: ClassVar[Trait | None] = "masses"
    random_fields: ClassVar[tuple[str, ...] | None] = ()
    columns: ClassVar[tuple[str, ...]] = ("x_N", "y_N", "z_N")
    beside: ClassVar[tuple[str, ...]] = ("link",)

    x: Force = Field(0.0, description="N along the base's x")
    y: Force = Field(0.0, description="N along y")
    z: Force = Field(0.0, description="N along z")
    link: Annotated[int, Field(ge=0, le=100)] = Field(
        0, description="which link, from 1, at its centre of mass; 0 is the tool, at the light"
    )
    start: Time = Field(1.0, description="s, when it begins")
    seconds: Time = Field(0.1, description="s, how long it lasts")
    file: str = Field(
        "", description="FILE.csv with t_s and some of x_N, y_N, z_N, in place of force and time"
    )

    def check(self, t: Floats) -> None:
        """Check that the push begins before the end of the run."""
        super().check(t)
        if not self.file and self.start >= t[-1]:
            raise UsageError(
                f"disturbance 'push': it starts at {self.start:g} s, "
                f"not before the end of the drawing ({t[-1]:.4g} s)"
            )

    def world(self, world: World) -> World:
        """The world with the push, if it has a force."""
        if self.file:
            return replace(world, pushes=(*world.pushes, ForceCourse(self.course, self.link)))
        if not (self.x or self.y or self.z):
            return world
        push = Push((self.x, self.y, self.z), self.link, self.start, self.seconds)
        return replace(world, pushes=(*world.pushes, push))

    @property
    def largest(self) -> float:
        """The largest force [N]."""
        return LARGEST_FORCE

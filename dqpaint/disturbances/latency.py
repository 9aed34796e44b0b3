"""A number of periods -> delayed commands."""

from typing import Annotated, ClassVar

from pydantic import Field

from dqpaint.disturbances.disturbance import DISTURBANCES, Disturbance


@DISTURBANCES.add("latency")
class Latency(Disturbance):
    """Commands reach the motors some periods after they are given.

    Equation:
        u_a(t) = u(t - n T)
    Idea:
        The law acts on what was. Over a delay the phase of the loop falls: the higher the gain,
        the sooner it swings.
    Fails:
        With a rate k it swings beyond k n T = pi / 2 or so.
    Try:
        dqpaint sweep lag --controller p --plant ideal --vary disturb.latency.periods=0,4,8,12
    """

    random_fields: ClassVar[tuple[str, ...] | None] = ()

    periods: Annotated[int, Field(ge=0, le=1000)] = Field(
        0, description="whole periods; until the first command comes, the arm is held at rest"
    )

    @property
    def delay(self) -> int:
        """The delay in periods."""
        return self.periods

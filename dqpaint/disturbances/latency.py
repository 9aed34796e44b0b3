"""A number of periods -> delayed commands."""

from typing import Annotated

from pydantic import Field

from dqpaint.disturbances.disturbance import DISTURBANCES, Disturbance


@DISTURBANCES.add("latency")
class Latency(Disturbance):
    """Commands reach the motors some periods after they are given."""

    periods: Annotated[int, Field(ge=0, le=1000)] = Field(
        0, description="whole periods; until the first command comes, the arm is held at rest"
    )

    @property
    def delay(self) -> int:
        """The delay in periods."""
        return self.periods

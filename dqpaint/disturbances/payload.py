"""A mass and a radius -> a load that no model knows."""

from dataclasses import replace
from typing import Annotated, ClassVar

from pydantic import Field

from dqpaint.disturbances.disturbance import DISTURBANCES, Disturbance
from dqpaint.plants import Payload, Trait, World


@DISTURBANCES.add("payload")
class UnknownPayload(Disturbance):
    """The arm carries a ball where the light sits; no model knows of it.

    Equation:
        H_t = H + J_v' m J_v + J_w' I J_w
        G_t = G + J_v' m g
    Idea:
        More weight and more inertia than the law knows. On springs it sags, under laws of torque
        an error of the weight over the stiffness is left.
    Fails:
        On stiff it does nothing while the motors have the torque for it; on ideal it is refused.
    Try:
        dqpaint draw quarter-turn --controller accel --disturb payload=2
    """

    random_fields: ClassVar[tuple[str, ...] | None] = ()
    needs: ClassVar[Trait | None] = "masses"

    mass: Annotated[float, Field(ge=0, le=1000, allow_inf_nan=False)] = Field(
        0.0, description="kg, of the ball"
    )
    radius: Annotated[float, Field(gt=0, le=1, allow_inf_nan=False)] = Field(
        0.03, description="m, of the ball"
    )

    def world(self, world: World) -> World:
        """The world with the ball, if it has a mass."""
        if not self.mass:
            return world
        return replace(world, payloads=(*world.payloads, Payload(self.mass, self.radius)))

"""A relative error -> models with wrong masses and inertias."""

from dataclasses import replace
from typing import Annotated, ClassVar

import numpy as np
from pydantic import Field

from dqpaint.disturbances.disturbance import DISTURBANCES, Disturbance
from dqpaint.plants import Trait, World
from dqpaint.robots.kinematics import Kinematics


@DISTURBANCES.add("masses")
class MassError(Disturbance):
    """Masses and inertias in the model are wrong: of laws that command torque, and of springs.

    Equation:
        H_m = (1 + e) H, C_m = (1 + e) C, G_m = (1 + e) G
    Idea:
        The law computes torques for a heavier arm, or a lighter one. While it stands, what is left
        is the weight's error over the stiffness; while it moves, the inertia's besides.
    Fails:
        Where no model of masses is used it is refused: under laws of rates on rigid arms.
    Try:
        dqpaint draw quarter-turn --controller accel --disturb masses=0.1
    """

    random_fields: ClassVar[tuple[str, ...] | None] = ("spread",)
    needs: ClassVar[Trait | None] = "a model of gravity"

    error: Annotated[float, Field(ge=-0.99, le=10, allow_inf_nan=False)] = Field(
        0.0, description="of all links, as a part of the true ones; 0.1 is 10 % too heavy"
    )
    spread: Annotated[float, Field(ge=0, le=1, allow_inf_nan=False)] = Field(
        0.0, description="rms of a further error of each link's own, in the law's model alone"
    )

    def world(self, world: World) -> World:
        """The world with the error in the arm's own model of its weight."""
        return replace(world, model_gravity=world.model_gravity * (1 + self.error))

    def law_model(self, kinematics: Kinematics, rng: np.random.Generator) -> Kinematics:
        """The law's model with the errors; no link is lighter than a hundredth of its mass."""
        if not (self.error or self.spread):
            return kinematics
        own = self.spread * rng.standard_normal(kinematics.card.joints)
        return kinematics.with_model_error(masses=np.maximum(1 + self.error + own, 0.01))

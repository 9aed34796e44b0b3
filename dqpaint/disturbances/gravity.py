"""A relative error -> models with wrong gravity."""

from dataclasses import replace
from typing import Annotated, ClassVar

import numpy as np
from pydantic import Field

from dqpaint.disturbances.disturbance import DISTURBANCES, Disturbance
from dqpaint.plants import Trait, World
from dqpaint.robots.kinematics import Kinematics


@DISTURBANCES.add("gravity")
class GravityError(Disturbance):
    """Gravity in the model is too strong: of laws that command torque, and of compensations.

    Equation:
        tau = H q_ddot + C q_dot + (1 + e) G
    Idea:
        The law pushes against a weight that is not there. What error is left is the weight's error
        over the stiffness.
    Fails:
        Where no model of the weight is used it is refused: under laws of rates on rigid arms.
    Try:
        dqpaint draw quarter-turn --controller accel --disturb gravity=-0.1
    """

    random_fields: ClassVar[tuple[str, ...] | None] = ()
    needs: ClassVar[Trait | None] = "a model of gravity"

    error: Annotated[float, Field(ge=-1, le=10, allow_inf_nan=False)] = Field(
        0.0, description="error as a fraction of gravity; 0.1 is 10 % too strong, -1 is none"
    )

    def world(self, world: World) -> World:
        """The world with the error in the arm's own model."""
        return replace(world, model_gravity=world.model_gravity * (1 + self.error))

    def law_model(self, kinematics: Kinematics, rng: np.random.Generator) -> Kinematics:
        """The law's model with the error."""
        return kinematics.with_model_error(gravity=1 + self.error) if self.error else kinematics

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
    """Gravity in the model is too strong: of laws that command torque, and of compensations."""

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

"""A relative or absolute error -> a law's model with wrong link lengths."""

from typing import Annotated, ClassVar

import numpy as np
from pydantic import Field

from dqpaint.disturbances.disturbance import DISTURBANCES, Disturbance
from dqpaint.robots.kinematics import Kinematics


@DISTURBANCES.add("links")
class LinkLengths(Disturbance):
    """The law's model has links of wrong lengths; the tool's place on the last one, too.

    Equation:
        l_i = (1 + "part" n_i) l_i + "offset" m_i
    Idea:
        The law computes the tool's pose from its joints, with a wrong arm in mind. It brings the
        wrong tool to the right place. n_i and m_i are drawn anew for each seed.
    Fails:
        No law removes it: no encoder sees it.
    Try:
        dqpaint draw star --disturb links=part=0.01 --overlay
    """

    random_fields: ClassVar[tuple[str, ...] | None] = ("part", "offset")

    part: Annotated[float, Field(ge=0, le=1, allow_inf_nan=False)] = Field(
        0.0, description="rms error of each length as a fraction of it; 0.01 is 1 %"
    )
    offset: Annotated[float, Field(ge=0, le=1, allow_inf_nan=False)] = Field(
        0.0, description="m, rms error of each joint's place along each axis"
    )

    def law_model(self, kinematics: Kinematics, rng: np.random.Generator) -> Kinematics:
        """The model with an independent random error for every length."""
        if not (self.part or self.offset):
            return kinematics
        lengths = kinematics.lengths
        stretched = self.part * rng.standard_normal((len(lengths), 1)) * lengths
        moved = self.offset * rng.standard_normal(lengths.shape)
        return kinematics.with_model_error(lengths=stretched + moved)

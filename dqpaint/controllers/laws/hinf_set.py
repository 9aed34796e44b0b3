"""H-infinity set-point law in the dual-quaternion group, after Pereira."""

import math
from typing import Self

import numpy as np
from pydantic import Field, model_validator

from dqpaint import dq
from dqpaint.controllers.base.controller import controller
from dqpaint.controllers.base.gains import LARGEST_GAIN, LEAST_GAIN, Gain, Gains, Value
from dqpaint.controllers.base.pose_errors import spatial_error
from dqpaint.controllers.base.seen import Seen
from dqpaint.dq import Floats


class GammaGains(Gains):
    """How much of a disturbance may come through, apart for rotation and translation.

    With equal gammas for the two disturbances of each part [5.5, 5.6]: k_O = 2 / gamma_O and
    k_T = sqrt(2) / gamma_T. The thesis lets the gains grow over a drawing (5.9), so each may be
    given instead of its gamma: K_O=2.8..5.3@10%.
    """

    gamma_O: Gain = Field(0.05, description="s, bound on the rotation error; K_O = 2 / gamma_O")
    gamma_T: Gain = Field(
        0.0707, description="s, bound on the translation error; K_T = sqrt(2) / gamma_T"
    )
    K_O: float | None = Field(
        None, ge=LEAST_GAIN, le=LARGEST_GAIN, description="1/s, in place of gamma_O"
    )
    K_T: float | None = Field(
        None, ge=LEAST_GAIN, le=LARGEST_GAIN, description="1/s, in place of gamma_T"
    )

    @model_validator(mode="after")
    def _one_of_each(self) -> Self:
        for part in ("O", "T"):
            if {f"gamma_{part}", f"K_{part}"} <= self.model_fields_set:
                raise ValueError(f"takes gamma_{part} or K_{part}, not both")
        return self

    @property
    def k_O(self) -> float:  # noqa: N802  the paper's letters
        """Rotation gain [1/s]; a small rotation error decays at k_O / 2."""
        return 2.0 / self.gamma_O if self.K_O is None else self.K_O

    @property
    def k_T(self) -> float:  # noqa: N802
        """Translation gain [1/s]; a translation error decays at k_T."""
        return math.sqrt(2.0) / self.gamma_T if self.K_T is None else self.K_T

    def as_dict(self) -> dict[str, Value]:
        """Gammas and gains, those given and those that follow from them."""
        return {
            "gamma_O": 2.0 / self.k_O,
            "gamma_T": math.sqrt(2.0) / self.k_T,
            "K_O": self.k_O,
            "K_T": self.k_T,
        }

    def disturbance_bounds(self) -> tuple[float, float]:
        """sqrt(2) / K_O and 1 / K_T [s]."""
        return math.sqrt(2.0) / self.k_O, 1.0 / self.k_T


def correction(x_e: Floats, gains: GammaGains) -> Floats:
    """The twist [-K_O Im(r_e); -K_T p_e] (..., 6) for an error x_e = r_e + eps p_e r_e / 2."""
    u = np.empty((*x_e.shape[:-1], 6))
    u[..., :3] = -gains.k_O * x_e[..., 1:4]
    u[..., 3:] = -gains.k_T * dq.translation(x_e)
    return u


@controller("hinf-set", source="Pereira 2016, HIR [3.30]", gains=GammaGains)
def hinf_set(seen: Seen, gains: GammaGains) -> Floats:
    """H-infinity for set points: bounds what disturbances do; lags when moving.

    q_dot = J_w^+ [-K_O Im(r_e); -K_T p_e], with x_e = x x_d*.

    With a disturbance v = [v_w; v_t] added to the twist and no error to begin with,
    ||1 - r_e||_2 <= (sqrt(2) / K_O) ||v_w||_2 and ||p_e||_2 <= (1 / K_T) ||v_t||_2 (L2 in time).
    """
    return correction(spatial_error(seen.pose, seen.pose_d), gains)

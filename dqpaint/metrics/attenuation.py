"""Track -> the gain from an unmodelled twist to the error, and the bound the gains guarantee.

Pereira 2016, 3.3: for x_dot = 1/2 (xi + v) x and no error to begin with, the H-infinity laws keep
||1 - r_e||_2 <= (sqrt(2) / K_O) ||v_w||_2 and ||p_e||_2 <= (1 / K_T) ||v_t||_2, norms in time.
In discrete time this holds for K T <= 1.
"""

from dataclasses import dataclass

import numpy as np

from dqpaint import dq
from dqpaint.controllers.base import spatial_error
from dqpaint.dq import Floats
from dqpaint.simulation import Track


@dataclass(frozen=True)
class Attenuation:
    """The ratio of error to disturbance [s], in rotation or in translation.

    Attributes:
        ratio: norm of the error over the norm of the disturbance.
        bound: the largest ratio that the gains guarantee; None where the law guarantees none.
    """

    ratio: float
    bound: float | None

    @property
    def bound_holds(self) -> bool | None:
        """Whether the ratio is within the bound; None where there is none."""
        return None if self.bound is None else self.ratio <= self.bound


def attenuation(track: Track, bounds: tuple[float, float] | None) -> dict[str, Attenuation]:
    """Rotation and translation, each where the disturbance is not zero.

    The disturbance from row k to row k + 1 shows in the error of row k + 1.

    Args:
        track: of a run.
        bounds: bounds [s] for rotation and translation, from the gains.
    """
    v = track.disturbance[:-1]
    x_e = spatial_error(track.pose[1:], track.motion.pose[1:])
    parts = {
        "rotation": (dq.rotation(x_e) - dq.rotation(dq.IDENTITY), v[:, :3]),
        "translation": (dq.translation(x_e), v[:, 3:]),
    }
    return {
        name: Attenuation(_norm(error) / _norm(cause), bound)
        for (name, (error, cause)), bound in zip(parts.items(), bounds or (None, None), strict=True)
        if cause.any()
    }


def _norm(signal: Floats) -> float:
    """The L2 norm in time, but for the square root of the period, which cancels."""
    largest = float(np.abs(signal).max(initial=0.0))
    if largest == 0.0:
        return 0.0
    return largest * float(np.sqrt(((signal / largest) ** 2).sum()))  # no square leaves the floats

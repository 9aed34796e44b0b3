"""H-infinity tracking law with a remembered side of the double cover, after Kussaba."""

from typing import ClassVar

import numpy as np
from pydantic import Field

from dqpaint.controllers.base.arm import Arm
from dqpaint.controllers.base.controller import controller
from dqpaint.controllers.base.gain_schedule import Schedule
from dqpaint.controllers.base.gains import WHOLE_RUN, Gain, Gains
from dqpaint.controllers.base.pose_errors import (
    POINT_HELP,
    Point,
    error_vector,
    spatial_error,
    tracking_command,
)
from dqpaint.controllers.base.seen import Seen
from dqpaint.controllers.base.signs import DEFAULT_DELTA, Delta, Hysteresis
from dqpaint.dq import Floats
from dqpaint.motion import Motion


class HybridGains(Gains):
    """A rate for rotation, one for translation, and when the side changes."""

    constant: ClassVar[dict[str, str]] = {"delta": WHOLE_RUN, "point": WHOLE_RUN}

    K_O: Gain = Field(40.0, description="1/s, a small rotation error decays at K_O / 2")
    K_T: Gain = Field(20.0, description="1/s, a translation error decays at K_T")
    delta: Delta = Field(
        DEFAULT_DELTA,
        description="how far eta, the scalar part of r_e, may fall below 0 before the side changes",
    )
    point: Point = Field("base", description=POINT_HELP)


@controller(
    "hybrid", source="Kussaba 2017, after Mayhew 2011; feed-forward ours", gains=HybridGains,
    heeds_sign=False,
)  # fmt: skip
class Hybrid:
    """H-infinity with hysteresis: no measurement error holds it half a turn away; does not lag.

    Equation:
        q_dot = J_w^+ ([-h K_O Im(r_e); -K_T p_e] + Ad(x_e) xi_d)
        x_e = x x_d^* = r_e + eps 1/2 p_e r_e
        h = -h "where" h eta < -delta
    Idea:
        Half a turn away two ways home are equally long. A law that takes the shorter one anew at
        each step can be held there: by a measurement that errs, each time, to the other side. This
        one remembers its way, h, and leaves it only for one that is clearly shorter.

    Error:
        about the base's origin, as in hinf, or with point=tool at the tool: it is hinf with
        --sign hysteresis.
    Stable:
        From every error. V = 2 (1 - h eta) + 1/2 |p_e|^2: along the way V_dot = -K_O |Im(r_e)|^2 -
        K_T |p_e|^2, and a change of h takes 4 |eta| > 4 delta from it, so there are at most
        V(0) / (4 delta) of them.
    Fails:
        It may turn up to 2 asin(delta) too far: 35 deg past half a turn with 0.3.
    Try:
        dqpaint draw half-turn --controller hybrid --disturb adversary=0.05
    """

    batched = True

    def start(self, _arm: Arm, _motion: Motion, gains: Schedule[HybridGains]) -> None:
        """Forget the side."""
        self._rule = Hysteresis(gains.first.delta)

    def __call__(self, seen: Seen, gains: HybridGains) -> Floats:
        """The twist (..., 6)."""
        seen = self._rule(seen)
        x_e = spatial_error(seen.pose, seen.pose_d, seen.signed)
        rates = np.repeat([gains.K_O, gains.K_T], 3)
        u = -rates * error_vector(x_e, seen, gains.point)
        return tracking_command(u, x_e, seen, gains.point)

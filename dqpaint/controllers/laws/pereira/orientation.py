"""Control of the tool's orientation alone, after Pereira."""

from dqpaint.controllers.base.controller import controller
from dqpaint.controllers.base.matrices import times
from dqpaint.controllers.base.pose_errors import spatial_error
from dqpaint.controllers.base.seen import Seen
from dqpaint.controllers.laws.pereira.translation import PartGains
from dqpaint.dq import Floats
from dqpaint.robots.kinematics import resolve_part


@controller(
    "orientation", source="Pereira 2016, section 2.2.2", gains=PartGains, commands="rates",
    leaves_null=True, controls="orientation",
)  # fmt: skip
def orientation(seen: Seen, gains: PartGains) -> Floats:
    """The tool's orientation alone: its position goes where the arm takes it.

    Equation:
        q_dot = J_r^+ (-2 K Im(r_e) + "feed_forward" w_d)
        r_e = r r_d^*
        w = J_r q_dot
    Idea:
        The upper half of the Jacobian, without the lower one. r_dot = 1/2 w r, so -2 K Im(r_e) is
        the nearest angular velocity to vec(r_dot) = 1/2 H_minus(r) K vec(r_d - r) for a number K.
        The light wanders: this is a law to look at, and part of others.

    Error:
        of the orientation, the same wherever it is taken.
    Stable:
        At a set point, for K = K' > 0: with eta the scalar part of r_e, 1 - eta falls; a small
        error decays at K. Held for a period T it needs k T < 2.
    Fails:
        As a law for drawing: the position error has no law. At half a turn two ways are equally
        short. Moving, it lags by the angular speed / k unless feed_forward=1.
    Try:
        dqpaint draw helicoid --controller orientation --gain feed_forward=1
    """
    r_e = spatial_error(seen.pose, seen.pose_d, seen.signed)[..., 1:4]
    ahead = gains.feed_forward * seen.twist_d[..., :3]
    return resolve_part(seen.jacobian[..., :3, :], ahead - 2.0 * times(gains.k, r_e))

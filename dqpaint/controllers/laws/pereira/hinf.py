"""H-infinity tracking law in the dual-quaternion group, after Pereira."""

from dqpaint.controllers.base.controller import controller
from dqpaint.controllers.base.pose_errors import error_vector, spatial_error, tracking_command
from dqpaint.controllers.base.seen import Seen
from dqpaint.controllers.laws.pereira.hinf_set import PAPER, PAPER_SOURCE, GammaGains, correction
from dqpaint.dq import Floats


@controller(
    "hinf", source="Pereira 2016, HIRT [3.33]", gains=GammaGains,
    paper=PAPER, paper_source=PAPER_SOURCE,
)  # fmt: skip
def hinf(seen: Seen, gains: GammaGains) -> Floats:
    """H-infinity with feed-forward: bounds what disturbances do, does not lag.

    Equation:
        q_dot = J_w^+ ([-K_O Im(r_e); -K_T p_e] + Ad(x_e) xi_d)
        x_e = x x_d^* = r_e + eps 1/2 p_e r_e
    Idea:
        The set-point law hinf-set, and on top of it the reference's own twist, carried to where
        the tool is. As x_e_dot = 1/2 (xi - Ad(x_e) xi_d) x_e, the error does not know that the
        reference moves: it obeys the set-point law's equation, and its bounds hold on the way.

    Error:
        about the base's origin: p_e = t - R_e t_d, so a tool that is turned wrongly makes a bow
        on its way to a set point, and the farther from the base, the larger; point=tool takes
        t - t_d and feeds the tool's own velocity forward: no bow, and the bound is that of t - t_d.
    Stable:
        As hinf-set, also while the reference moves: a small rotation error decays at K_O / 2,
        p_e at K_T, from any error short of half a turn.
    Fails:
        Where the bound of hinf-set does: springs, delays, limits, K_T T > 1. Near zero it turns
        at half of K_O: K_O = 2 K_T is the same rate for both.
    Try:
        dqpaint compare step --controllers "hinf,hinf(point=tool)" --plants ideal
    """
    x_e = spatial_error(seen.pose, seen.pose_d, seen.signed)
    u = correction(error_vector(x_e, seen, gains.point), gains)
    return tracking_command(u, x_e, seen, gains.point)

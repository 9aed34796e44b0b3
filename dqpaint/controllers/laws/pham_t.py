"""Transpose law on the difference of dual quaternions, after Pham."""

from typing import ClassVar

import numpy as np
from pydantic import Field

from dqpaint import dq
from dqpaint.controllers.base.controller import controller
from dqpaint.controllers.base.gains import WHOLE_RUN, Gains
from dqpaint.controllers.base.matrices import Gain8, times
from dqpaint.controllers.base.pose_errors import POINT_HELP, Point, difference_error
from dqpaint.controllers.base.seen import Seen
from dqpaint.controllers.laws.pham import to_tool
from dqpaint.dq import Floats
from dqpaint.robots.kinematics import pose_map


class TransposeGains(Gains):
    """One gain or a matrix; the rates that follow depend on the arm and its posture.

    On the iiwa s^2 is at most 1.45 in any posture: 60 is stable up to a period of 20 ms, with room,
    and does not even overshoot at 8 ms. The weakest mode before the canvas then has 0.5 1/s.
    """

    constant: ClassVar[dict[str, str]] = {"point": WHOLE_RUN}

    k: Gain8 = Field(
        60.0,
        description="1/s, a small error decays at k s^2 in the mode with singular value s of J8; a "
        "number, a diagonal of 8 or a symmetric matrix 8 x 8",
    )
    point: Point = Field("base", description=POINT_HELP)


@controller(
    "pham-t", source="Pham 2010, transpose [29]", gains=TransposeGains, commands="rates",
    leaves_null=True,
)  # fmt: skip
def pham_t(seen: Seen, gains: TransposeGains) -> Floats:
    """Transposed Jacobian: no inverse, so singularities do no harm; slow in its weak modes.

    Equation:
        q_dot = J_8' K e
        e = vec(x_d - x)
        vec(x_dot) = J_8 q_dot
    Idea:
        As if a spring pulled each of the eight numbers, and the joints gave way to it: the joint
        rates are those of the steepest descent of 1/2 e' K e. Nothing is inverted. J_8' e has
        nothing in the null space; what `--null` adds there is projected by an inverse.

    Error:
        about the base's origin, as printed; point=tool puts the origin where the tool should be,
        so that other modes are the weak ones.
    Stable:
        At a set point, for K = K' > 0: V = 1/2 e' K e never grows, V_dot = -|J_8' K e|^2. A mode
        with singular value s of J_8 decays at k s^2, and held for a period T the fastest one
        needs k s^2 T < 2.
    Fails:
        In its weak modes, a hundred times slower than the strong ones. J_8 J_8' has rank 6 of 8:
        V_dot is not negative definite, and the proof of global stability does not hold as printed.
    Try:
        dqpaint draw step --controller pham-t --null none --plant ideal
    """
    pose, pose_d, jacobian = seen.pose, seen.pose_d, seen.jacobian
    if gains.point == "tool":
        home = to_tool(pose_d)
        pose, pose_d = dq.mul(home, pose), dq.mul(home, pose_d)
        jacobian = dq.adjoint(home[..., None, :], jacobian.mT).mT
    error = difference_error(pose, pose_d, seen.signed)
    along = np.vecmat(times(gains.k, error), pose_map(pose))  # J8' = J_w' M'
    return np.asarray(np.vecmat(along, jacobian))

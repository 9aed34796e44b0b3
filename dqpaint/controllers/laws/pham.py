"""Proportional law on the difference of dual quaternions, after Pham."""

from typing import ClassVar

import numpy as np
from pydantic import Field

from dqpaint import dq
from dqpaint.controllers.base.controller import controller
from dqpaint.controllers.base.gains import WHOLE_RUN
from dqpaint.controllers.base.matrices import times
from dqpaint.controllers.base.pose_errors import (
    POINT_HELP,
    Point,
    difference_error,
    twist_of_pose_rate,
)
from dqpaint.controllers.base.seen import Seen
from dqpaint.controllers.laws.pereira.p import EightGains
from dqpaint.dq import Floats


class DifferenceGains(EightGains):
    """The gain of the difference, and about which point it is formed."""

    constant: ClassVar[dict[str, str]] = {"point": WHOLE_RUN}

    point: Point = Field("base", description=POINT_HELP)


@controller("pham", source="Pham 2010, pseudo-inverse [25]", gains=DifferenceGains)
def pham(seen: Seen, gains: DifferenceGains) -> Floats:
    """Proportional on the plain difference x_d - x: lags when moving.

    Equation:
        q_dot = J_8^+ K e
        e = vec(x_d - x)
        vec(x_dot) = J_8 q_dot
    Idea:
        The eight numbers of the pose are asked to go straight to those of the reference, each
        at the rate k. The straight line leaves the unit dual quaternions; J_8^+ finds the
        joint rates that come nearest to it.

    Error:
        about the base's origin, as printed: half of t_d r_d - t r; point=tool puts the origin of
        both poses where the tool should be, and so changes how the eight numbers are weighed.
    Stable:
        At a set point, for K = K' > 0: V = 1/2 e' K e falls, V_dot = -|P K e|^2, with P the
        projector on the range of J_8. That has rank 6 of 8, so V_dot is not negative definite:
        what is left over is of second order. Held for a period T it needs k T < 2.
    Fails:
        On a moving light it lags by speed / k. The claim of global stability does not hold as it
        is printed: V_dot <= 0 only.
    Try:
        dqpaint compare step --controllers pham,p --plants ideal
    """
    pose, pose_d, tool = seen.pose, seen.pose_d, gains.point == "tool"
    if tool:
        home = to_tool(pose_d)
        pose, pose_d = dq.mul(home, pose), dq.mul(home, pose_d)
    u = twist_of_pose_rate(pose, times(gains.k, difference_error(pose, pose_d, seen.signed)))
    return dq.adjoint(dq.conj(home), u) if tool else u


def to_tool(pose_d: Floats) -> Floats:
    """The displacement (..., 8) that puts the origin where a tool should be."""
    p = -dq.translation(pose_d)
    return dq.pose_from(p, np.broadcast_to(dq.rotation(dq.IDENTITY), (*p.shape[:-1], 4)))

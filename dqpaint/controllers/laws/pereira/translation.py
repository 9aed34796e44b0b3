"""Control of the tool's position alone, after Pereira."""

from pydantic import Field

from dqpaint import dq
from dqpaint.controllers.base.controller import controller
from dqpaint.controllers.base.gains import Gains
from dqpaint.controllers.base.matrices import Gain3, times
from dqpaint.controllers.base.seen import Seen
from dqpaint.dq import Floats
from dqpaint.robots.kinematics import CHARACTERISTIC_LENGTH, resolve_part, tool_jacobian_map


class PartGains(Gains):
    """A rate, and whether the law looks ahead."""

    k: Gain3 = Field(
        20.0,
        description="1/s, the rate at which the error decays: a number, a diagonal of 3 or a "
        "symmetric matrix 3 x 3",
    )
    feed_forward: float = Field(
        0.0, ge=0.0, le=1.0, allow_inf_nan=False,
        description="share of the reference's own velocity that is added; the thesis has none",
    )  # fmt: skip


@controller(
    "translation", source="Pereira 2016, section 2.2.2", gains=PartGains, commands="rates",
    leaves_null=True, controls="position",
)  # fmt: skip
def translation(seen: Seen, gains: PartGains) -> Floats:
    """The tool's position alone: its orientation goes where the arm takes it.

    Equation:
        q_dot = J_p^+ (K (t_d - t) + "feed_forward" t_d_dot)
        t_dot = J_p q_dot
    Idea:
        Three numbers are asked of the arm instead of six: a point light needs no orientation.
        The joints move as little as they can, and an arm of seven keeps four freedoms.

    Error:
        at the tool: t_d - t.
    Stable:
        At a set point, for K = K' > 0, from any distance within reach: t_d - t decays at K. Held
        for a period T it needs k T < 2.
    Fails:
        For every brush that is not a point: the orientation error has no law and grows. Moving, it
        lags by speed / k unless feed_forward=1.
    Try:
        dqpaint compare star --controllers translation,p --robot viper850
    """
    J_p = (tool_jacobian_map(dq.translation(seen.pose)) @ seen.jacobian)[..., 3:, :]
    error = dq.translation(seen.pose_d) - dq.translation(seen.pose)
    ahead = dq.point_velocity(seen.twist_d, dq.translation(seen.pose_d))
    wanted = times(gains.k, error) + gains.feed_forward * ahead
    return resolve_part(J_p, wanted / CHARACTERISTIC_LENGTH)

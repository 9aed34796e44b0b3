"""The text of a sign rule -> which of x_d and -x_d, one and the same pose, a law goes to.

    nearest                 the one on the side of the measured pose: the short way round
    hysteresis[,delta=0.3]  remembers its side until the other is clearly nearer
    none                    the signs as they come

Nearest decides anew at each step: near half a turn a measurement that errs to the other side each
time can hold the tool for ever. With h the remembered side and eta the scalar part of r r_d^*,

    h eta >= -delta: the law, with h x_d        h eta < -delta: h becomes -h,

at most V(0) / (4 delta) times with V = 2 (1 - h eta), as each change takes 4 h eta from it: an
error of the measurement that moves eta by less than delta never causes a second one. (Mayhew,
Sanfelice and Teel, "Quaternion-based hybrid control for robust global attitude tracking", 2011;
Kussaba and others, "Hybrid kinematic control for rigid body pose stabilization using dual
quaternions", 2017.)
"""

from collections.abc import Callable
from functools import partial
from typing import Annotated

import numpy as np
from pydantic import BaseModel, ConfigDict, Field

from dqpaint import dq
from dqpaint.controllers.base.seen import Seen
from dqpaint.core import make_choice, read_choice
from dqpaint.dq import Floats
from dqpaint.errors import UnknownNameError, UsageError

DEFAULT_SIGN = "nearest"
DEFAULT_DELTA = 0.3
Delta = Annotated[float, Field(gt=0, lt=1, allow_inf_nan=False)]
SignRule = Callable[[Seen], Seen]
"""What a law sees -> the same, `pose_d` with the sign that the rule chose; it may remember."""


class _Values(BaseModel):
    model_config = ConfigDict(extra="forbid", defer_build=True)
    delta: Delta = DEFAULT_DELTA


class Hysteresis:
    """The side of the last step, until the other is nearer by more than `delta`; of many arms, too.

    The measured pose has an arbitrary sign; what is kept is r r_d^* with the chosen one, which
    moves little in a step.
    """

    def __init__(self, delta: float) -> None:
        self._delta = delta
        self._before: Floats | None = None

    def __call__(self, seen: Seen) -> Seen:
        """The goal on the chosen side."""
        goal = dq.nearest(seen.pose_d, seen.pose)
        r_e = dq.quaternion_mul(seen.pose[..., :4], goal[..., :4] * dq.C4)
        if self._before is not None:
            other = (r_e * self._before).sum(-1, keepdims=True) < 0
            side = np.where(other & (r_e[..., :1] <= self._delta), -1.0, 1.0)
            goal, r_e = side * goal, side * r_e
        self._before = r_e
        return seen._replace(pose_d=goal, signed=True)


def _as_it_comes(seen: Seen) -> Seen:
    return seen._replace(signed=True)


def read_sign(text: str) -> Callable[[], SignRule] | None:
    """What makes the sign rule of a run; None for the nearest side, which laws take by themselves.

    Raises:
        UsageError: an unknown rule, or no such value.
    """
    name, values = read_choice("sign", text, f"hysteresis,delta={DEFAULT_DELTA:g}")
    if name == "hysteresis":
        return partial(Hysteresis, make_choice("sign", name, _Values, values).delta)
    fixed: dict[str, Callable[[], SignRule] | None] = {
        "nearest": None, "none": lambda: _as_it_comes,
    }  # fmt: skip
    if name not in fixed:
        raise UnknownNameError("sign", name, [*fixed, "hysteresis"])
    if values:
        raise UsageError(f"sign '{name}' takes no values")
    return fixed[name]

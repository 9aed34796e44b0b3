"""H-infinity set-point law in the dual-quaternion group, after Pereira."""

import math
from typing import Annotated, ClassVar, Self

import numpy as np
from pydantic import Field, model_validator

from dqpaint.controllers.base.controller import controller
from dqpaint.controllers.base.gains import WHOLE_RUN, Gain, Gains
from dqpaint.controllers.base.matrices import Value, least_eigenvalue, sized, times
from dqpaint.controllers.base.pose_errors import (
    POINT_HELP,
    Point,
    command_about,
    error_vector,
    spatial_error,
)
from dqpaint.controllers.base.seen import Seen
from dqpaint.dq import Floats

GainMatrix = Annotated[Value, sized(3, symmetric=False)]  # the proof needs K + K' alone
PAIR = "s, in place of {}: for {} alone"
MATRIX = "1/s, in place of {}: a number, a diagonal of 3 or a matrix 3 x 3"


class GammaGains(Gains):
    """How much of a disturbance may come through, apart for rotation and translation.

    Two gammas each, for the twist v_w of the arm and the twist v_c of its uncertain pose: k_O =
    sqrt(2) sqrt(gamma_O1^-2 + gamma_O2^-2), k_T = sqrt(gamma_T1^-2 + gamma_T2^-2) (theorem 3.1); of
    one alone the other is infinite, nothing is asked of it.
    With equal ones [5.5, 5.6]: k_O = 2 / gamma_O and k_T = sqrt(2) / gamma_T. The thesis lets the
    gains grow over a drawing (5.9), so each may be given instead of its gammas: K_O=2.8..5.3@10%.
    """

    constant: ClassVar[dict[str, str]] = {"point": WHOLE_RUN}

    gamma_O: Gain = Field(0.05, description="s, bound on the rotation error; K_O = 2 / gamma_O")
    gamma_T: Gain = Field(
        0.0707, description="s, bound on the translation error; K_T = sqrt(2) / gamma_T"
    )
    K_O: GainMatrix | None = Field(None, description=MATRIX.format("gamma_O"))
    K_T: GainMatrix | None = Field(None, description=MATRIX.format("gamma_T"))
    gamma_O1: Gain | None = Field(None, description=PAIR.format("gamma_O", "twists v_w"))
    gamma_O2: Gain | None = Field(None, description=PAIR.format("gamma_O", "uncertain poses, v_c"))
    gamma_T1: Gain | None = Field(None, description=PAIR.format("gamma_T", "twists v_w"))
    gamma_T2: Gain | None = Field(None, description=PAIR.format("gamma_T", "uncertain poses, v_c"))
    point: Point = Field("base", description=POINT_HELP)

    @model_validator(mode="after")
    def _one_of_each(self) -> Self:
        for part in ("O", "T"):
            pair = {f"gamma_{part}1", f"gamma_{part}2"}
            given = [{f"gamma_{part}"}, {f"K_{part}"}, pair]
            if sum(bool(one & self.model_fields_set) for one in given) > 1:
                raise ValueError(
                    f"takes gamma_{part} or K_{part} or gamma_{part}1 and gamma_{part}2, not two"
                )
        return self

    @property
    def k_O(self) -> Value:  # noqa: N802  the paper's letters
        """Rotation gain [1/s]; a small rotation error decays at k_O / 2."""
        pair = _together(self.gamma_O1, self.gamma_O2)
        if self.K_O is not None or pair is None:
            return 2.0 / self.gamma_O if self.K_O is None else self.K_O
        return math.sqrt(2.0) * pair

    @property
    def k_T(self) -> Value:  # noqa: N802
        """Translation gain [1/s]; a translation error decays at k_T."""
        pair = _together(self.gamma_T1, self.gamma_T2)
        if self.K_T is not None or pair is None:
            return math.sqrt(2.0) / self.gamma_T if self.K_T is None else self.K_T
        return pair

    @property
    def error_point(self) -> Point:
        """Where the error is that its bounds are about."""
        return self.point

    def as_dict(self) -> dict[str, Value | str]:
        """Gammas and gains, those given and those that follow from them."""
        shown: dict[str, Value | str] = {}
        for part, gain, size in (("O", self.k_O, 2.0), ("T", self.k_T, math.sqrt(2.0))):
            pair = {f"gamma_{part}{i}": getattr(self, f"gamma_{part}{i}") for i in (1, 2)}
            given = {name: one for name, one in pair.items() if one is not None}
            shown |= given or {f"gamma_{part}": size / least_eigenvalue(gain)}
        return {**shown, "K_O": self.k_O, "K_T": self.k_T, "point": self.point}

    @property
    def bounded_in_steps(self) -> bool:
        """Whether both gains are numbers, and the error is at the base's origin."""
        return np.ndim(self.k_O) == np.ndim(self.k_T) == 0 and self.point == "base"

    @property
    def gammas(self) -> tuple[tuple[float, float], tuple[float, float]]:
        """The gammas of (3.26), those not given infinite; of gains alone equal pairs."""
        pairs = (self.gamma_O1, self.gamma_O2), (self.gamma_T1, self.gamma_T2)
        equal = 2.0 / least_eigenvalue(self.k_O), math.sqrt(2.0) / least_eigenvalue(self.k_T)
        turning, moving = (
            (one, one) if pair == (None, None) else (pair[0] or math.inf, pair[1] or math.inf)
            for pair, one in zip(pairs, equal, strict=True)
        )
        return turning, moving

    def disturbance_bounds(self) -> tuple[float, float]:
        """sqrt(2) / K_O and 1 / K_T [s], of a matrix by its least eigenvalue."""
        return math.sqrt(2.0) / least_eigenvalue(self.k_O), 1.0 / least_eigenvalue(self.k_T)


def _together(first: float | None, second: float | None) -> float | None:
    """sqrt(gamma_1^-2 + gamma_2^-2) [1/s] of those that are given, if any is."""
    given = [1.0 / one for one in (first, second) if one is not None]
    return math.hypot(*given) if given else None


def correction(e: Floats, gains: GammaGains) -> Floats:
    """The command [-K_O Im(r_e); -K_T p] (..., 6) for an error [Im(r_e); p]."""
    u = np.empty_like(e)
    u[..., :3] = -times(gains.k_O, e[..., :3])
    u[..., 3:] = -times(gains.k_T, e[..., 3:])
    return u


PAPER = {"gamma_T": 0.372, "gamma_O": 0.377}
PAPER_SOURCE = "the best gammas of its section 5.7, at 8 ms; there the gains grow towards them"


@controller(
    "hinf-set", source="Pereira 2016, HIR [3.30]", gains=GammaGains,
    paper=PAPER, paper_source=PAPER_SOURCE,
)  # fmt: skip
def hinf_set(seen: Seen, gains: GammaGains) -> Floats:
    """H-infinity for set points: bounds what disturbances do; lags when moving.

    Equation:
        q_dot = J_w^+ [-K_O Im(r_e); -K_T p_e]
        x_e = x x_d^* = r_e + eps 1/2 p_e r_e
        K_O = sqrt(2) sqrt(gamma_O1^-2 + gamma_O2^-2)
        K_T = sqrt(gamma_T1^-2 + gamma_T2^-2)
        ||1 - r_e||_2 <= gamma_O1 ||v_w||_2 + gamma_O2 ||v_c||_2
        ||p_e||_2 <= gamma_T1 ||v_t||_2 + gamma_T2 ||v_c||_2
    Idea:
        How far the tool is turned and how far it is away are sent home separately. The gains
        follow from how much of a disturbance may be left in the error: v_w, v_t a twist on
        top of the arm's own, v_c the twist of an unknown displacement that the law sees.

    Error:
        about the base's origin: p_e = t - R_e t_d, so a tool that is turned wrongly makes a bow
        on its way to a set point, and the farther from the base, the larger; point=tool takes
        t - t_d, goes straight, and bounds that.
    Stable:
        V = 2 (1 - eta) + 1/2 |p_e|^2 falls from any error short of half a turn: a small rotation
        error decays at K_O / 2, p_e at K_T. A matrix needs K + K' > 0; its bounds are those
        of its least eigenvalue. With no error to begin with, ||1 - r_e||_2 <= sqrt(2) / K_O
        ||v_w||_2 and ||p_e||_2 <= 1 / K_T ||v_t||_2, norms in time.
    Fails:
        On a moving light it lags by speed / K_T. The bound is one of continuous time, of an arm
        without limits or springs: held for a period T it needs K_T T <= 1, and where rotation and
        translation are disturbed together it may be passed even then.
    Try:
        dqpaint compare step --controllers "hinf-set,hinf-set(point=tool)" --plants ideal
    """
    e = error_vector(spatial_error(seen.pose, seen.pose_d, seen.signed), seen, gains.point)
    return command_about(correction(e, gains), seen, gains.point)

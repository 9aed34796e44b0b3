"""Track -> the gain from an unmodelled twist to the error, and the bound the gains guarantee.

Pereira 2016, 3.3: for x_dot = 1/2 (xi + v) x and no error to begin with, the H-infinity laws keep
||1 - r_e||_2 <= (sqrt(2) / K_O) ||v_w||_2 and ||p_e||_2 <= (1 / K_T) ||v_t||_2, norms in time.
In steps of a period the bounds are those of `bounds_in_steps`.
"""

import math
from dataclasses import dataclass

import numpy as np

from dqpaint import dq
from dqpaint.controllers.base import Point, spatial_error
from dqpaint.dq import Floats
from dqpaint.simulation import Track

PROVED, TESTED = 2.0, 3.0  # K_O T up to which the bound of rotation is proved, and was tested
Bounds = tuple[float, float]


@dataclass(frozen=True)
class Attenuation:
    """The ratio of error to disturbance [s], in rotation or in translation.

    Attributes:
        ratio: norm of the error over the norm of the disturbance.
        bound: the largest ratio that the gains guarantee in continuous time; None where the law
            guarantees none.
        in_steps: the same in steps of the run's period, with the turns that it made; None where
            there is none: the gain is too high for the period, or it changed.
        void: whether the bound says nothing of this run: it is of an arm that follows its commands
            at once, without springs or servo loops between.
        of_gammas: the error's norm as a part of gamma_1 ||v_w|| + gamma_2 ||v_c|| of (3.26), which
            the law keeps below 1; None where it promises nothing, or its gains changed.
    """

    ratio: float
    bound: float | None
    in_steps: float | None = None
    void: bool = False
    of_gammas: float | None = None

    @property
    def bound_holds(self) -> bool | None:
        """Whether the ratio is within the bound; None where there is none, or it says nothing."""
        return None if self.bound is None or self.void else self.ratio <= self.bound


def attenuation(
    track: Track,
    bounds: Bounds | None,
    stepped: bool = True,
    void: bool = False,
    point: Point = "base",
    gammas: tuple[Bounds, Bounds] | None = None,
) -> dict[str, Attenuation]:
    """Rotation and translation, each where the disturbance is not zero.

    The disturbance from row k to row k + 1 shows in the error of row k + 1.

    Args:
        track: of a run.
        bounds: bounds [s] for rotation and translation, from the gains.
        stepped: whether the bounds in steps hold: of gains that are numbers and do not change.
        void: whether the arm does not follow its commands at once.
        point: where the law takes its error; at the `tool` p_e is t - t_d, v_t the tool's velocity.
        gammas: (gamma_O1, gamma_O2) and (gamma_T1, gamma_T2) [s] that the law promises.
    """
    x_e = spatial_error(track.pose, track.motion.pose)
    v_w, v_c, p_e = track.disturbance[:-1], track.pose_disturbance[:-1], dq.translation(x_e)
    if point == "tool":
        places = dq.translation(track.pose)
        v_w, v_c = (_at(places[:-1], v) for v in (v_w, v_c))
        p_e = places - dq.translation(track.motion.pose)
    v = v_w + v_c  # of (3.29)
    of_steps: tuple[float | None, float | None] = (None, None)
    if bounds and stepped and len(v):
        of_steps = bounds_in_steps(bounds, track.motion.period, largest_turn(x_e))
    parts = {
        "rotation": (dq.rotation(x_e[1:]) - dq.rotation(dq.IDENTITY), v[:, :3]),
        "translation": (p_e[1:], v[:, 3:]),
    }
    promised: list[float | None] = [None, None]
    if gammas:
        halves = (slice(0, 3), slice(3, 6))
        for i, ((first, second), half) in enumerate(zip(gammas, halves, strict=True)):
            promised[i] = _weighed(first, v_w[:, half]) + _weighed(second, v_c[:, half])
    known = zip(parts.items(), bounds or (None, None), of_steps, promised, strict=True)
    return {
        name: Attenuation(
            _norm(error) / _norm(cause),
            bound,
            in_steps,
            void,
            _norm(error) / most if most else None,
        )
        for (name, (error, cause)), bound, in_steps, most in known
        if cause.any()
    }


def _at(points: Floats, twist: Floats) -> Floats:
    """Twists (N, 6) as [w; the velocity of points (N, 3)]."""
    return np.concatenate([twist[:, :3], dq.point_velocity(twist, points)], axis=1)


def _weighed(gamma: float, signal: Floats) -> float:
    """Gamma ||v||, 0 of no signal though gamma is infinite."""
    return gamma * _norm(signal) if signal.any() else 0.0


def largest_turn(x_e: Floats) -> float:
    """The largest angle [rad] by which errors x x_d* (N, 8) turn from one row to the next."""
    cosines = np.abs((dq.rotation(x_e[1:]) * dq.rotation(x_e[:-1])).sum(axis=-1))
    return 2 * math.acos(min(1.0, float(cosines.min(initial=1.0))))


def bounds_in_steps(
    bounds: Bounds, period: float, turn: float
) -> tuple[float | None, float | None]:
    """The bounds of the H-infinity laws where a twist is held for a period, as it is in a run.

    For x_e(k+1) = exp(T (u + v) / 2) x_e(k), which an arm is whose tool carries out its twist and
    whose reference stands still. K_T and K_O do not change; no error to begin with.

    *Translation.* With a turn phi a step, the part of p_e across its axis goes on as e^(i phi / 2)
    ((e^(i phi / 2) - K T s) p_e + T s v_t), s = sin(phi / 2) / (phi / 2), the part along it as
    (1 - K T) p_e + T v_t. So |p_e(k+1)| <= r |p_e(k)| + T |v_t(k)|, where r is the larger of
    |1 - K T| and sqrt(1 - 2 K T sin(phi) / phi + (K T s)^2), which grows with phi up to pi for
    K T <= 2; and ||p_e||_2 <= T / (1 - r) ||v_t||_2. Without turns that is 1 / K up to K T = 1.

    *Rotation.* With S = (8 / (K T) - 2) (1 - Re r_e) >= 0 for K T <= 4, a step by any w has
    S(k+1) - S(k) <= 2 |v_w|^2 / K^2 - |1 - r_e(k+1)|^2: right less left is, in units of
    8 / (K T)^2 and with d = T |w| / 2 and Re of r_e(k),
    (K T)^2 / 4 Re (1 - Re) + d^2 + K T (a (d - sin d) - Re (1 - cos d)), where a^2 + Re^2 <= 1 and
    (d - sin d)^2 + (1 - cos d)^2 <= d^4 / 4: not below d^2 (1 - K T / 2). So the bound of
    continuous time holds for K_O T <= 2, whatever the turns. Beyond it, up to K_O T = 3,
    max(1, K T / (sqrt(2) (4 - K T))) times the bound was found to be its supremum by dynamic
    programming over turns about one axis.

    Args:
        bounds: sqrt(2) / K_O and 1 / K_T [s].
        period: T [s].
        turn: the largest turn phi in a period [rad].

    Returns:
        The bounds [s] for rotation and translation; None where none is known.
    """
    return _rotation_in_steps(bounds[0], period), _translation_in_steps(bounds[1], period, turn)


def _rotation_in_steps(bound: float, period: float) -> float | None:
    product = math.sqrt(2) / bound * period
    if product <= PROVED:
        return bound
    if product > TESTED:
        return None
    return bound * max(1.0, product / (math.sqrt(2) * (4 - product)))


def _translation_in_steps(bound: float, period: float, turn: float) -> float | None:
    product = period / bound
    if product > 2 or turn > math.pi:
        return None
    half, whole = np.sinc(turn / (2 * math.pi)), np.sinc(turn / math.pi)
    across = math.sqrt(max(0.0, 1 - 2 * product * whole + (product * half) ** 2))
    rate = max(abs(1 - product), across)
    return period / (1 - rate) if rate < 1 else None


def _norm(signal: Floats) -> float:
    """The L2 norm in time, but for the square root of the period, which cancels."""
    largest = float(np.abs(signal).max(initial=0.0))
    if largest == 0.0:
        return 0.0
    return largest * float(np.sqrt(((signal / largest) ** 2).sum()))  # no square leaves the floats

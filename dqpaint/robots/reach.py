"""From poses to postures: where an arm can begin a drawing so that it can go on to the end.

A redundant arm has many postures for the first pose. Each candidate follows the whole path on the
kinematic arm; the one that stays farthest from its joint limits is chosen.
"""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from dqpaint import dq
from dqpaint.dq import Floats
from dqpaint.robots.kinematics import Kinematics
from dqpaint.robots.resolver import PULL, resolve

CANDIDATES = 16
MORE_CANDIDATES = 160
WAYPOINTS = 32
EXACT = 1e-9  # [rad, m] from the pose where the arm begins, if it can be had
GOOD = 1e-5  # [rad, m] is good enough to begin there: the law takes up the rest
ON_THE_WAY = 1e-3  # [rad, m] is close enough for a forecast; farther off, a pose is missed
ITERATIONS = 16
DESCENT, GENTLE = 150, 0.2  # steps, and their part of a full one, towards a pose out of reach
TURN = 0.3  # [m] that count as much as a radian
EQUAL = np.radians(1.0)  # margins that differ by less count as equal
STEP = 0.6  # [rad] a joint moves at the most in one iteration
SEED = 1988


@dataclass(frozen=True)
class Start:
    """Where to begin, and what the forecast along the path says.

    Attributes:
        posture: (n,) [rad].
        margin: least distance to a joint limit along the path [rad]; negative beyond one.
    """

    posture: Floats
    margin: float


@dataclass(frozen=True)
class Miss:
    """A pose of the path for which no posture was found.

    Attributes:
        index: which of the asked poses.
        shortfall: how far the closest posture stays from it [m].
        turned: and by which angle [rad].
    """

    index: int
    shortfall: float
    turned: float

    @property
    def badness(self) -> float:
        """Distance and turn as one length [m]."""
        return self.shortfall + TURN * self.turned


Pull = Callable[[Floats, Floats, float], Floats]


def to_start(postures: Floats, starts: Floats, seconds: float) -> Floats:
    """How far a null space is pulled (M, n) [rad] in a time, from postures to where they began."""
    return np.asarray((1.0 - np.exp(-PULL * seconds)) * (starts - postures))


def find_start(
    kinematics: Kinematics, poses: Floats, seconds: Floats, pull: Pull = to_start
) -> Start | Miss:
    """The posture to begin with, for poses (N, 8) asked at times (N,) [s].

    A second, larger crowd of candidates is tried where the first one does not reach, or would
    end beyond a joint limit.

    Args:
        kinematics: of the arm.
        poses: to be reached one after another.
        seconds: when.
        pull: what the null space does meanwhile.
    """
    found = _find_start(kinematics, poses, seconds, CANDIDATES, pull)
    if isinstance(found, Start) and found.margin >= 0:
        return found
    again = _find_start(kinematics, poses, seconds, MORE_CANDIDATES, pull)
    if isinstance(again, Miss) and isinstance(found, Miss):
        return max(found, again, key=lambda miss: miss.index)
    return again if isinstance(again, Start) else found


def _find_start(
    kinematics: Kinematics, poses: Floats, seconds: Floats, candidates: int, pull: Pull
) -> Start | Miss:
    card = kinematics.card
    rng = np.random.default_rng(SEED)
    seeds = rng.uniform(card.lower, card.upper, (candidates - 1, card.joints))
    seeds = np.vstack([card.home, seeds])
    wish = np.zeros_like(seeds)
    inside = (card.lower, card.upper)
    postures, errors = solve(kinematics, poses[0], seeds, wish, EXACT, inside)
    reached = (errors < GOOD) & (_margins(kinematics, postures) >= 0)
    if reached.any():
        return _follow(kinematics, poses, seconds, postures[reached], pull)
    # close to a limit Newton's steps are cut short; a patient descent may still arrive
    miss, posture = _closest(kinematics, poses, 0, postures)
    if miss.badness < GOOD:
        return _follow(kinematics, poses, seconds, posture[None], pull)
    return miss


def waypoints(strokes: NDArray[np.int64]) -> NDArray[np.intp]:
    """Rows that stand for a path: evenly spread ones, and every first and last of a stroke."""
    n = len(strokes)
    even = np.linspace(0, n - 1, min(n, WAYPOINTS)).astype(np.intp)
    corners = np.flatnonzero(np.diff(strokes)) + 1
    if len(corners) > WAYPOINTS:
        corners = corners[np.linspace(0, len(corners) - 1, WAYPOINTS).astype(np.intp)]
    return np.unique(np.concatenate([even, corners]))


def _follow(
    kinematics: Kinematics, poses: Floats, seconds: Floats, starts: Floats, pull: Pull
) -> Start | Miss:
    """The best of the starts (M, n) by its least margin over the path."""
    postures, margin = starts.copy(), _margins(kinematics, starts)
    alive = np.arange(len(starts))
    before = seconds[0]
    for index in range(1, len(poses)):
        wish = pull(postures[alive], starts[alive], float(seconds[index] - before))
        before = seconds[index]
        moved, errors = solve(kinematics, poses[index], postures[alive], wish, ON_THE_WAY)
        reached = errors < ON_THE_WAY
        if not reached.any():
            return _closest(kinematics, poses, index, postures[alive])[0]
        alive = alive[reached]
        postures[alive] = moved[reached]
        margin[alive] = np.minimum(margin[alive], _margins(kinematics, postures[alive]))
    # an elbow limit is the same for all the postures of a redundant arm: of equals, the homeliest
    good = alive[margin[alive] >= margin[alive].max() - EQUAL]
    best = good[np.argmin(np.linalg.norm(starts[good] - kinematics.card.home, axis=1))]
    return Start(starts[best], float(margin[best]))


def _margins(kinematics: Kinematics, postures: Floats) -> Floats:
    card = kinematics.card
    return np.asarray(np.minimum(postures - card.lower, card.upper - postures).min(axis=-1))


def solve(
    kinematics: Kinematics,
    pose: Floats,
    postures: Floats,
    wish: Floats,
    close: float,
    within: tuple[Floats, Floats] | None = None,
) -> tuple[Floats, Floats]:
    """Newton's method from many postures (M, n) to one pose (8,), or to one each (M, 8).

    Returns the postures, and how far off each ended (M,).

    The first step takes the null-space motion `wish` (M, n) [rad] along; the last one ends when
    all are as `close` [rad, m] as asked, or after `ITERATIONS`. `within` are joint limits that no
    step may leave.
    """
    q = postures.copy()
    for iteration in range(ITERATIONS):
        x, J = kinematics.poses_and_jacobians(q)
        error = _error(pose, x)
        largest = np.abs(error).max(axis=1)
        if iteration and largest.max() < close:
            break
        step = resolve(J, dq.translation(x), error, wish)
        q += step * np.minimum(1.0, STEP / np.maximum(np.abs(step).max(axis=1), 1e-12))[:, None]
        if within is not None:
            q = np.clip(q, *within)
        wish = np.zeros_like(q)
    return q, largest


def _error(pose: Floats, x: Floats) -> Floats:
    """The displacement (M, 6) from poses x (M, 8) to one pose."""
    return 2 * dq.log(dq.mul(pose, dq.conj(x)))


def _closest(
    kinematics: Kinematics, poses: Floats, index: int, postures: Floats
) -> tuple[Miss, Floats]:
    """How close the arm comes to one of the poses, by descent inside its limits, and how.

    From the best few of some postures (M, n).
    """
    card = kinematics.card
    pose = poses[index]
    errors = np.abs(_error(pose, kinematics.poses_and_jacobians(postures)[0])).max(axis=1)
    q = np.clip(postures[np.argsort(errors)[:CANDIDATES]], card.lower, card.upper)
    best, posture = Miss(index, np.inf, 0.0), q[0]
    for _ in range(DESCENT):
        x, J = kinematics.poses_and_jacobians(q)
        error = _error(pose, x)
        far = np.linalg.norm(dq.translation(pose) - dq.translation(x), axis=1)
        turned = np.linalg.norm(error[:, :3], axis=1)
        i = int(np.argmin(far + TURN * turned))
        here = Miss(index, float(far[i]), float(turned[i]))
        if here.badness < best.badness:
            best, posture = here, q[i]
        step = GENTLE * resolve(J, dq.translation(x), error, np.zeros_like(q))
        q = np.clip(q + np.clip(step, -STEP, STEP), card.lower, card.upper)
    return best, posture

"""Poses of a drawing -> a start posture from which an arm can follow all of them.

A redundant arm has many postures for the first pose. Each candidate follows the whole path on the
kinematic arm; the one that stays farthest from its joint limits is chosen.
"""

from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from dqpaint import dq
from dqpaint.dq import Floats
from dqpaint.robots.kinematics.differential_ik import (
    CHARACTERISTIC_LENGTH,
    START_GAIN,
    damped_inverse_times,
    resolve_parts,
    tool_jacobian_map,
)
from dqpaint.robots.kinematics.kinematics import Kinematics

CANDIDATES = 16
MORE_CANDIDATES = 160
FEW_SEEDS, MANY_SEEDS = 4, 32  # postures from which a single pose is tried at first, and in the end
WAYPOINTS = 32
EXACT_ERROR = 1e-9  # [rad, m] from the pose where the arm begins, if it can be had
START_TOLERANCE = 1e-5  # [rad, m] is good enough to begin there: the law takes up the rest
PATH_TOLERANCE = 1e-3  # [rad, m] is close enough for a forecast; farther off, a pose is missed
ITERATIONS = 16
DESCENT_STEPS = 40  # steps towards a pose out of reach, with each of these weights
ORIENTATION_FIRST = (0.3, 1.0, 3.0, 10.0)  # [m/rad] weights of the orientation in a descent
POSITION_FIRST = (0.3, 0.1, 0.03, 0.01)
LONGEST_AIM = 0.05  # [m] ahead it is aimed: a place far off would be taken to lie where it does not
DESCENT_DAMPING = 0.02  # [m/rad] of these steps
MOST_RETRIES = 3  # times a step is worked out again with joints held at their limits
METRES_PER_RADIAN = 0.3  # [m] that count as much as a radian
EQUAL_MARGINS = np.radians(1.0)  # margins that differ by less count as equal
LARGEST_STEP = 0.6  # [rad] a joint moves at the most in one iteration
SEED = 1988


@dataclass(frozen=True)
class StartPosture:
    """A start posture and its margin along the path.

    Attributes:
        posture: (n,) [rad].
        margin: least distance to a joint limit along the path [rad]; negative beyond one.
    """

    posture: Floats
    margin: float


@dataclass(frozen=True)
class NoPosture:
    """A pose of the path without a posture that reaches it.

    Attributes:
        index: index of the pose.
        shortfall: how far the closest posture stays from it [m].
        angle: and by which angle [rad].
    """

    index: int
    shortfall: float
    angle: float

    @property
    def combined_error(self) -> float:
        """Distance and angle as one length [m]."""
        return self.shortfall + METRES_PER_RADIAN * self.angle


NullSpaceMotion = Callable[[Floats, Floats, float], Floats]


def return_to_start(postures: Floats, starts: Floats, seconds: float) -> Floats:
    """Null-space motion (M, n) [rad] in a time, from postures towards their start postures."""
    return np.asarray((1.0 - np.exp(-START_GAIN * seconds)) * (starts - postures))


def find_start(
    kinematics: Kinematics,
    poses: Floats,
    seconds: Floats,
    null_motion: NullSpaceMotion = return_to_start,
) -> StartPosture | NoPosture:
    """Find a start posture for poses (N, 8) at times (N,) [s].

    A second, larger crowd of candidates is tried where the first one does not reach, or would
    end beyond a joint limit.

    Args:
        kinematics: of the arm.
        poses: to be reached one after another.
        seconds: when.
        null_motion: what the null space does meanwhile.
    """
    found = _find_start(kinematics, poses, seconds, CANDIDATES, null_motion)
    if isinstance(found, StartPosture) and found.margin >= 0:
        return found
    again = _find_start(kinematics, poses, seconds, MORE_CANDIDATES, null_motion)
    if isinstance(again, NoPosture) and isinstance(found, NoPosture):
        return max(found, again, key=lambda miss: miss.index)
    return again if isinstance(again, StartPosture) else found


def _find_start(
    kinematics: Kinematics,
    poses: Floats,
    seconds: Floats,
    candidates: int,
    null_motion: NullSpaceMotion,
) -> StartPosture | NoPosture:
    card = kinematics.card
    rng = np.random.default_rng(SEED)
    seeds = rng.uniform(card.lower, card.upper, (candidates - 1, card.joints))
    seeds = np.vstack([card.home, seeds])
    wish = np.zeros_like(seeds)
    inside = (card.lower, card.upper)
    postures, errors = solve_posture(kinematics, poses[0], seeds, wish, EXACT_ERROR, inside)
    reached = (errors < START_TOLERANCE) & (_margins(kinematics, postures) >= 0)
    if reached.any():
        return _follow(kinematics, poses, seconds, postures[reached], null_motion)
    # close to a limit Newton's steps are cut short; a patient descent may still arrive
    miss, posture = closest(kinematics, poses[0], postures)
    if miss.combined_error < START_TOLERANCE:
        return _follow(kinematics, poses, seconds, posture[None], null_motion)
    return miss


def waypoints(strokes: NDArray[np.int64]) -> NDArray[np.intp]:
    """Rows that represent a path: evenly spaced, and the first and last of each stroke."""
    n = len(strokes)
    even = np.linspace(0, n - 1, min(n, WAYPOINTS)).astype(np.intp)
    corners = np.flatnonzero(np.diff(strokes)) + 1
    if len(corners) > WAYPOINTS:
        corners = corners[np.linspace(0, len(corners) - 1, WAYPOINTS).astype(np.intp)]
    return np.array(sorted({*even.tolist(), *corners.tolist()}), dtype=np.intp)


def _follow(
    kinematics: Kinematics,
    poses: Floats,
    seconds: Floats,
    starts: Floats,
    null_motion: NullSpaceMotion,
) -> StartPosture | NoPosture:
    """The start (M, n) with the largest margin along the path."""
    postures, margin = starts.copy(), _margins(kinematics, starts)
    alive = np.arange(len(starts))
    before = seconds[0]
    for index in range(1, len(poses)):
        wish = null_motion(postures[alive], starts[alive], float(seconds[index] - before))
        before = seconds[index]
        moved, errors = solve_posture(
            kinematics, poses[index], postures[alive], wish, PATH_TOLERANCE
        )
        reached = errors < PATH_TOLERANCE
        if not reached.any():
            return replace(closest(kinematics, poses[index], postures[alive])[0], index=index)
        alive = alive[reached]
        postures[alive] = moved[reached]
        margin[alive] = np.minimum(margin[alive], _margins(kinematics, postures[alive]))
    # an elbow limit is the same for all the postures of a redundant arm: of equals, the homeliest
    good = alive[margin[alive] >= margin[alive].max() - EQUAL_MARGINS]
    best = good[np.argmin(np.linalg.norm(starts[good] - kinematics.card.home, axis=1))]
    return StartPosture(starts[best], float(margin[best]))


def _margins(kinematics: Kinematics, postures: Floats) -> Floats:
    card = kinematics.card
    return np.asarray(np.minimum(postures - card.lower, card.upper - postures).min(axis=-1))


def solve_posture(
    kinematics: Kinematics,
    pose: Floats,
    postures: Floats,
    null_step: Floats,
    tolerance: float,
    limits: tuple[Floats, Floats] | None = None,
) -> tuple[Floats, Floats]:
    """Newton's method from many postures (M, n) to one pose (8,), or to one pose each (M, 8).

    Returns the postures, and how far off each ended (M,).

    The first step includes the null-space motion `null_step` (M, n) [rad]. The method ends when all
    errors are below `tolerance` [rad, m], or after `ITERATIONS`. No step leaves the joint `limits`.
    """
    q = postures.copy()
    for iteration in range(ITERATIONS):
        x, J = kinematics.poses_and_jacobians(q)
        error = _error(kinematics.task.near(pose, x), x)
        largest = np.abs(error).max(axis=1)
        parts = kinematics.task.parts
        if iteration and largest.max() < tolerance and len(parts) == 1:
            break
        ways = [error, *(_error(part.near(pose, x), x) for part in parts[1:])]
        step = resolve_parts(J, x, ways, parts, null_step, damped_inverse_times)
        q += (
            step
            * np.minimum(1.0, LARGEST_STEP / np.maximum(np.abs(step).max(axis=1), 1e-12))[:, None]
        )
        if limits is not None:
            q = np.clip(q, *limits)
        null_step = np.zeros_like(q)
    return q, largest


def _error(pose: Floats, x: Floats) -> Floats:
    """The displacement (M, 6) from poses x (M, 8) to one pose."""
    return 2 * dq.log(dq.mul(pose, dq.conj(x)))


def least_errors(kinematics: Kinematics, poses: Floats) -> Floats:
    """The least errors at which an arm can reach poses (N, 8) within its limits.

    Each pose is tried from many postures, those that nothing reaches from more.

    Returns:
        The least remaining error (N,) [rad, m], below `PATH_TOLERANCE` where the pose is reached.
    """
    card = kinematics.card
    left = np.full(len(poses), np.inf)
    rng = np.random.default_rng(SEED)
    for crowd in (FEW_SEEDS, CANDIDATES, MANY_SEEDS):
        rows = np.flatnonzero(left >= PATH_TOLERANCE)
        if not len(rows):
            break
        seeds = rng.uniform(card.lower, card.upper, (crowd, card.joints))
        seeds[0] = card.home
        whose = np.repeat(rows, crowd)
        errors = solve_posture(
            kinematics, poses[whose], np.tile(seeds, (len(rows), 1)),
            np.zeros((len(whose), card.joints)), PATH_TOLERANCE, (card.lower, card.upper),
        )[1]  # fmt: skip
        left[rows] = np.minimum(left[rows], errors.reshape(-1, crowd).min(axis=1))
    return left


def shortfall(kinematics: Kinematics, pose: Floats) -> NoPosture:
    """The closest approach of the arm to an unreachable pose (8,)."""
    card = kinematics.card
    seeds = np.random.default_rng(SEED).uniform(card.lower, card.upper, (MANY_SEEDS, card.joints))
    still, inside = np.zeros_like(seeds), (card.lower, card.upper)
    return closest(
        kinematics, pose, solve_posture(kinematics, pose, seeds, still, EXACT_ERROR, inside)[0]
    )[0]


def closest(kinematics: Kinematics, pose: Floats, postures: Floats) -> tuple[NoPosture, Floats]:
    """The closest approach to a pose (8,) within the limits, and its posture (n,).

    From the best few of some postures (M, n), once for the orientation, once for the position;
    what comes closer counts. The miss has the index 0.
    """
    card = kinematics.card
    near = kinematics.task.near
    found = kinematics.poses_and_jacobians(postures)[0]
    errors = np.abs(_error(near(pose, found), found)).max(axis=1)
    few = np.clip(postures[np.argsort(errors)[:CANDIDATES]], card.lower, card.upper)
    best, posture = NoPosture(0, np.inf, 0.0), few[0]
    for weights in ORIENTATION_FIRST, POSITION_FIRST:
        q = few
        for weight in np.repeat(weights, DESCENT_STEPS):
            x, J = kinematics.poses_and_jacobians(q)
            error = _tool_error(near(pose, x), x)
            far, turned = np.linalg.norm(error[:, 3:], axis=1), np.linalg.norm(error[:, :3], axis=1)
            i = int(np.argmin(far + METRES_PER_RADIAN * turned))
            here = NoPosture(0, float(far[i]), float(turned[i]))
            if here.combined_error < best.combined_error:
                best, posture = here, q[i]
            scale = np.array([weight] * 3 + [1.0] * 3)
            shift = tool_jacobian_map(dq.translation(x))
            shift[:, 3:] *= CHARACTERISTIC_LENGTH
            aim = error.copy()
            aim[:, 3:] *= np.minimum(1.0, LONGEST_AIM / np.maximum(far, 1e-12))[:, None]
            q = _step(scale[:, None] * (shift @ J), scale * aim, q, card.lower, card.upper)
    return best, posture


def _tool_error(pose: Floats, x: Floats) -> Floats:
    """Rotation [rad] and displacement of the tool's point [m] from poses x (M, 8) to one pose."""
    turn = _error(pose, x)[:, :3]
    return np.concatenate([turn, dq.translation(pose) - dq.translation(x)], axis=1)


def _step(J: Floats, error: Floats, q: Floats, lower: Floats, upper: Floats) -> Floats:
    """Postures (M, n) after one Levenberg-Marquardt step within the limits.

    Joints that would leave their range are held, and the others make up for them.
    """
    free = np.ones_like(q)
    for _ in range(MOST_RETRIES):
        columns = J * free[:, None, :]
        square = columns @ columns.mT + DESCENT_DAMPING**2 * np.eye(6)
        step = np.vecmat(np.linalg.solve(square, error[..., None])[..., 0], columns)
        step = np.clip(step, -LARGEST_STEP, LARGEST_STEP)
        out = ((q <= lower) & (step < 0)) | ((q >= upper) & (step > 0))
        if not out.any():
            break
        free = np.where(out, 0.0, free)
    return np.clip(q + np.where(out, 0.0, step), lower, upper)

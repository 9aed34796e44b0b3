"""A law and a reference -> the disturbance of given size that the loop of the two answers worst.

The loop is that of a tool that carries out its twist: x(k+1) = exp(T (u + v) / 2) x(k), without an
arm. The search goes up the gradient of the error's energy, which the loop's own tangents give
(forward differences of a step, carried back from the end): v becomes the disturbance of the same
size along it. For a linear loop that is the power iteration of its largest singular value, so it
cannot end at a lesser one.
"""

from dataclasses import dataclass
from typing import Any, Literal

import numpy as np

from dqpaint import dq
from dqpaint.controllers import Arm, Controller, Schedule, Seen
from dqpaint.controllers.base import spatial_error
from dqpaint.dq import Floats
from dqpaint.motion import Motion
from dqpaint.robots.kinematics import Kinematics

Part = Literal["translation", "rotation"]
HALVES: dict[Part, slice] = {"translation": slice(3, 6), "rotation": slice(0, 3)}
STEP = 1e-7  # of the differences [rad, m]
SHARES = (1.0, 0.3, 0.1, 0.03, 0.01)  # of the way along the gradient that are tried at once
STARTS = 4


@dataclass(frozen=True)
class Found:
    """A disturbance, and what comes of it in the loop.

    Attributes:
        v: spatial twists (N - 1, 6) [rad/s, m/s], each held for a period.
        pose: of the tool (N, 8).
        ratio: energy of the error over that of the disturbance, roots of both [s].
    """

    v: Floats
    pose: Floats
    ratio: float


class Loop:
    """A law that leads a tool along a reference.

    Args:
        controller: the law; it commands twists, and takes arrays of any leading shape.
        gains: of it, over the drawing.
        kinematics: the law's model of an arm, which such laws do not ask.
        motion: the reference.
    """

    def __init__(
        self,
        controller: Controller[Any],
        gains: Schedule[Any],
        kinematics: Kinematics,
        motion: Motion,
    ) -> None:
        arm = Arm(kinematics)
        self._law, self._limits = controller.start(arm, motion, gains), arm.limits
        self._motion = motion
        self._gains = list(gains.over(motion.clock / motion.clock[-1]))

    def step(self, k: int, x: Floats, v: Floats) -> Floats:
        """The poses (..., 8) after a period with disturbances (..., 6), from poses (..., 8)."""
        motion, shape = self._motion, (*x.shape[:-1], 6)
        jacobian = np.broadcast_to(np.eye(6), (*x.shape[:-1], 6, 6))
        still = np.zeros(shape)
        seen = Seen(
            x, motion.pose[k], motion.twist[k], motion.acceleration[k], jacobian, still,
            float(motion.t[k]), motion.period, still, k, self._limits, motion,
        )  # fmt: skip
        twist = self._law(seen, self._gains[k]) + v
        return dq.mul(dq.exp(0.5 * motion.period * twist), x)

    def run(self, v: Floats) -> Floats:
        """The poses (N, ..., 8) under disturbances (N - 1, ..., 6), from the reference on."""
        poses = np.empty((len(v) + 1, *v.shape[1:-1], 8))
        poses[0] = self._motion.pose[0]
        for k in range(len(v)):
            poses[k + 1] = self.step(k, poses[k], v[k])
        return poses

    def error(self, poses: Floats, part: Part) -> Floats:
        """p_e (N, ..., 3) [m], or Im(r_e) with |1 - r_e| for its size, of poses (N, ..., 8)."""
        x_e = self._errors(poses)
        if part == "translation":
            return dq.translation(x_e)
        return x_e[..., 1:4] * np.sqrt(2 / np.maximum(1 + x_e[..., :1], 1e-12))

    def _errors(self, poses: Floats) -> Floats:
        """The errors x x_d* (N, ..., 8), the short way."""
        wanted = self._motion.pose.reshape(len(poses), *(1,) * (poses.ndim - 2), 8)
        return spatial_error(poses, np.broadcast_to(wanted, poses.shape))

    def energy(self, poses: Floats, part: Part) -> Floats:
        """Energy (...,) of the errors after each step: of |p_e|^2, or of |1 - r_e|^2."""
        return np.asarray((self.error(poses, part)[1:] ** 2).sum(axis=(0, -1)))

    def gradient(self, v: Floats, part: Part) -> Floats:
        """Half the gradient (N - 1, ..., 6) of the energy, for disturbances (N - 1, ..., 6)."""
        nudges = np.concatenate([np.zeros((1, 6)), STEP * np.eye(6)])
        moved = dq.exp(0.5 * nudges)  # (7, 8): a pose as it is, and nudged along each axis
        n, middle = len(v), v.shape[1:-1]
        of_pose, of_v = np.empty((n, *middle, 6, 6)), np.empty((n, *middle, 6, 6))
        poses = np.empty((n + 1, *middle, 8))
        poses[0] = self._motion.pose[0]
        for k in range(n):
            start = dq.mul(moved, poses[k][..., None, :])
            around = np.concatenate([start, np.repeat(start[..., :1, :], 6, axis=-2)], axis=-2)
            pushed = np.concatenate([np.zeros((7, 6)), nudges[1:]])
            after = self.step(k, around, v[k][..., None, :] + pushed)
            poses[k + 1] = after[..., 0, :]
            home = dq.conj(after[..., :1, :])
            apart = 2 / STEP * dq.log(dq.nearest(dq.mul(after[..., 1:, :], home), dq.IDENTITY))
            of_pose[k], of_v[k] = apart[..., :6, :], apart[..., 6:, :]
        x_e = self._errors(poses)
        slope = np.zeros((n + 1, *middle, 6))
        if part == "translation":
            slope[..., 3:] = dq.translation(x_e)
        else:
            slope[..., :3] = 0.5 * x_e[..., 1:4]
        found, back = np.empty_like(v), slope[n]
        for k in range(n - 1, -1, -1):
            found[k] = np.matvec(of_v[k], back)
            back = slope[k] + np.matvec(of_pose[k], back)
        return found


def search(
    loop: Loop, part: Part, rows: int, size: float, turn: float, rounds: int, seed: int
) -> Found:
    """The disturbance that a loop answers worst, the best of several starts.

    Args:
        loop: of the law.
        part: of the error: of its translation or its rotation.
        rows: of the disturbance, one a step.
        size: rms of the disturbance of that part [m/s] or [rad/s].
        turn: the largest rate [rad/s] that turns the tool besides, where translation is asked.
        rounds: of the search.
        seed: of the starts.
    """
    rng = np.random.default_rng(seed)
    v = rng.standard_normal((rows, STARTS, 6))
    v[:, 0] = 1.0
    v[:, 1, :3] = ((-1.0) ** np.arange(rows))[:, None] * rng.standard_normal(3)
    v[:, 1, 3:] = rng.standard_normal(3)
    v = _sized(v, part, size, turn)
    poses = loop.run(v)
    for _ in range(rounds):
        along = _sized(loop.gradient(v, part), part, size, turn)
        tried = np.stack([_sized((1 - s) * v + s * along, part, size, turn) for s in SHARES], 1)
        made = loop.run(tried)  # (N, S, starts, 8)
        energy = loop.energy(made, part)
        chosen = energy.argmax(axis=0)
        better = energy.max(axis=0) > loop.energy(poses, part) * (1 + 1e-9)
        for i in np.flatnonzero(better):
            v[:, i], poses[:, i] = tried[:, chosen[i], i], made[:, chosen[i], i]
        if not better.any():
            break
    energy = loop.energy(poses, part)
    worst = int(np.argmax(energy))
    cause = (v[:, worst, HALVES[part]] ** 2).sum()
    return Found(v[:, worst], poses[:, worst], float(np.sqrt(energy[worst] / cause)))


def _sized(v: Floats, part: Part, size: float, turn: float) -> Floats:
    """Disturbances (N, ..., 6) of a size: their own half by its rms, turns by their largest."""
    own = v[..., HALVES[part]]
    found = np.zeros_like(v)
    norm = np.sqrt((own**2).sum(axis=(0, -1), keepdims=True) / len(v))
    found[..., HALVES[part]] = size * own / np.maximum(norm, 1e-300)
    if part == "translation" and turn:
        w = v[..., :3]
        found[..., :3] = turn * w / np.maximum(np.linalg.norm(w, axis=-1, keepdims=True), 1e-300)
    return found

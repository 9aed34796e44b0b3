"""Motion x robot x plant x law -> Track: what the arm did."""

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from types import MappingProxyType
from typing import Any

import numpy as np

from dqpaint import dq
from dqpaint.controllers import Controller, Schedule, Seen
from dqpaint.disturbances import Disturbance
from dqpaint.dq import Floats
from dqpaint.driving import make_drive
from dqpaint.errors import DqpaintError
from dqpaint.motion import Motion
from dqpaint.nullspace import DEFAULT_NULL, make_wish
from dqpaint.plants.plant import Chosen, Plant, PlantMaker
from dqpaint.robots.card import Card
from dqpaint.robots.kinematics import Kinematics, manipulability
from dqpaint.robots.limits import Clamp, clamps
from dqpaint.robots.resolver import resolve
from dqpaint.sensing import Late, Senses, Told, chance, delay
from dqpaint.stopping import limit_error, meets_limit

REPORT_EVERY = 50  # rows
BLOCK = 512  # rows whose Jacobians are kept


@dataclass(frozen=True)
class Track:
    """A run, one row a control step; the arrays are read-only.

    A row is a time t_k, what was asked at t_k (in `motion`), where the arm and its light truly were
    at t_k, what the law was told of it, and the command then given.

    Attributes:
        motion: what was asked.
        posture: true joint angles (N, n) [rad].
        pose: true tool poses (N, 8) in the base frame, signs continuous.
        read: joint angles (N, n) [rad] as the encoders read them.
        believed: tool poses (N, 8) as the law's model has them at these.
        manipulability: sqrt(det(J J')) (N,) at the true postures.
        command: what the arm was given (N, n): joint rates [rad/s], or torques [Nm].
        torques: whether the commands are torques.
        effort: motor torques (N, n) [Nm], the largest seen in the period before the row.
        clamps: limits that held a joint back.
        disturbance: spatial twist (N, 6) [rad/s, m/s] that came on top of the arm's own from t_k to
            t_k+1, unknown to the law; the last row is zero.
    """

    motion: Motion
    posture: Floats
    pose: Floats
    read: Floats
    believed: Floats
    manipulability: Floats
    command: Floats
    torques: bool
    effort: Floats
    clamps: tuple[Clamp, ...]
    disturbance: Floats

    def __post_init__(self) -> None:
        for array in (
            self.posture,
            self.pose,
            self.read,
            self.believed,
            self.manipulability,
            self.command,
            self.effort,
            self.disturbance,
        ):
            array.setflags(write=False)

    @property
    def points(self) -> Floats:
        """The reached places of the light (N, 3) [m]."""
        return dq.translation(self.pose)


def track(
    motion: Motion,
    kinematics: Kinematics,
    start: Floats,
    make_plant: PlantMaker | Chosen,
    controller: Controller[Any],
    gains: Schedule[Any],
    progress: Callable[[float], None] = lambda _done: None,
    disturbances: Mapping[str, Disturbance] = MappingProxyType({}),
    seed: int = 0,
    null: str = DEFAULT_NULL,
    stop: bool = False,
) -> Track:
    """Drive the arm along a motion.

    Args:
        motion: what is asked.
        kinematics: of the arm, and its card.
        start: posture (n,) [rad] to begin from, at rest.
        make_plant: how the arm answers.
        controller: the law.
        gains: of the law, over the drawing.
        progress: called now and then with the part done, 0 to 1.
        disturbances: by their names.
        seed: of everything random.
        null: what a redundant arm does with its freedom.
        stop: whether the first limit that is met ends the run.

    Raises:
        UsageError: a disturbance that does not go with the period or the arm, an unknown `null`.
        ScriptError: a limit was met, and `stop`.
        DqpaintError: the simulation left the numbers, or a law of one's own has a fault.
    """
    n, card = len(motion.t), kinematics.card
    senses = Senses(kinematics, motion.t, motion.period, disturbances, seed)
    log = _Log(n, card.joints)
    ahead = controller.prepare(motion, gains) if controller.prepare else np.zeros((n, 0))
    wish = make_wish(null, card, start)
    drive = make_drive(controller, senses.believed, wish, motion.period)
    carried = _carried(motion, disturbances, seed)
    late = Late(delay(disturbances), drive.hold(start))
    parts = motion.clock / motion.clock[-1] if n > 1 else motion.clock
    plant = make_plant(card, start, motion.period, senses.world)
    asked = zip(
        motion.pose, motion.twist, motion.acceleration, motion.t.tolist(), ahead,
        gains.over(parts), strict=True,
    )  # fmt: skip
    try:
        for k, (pose_d, twist_d, acceleration_d, t, known, now) in enumerate(asked):
            told = senses.tell(k, plant)
            q, rates, x, J = told
            seen = Seen(x, pose_d, twist_d, acceleration_d, J, q, t, motion.period, rates, known)
            wanted = drive.ask(seen, now)
            given = drive.within(wanted, q)
            log.keep(k, plant, told, senses.truth(plant, told), wanted, given)
            if stop:
                log.see_limits(k, card, motion, controller.drives_torque)
            if k % REPORT_EVERY == 0:
                progress(k / n)
            if k < n - 1:
                plant.run(late(given), log.drift(k, carried))
    except np.linalg.LinAlgError:  # a posture that is no number any more has no singular values
        raise _lost(t) from None
    finally:
        plant.close()
    if not (np.isfinite(log.posture).all() and np.isfinite(log.command).all()):
        raise _lost(float(motion.t[-1]))
    return _finished(log, motion, card, controller.drives_torque)


class _Log:
    """What a run leaves, row by row."""

    def __init__(self, n: int, joints: int) -> None:
        self.posture, self.effort = np.empty((n, joints)), np.zeros((n, joints))
        self.read, self.believed = np.empty((n, joints)), np.empty((n, 8))
        self.wanted, self.command = np.empty((n, joints)), np.empty((n, joints))
        self.pose, self.manipulability = np.empty((n, 8)), np.empty(n)
        self.disturbance = np.zeros((n, 6))
        self._jacobian = np.empty((BLOCK, 6, joints))

    def keep(
        self,
        k: int,
        plant: Plant,
        told: Told,
        truth: tuple[Floats, Floats],
        wanted: Floats,
        given: Floats,
    ) -> None:
        """Note row k; manipulabilities are worked out a block at a time, which costs less."""
        self.posture[k], self.effort[k] = plant.posture, plant.effort
        self.read[k], self.believed[k] = told.posture, told.pose
        self.pose[k], self._jacobian[k % BLOCK] = truth
        self.wanted[k], self.command[k] = wanted, given
        if k % BLOCK == BLOCK - 1 or k == len(self.pose) - 1:
            first = k - k % BLOCK
            self.manipulability[first : k + 1] = manipulability(self._jacobian[: k + 1 - first])

    def see_limits(self, k: int, card: Card, motion: Motion, torques: bool) -> None:
        """End the run where row k, or the period before it, met a limit.

        Raises:
            ScriptError: it did.
        """
        row = self.posture[k], self.wanted[k], self.command[k], self.effort[k]
        if meets_limit(card, *row, torques):
            held = self.clamps(slice(max(k - 1, 0), k + 1), card, motion, torques)
            raise limit_error(motion, held[0])

    def clamps(self, rows: slice, card: Card, motion: Motion, torques: bool) -> tuple[Clamp, ...]:
        """The limits that held a joint in some rows."""
        return clamps(
            card, motion.t[rows], motion.line[rows],
            (self.posture if torques else self.read)[rows], self.wanted[rows], self.command[rows],
            self.effort[rows], torques, motion.period,
        )  # fmt: skip

    def drift(self, k: int, carried: Floats | None) -> Floats | None:
        """The joint rates (n,) of an unmodelled velocity (N, 6) of the tool at row k."""
        if carried is None:
            return None
        point, J = dq.translation(self.pose[k]), self._jacobian[k % BLOCK]
        self.disturbance[k] = dq.twist_from_point(carried[k, :3], carried[k, 3:], point)
        return resolve(J, point, self.disturbance[k], np.zeros(J.shape[-1]))


def _carried(motion: Motion, disturbances: Mapping[str, Disturbance], seed: int) -> Floats | None:
    """The unmodelled velocity (N, 6) of the tool; each disturbance has its own random numbers."""
    if not disturbances:
        return None
    return np.asarray(
        sum(
            one.twist(motion.t, motion.period, chance(seed, name))
            for name, one in disturbances.items()
        )
    )


def _finished(log: _Log, motion: Motion, card: Card, torques: bool) -> Track:
    log.wanted[-1] = log.command[-1]  # the last command is never carried out
    held = log.clamps(slice(None), card, motion, torques)
    for poses in (log.pose, log.believed):
        poses[0] = dq.nearest(poses[0], motion.pose[0])
    return Track(
        motion, log.posture, dq.continuous(log.pose), log.read, dq.continuous(log.believed),
        log.manipulability, log.command, torques, log.effort, held, log.disturbance,
    )  # fmt: skip


def _lost(time: float) -> DqpaintError:
    return DqpaintError(
        f"the run left the numbers before {time:.3f} s: the loop is unstable; "
        "lower the gains or shorten the period"
    )

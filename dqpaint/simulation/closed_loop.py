"""Reference motion, arm, law and plant -> the Track of a closed-loop simulation."""

from collections.abc import Callable, Mapping, Sequence
from copy import copy
from dataclasses import dataclass
from functools import partial
from types import MappingProxyType
from typing import Any, Self

import numpy as np
from numpy.typing import NDArray

from dqpaint import dq
from dqpaint.controllers import Arm, Controller, Schedule, Seen
from dqpaint.disturbances import Disturbance
from dqpaint.dq import Floats
from dqpaint.errors import UnstableError
from dqpaint.motion import Motion
from dqpaint.plants import ConfiguredPlant, Plant, PlantMaker, pushes_at
from dqpaint.robots.kinematics import (
    DEFAULT_OBJECTIVE,
    Clamp,
    Clipped,
    Kinematics,
    find_clamps,
    make_secondary_task,
    manipulability,
    resolve,
)
from dqpaint.robots.model import POSE, Card
from dqpaint.robots.resolvers import DEFAULT_RESOLVER, Held, Qp, Setup, make_resolver, read_resolver
from dqpaint.robots.walls import WallsOfRun, among_walls, walls_of
from dqpaint.simulation.drives import make_drive
from dqpaint.simulation.sensors import (
    BatchedSensors,
    DelayLine,
    Measurement,
    Sensors,
    random_numbers,
    total_delay,
)
from dqpaint.simulation.stop_on_limit import limit_error, meets_limit

REPORT_EVERY = 50  # rows
NOTHING: Floats = np.zeros(0)
JACOBIAN_ROWS = 512  # rows whose Jacobians are kept


@dataclass(frozen=True)
class Track:
    """A run, one row a control step; the arrays are read-only.

    A row is a time t_k, the reference at t_k (in `motion`), the true state of the arm and its light
    at t_k, what was measured of it, and the command then given.

    Attributes:
        motion: the reference.
        posture: true joint angles (N, n) [rad].
        pose: true tool poses (N, 8) in the base frame, signs continuous.
        measured_posture: joint angles (N, n) [rad] as the encoders read them.
        measured_pose: tool poses (N, 8) as the law's model has them at these.
        measured_rates: joint rates (N, n) [rad/s] as the encoders read them.
        measured_twist: spatial twists (N, 6) [rad/s, m/s] of the law's model at these.
        manipulability: sqrt(det(J J')) (N,) at the true postures.
        command: what the arm was given (N, n): joint rates [rad/s], or torques [Nm].
        unclipped: the same (N, n) before limits clipped it.
        torques: whether the commands are torques.
        effort: motor torques (N, n) [Nm], the largest seen in the period before the row.
        clamps: limits that held a joint back.
        clipped: whether a limit of a kind clipped a joint in a row (N, n), by the kinds that did;
            None where it is not known.
        disturbance: spatial twist (N, 6) [rad/s, m/s] that came on top of the arm's own from t_k to
            t_k+1, unknown to the law; the last row is zero.
        walls: how it went among the walls of the drawing, where it has some.
        pose_disturbance: likewise, of the tool's displacement on the flange (v_c of Pereira 2016,
            (3.17)).
    """

    motion: Motion
    posture: Floats
    pose: Floats
    measured_posture: Floats
    measured_pose: Floats
    measured_rates: Floats
    measured_twist: Floats
    manipulability: Floats
    command: Floats
    unclipped: Floats
    torques: bool
    effort: Floats
    clamps: tuple[Clamp, ...]
    clipped: Clipped | None
    disturbance: Floats
    pose_disturbance: Floats
    walls: WallsOfRun | None = None

    def __post_init__(self) -> None:
        for array in (
            self.posture,
            self.pose,
            self.measured_posture,
            self.measured_pose,
            self.measured_rates,
            self.measured_twist,
            self.manipulability,
            self.command,
            self.unclipped,
            self.effort,
            self.disturbance,
            self.pose_disturbance,
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
    make_plant: PlantMaker | ConfiguredPlant,
    controller: Controller[Any],
    gains: Schedule[Any],
    progress: Callable[[float], None] = lambda _done: None,
    disturbances: Mapping[str, Disturbance] = MappingProxyType({}),
    seed: int = 0,
    null: str = DEFAULT_OBJECTIVE,
    stop: bool = False,
    resolver: str = DEFAULT_RESOLVER,
    watch: Callable[[int, Floats], None] = lambda _row, _pose: None,
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
        resolver: what turns twists into joint rates.
        watch: called with each row and the true pose (8,) of the tool; what it raises ends the run.

    Raises:
        UsageError: a disturbance that does not go with the period or the arm, an unknown `null` or
            `resolver`.
        ScriptError: a limit was met, and `stop`.
        DqpaintError: the simulation diverged, or a law of one's own has a fault.
    """
    sensors = Sensors(kinematics, motion.t, motion.period, disturbances, seed)
    drift = _drift(motion, disturbances, [seed])
    log = _Log(len(motion.t), (), kinematics)
    stop_at_limit = partial(log.stop_at_limit, kinematics.card, motion, controller.drives_torque)

    def at_row(k: int) -> None:
        watch(k, log.pose[k])
        if stop:
            stop_at_limit(k)
        if k % REPORT_EVERY == 0:
            progress(k / len(motion.t))

    _simulate(
        motion, sensors, start, make_plant, controller, gains, disturbances, null, resolver, log,
        None if drift is None else drift[:, 0], at_row,
    )  # fmt: skip
    if not log.finite.all():
        raise _diverged(float(motion.t[-1]))
    return _make_track(log, motion, kinematics.card, controller.drives_torque, sensors.offset)


def track_many(
    motion: Motion,
    kinematics: Kinematics,
    start: Floats,
    make_plant: PlantMaker | ConfiguredPlant,
    controller: Controller[Any],
    gains: Schedule[Any],
    disturbances: Mapping[str, Disturbance],
    seeds: Sequence[int],
    null: str = DEFAULT_OBJECTIVE,
    progress: Callable[[float], None] = lambda _done: None,
    resolver: str = DEFAULT_RESOLVER,
) -> list[Track | None]:
    """The same run with several seeds at once, as arrays (B, ...) through the same laws.

    Each is, to rounding, what `track` gives. For a plant, a law and an objective of the null space
    that take arrays of any leading shape: the ideal arm and the laws that command rates do.

    Args:
        motion: what is asked.
        kinematics: of the arm, and its card.
        start: posture (n,) [rad] of all of them.
        make_plant: how the arms answer.
        controller: the law.
        gains: of the law, over the drawing.
        disturbances: by their names; none that changes the law's model of the arm.
        seeds: one a run.
        null: what a redundant arm does with its freedom.
        progress: called now and then with the part done, 0 to 1.
        resolver: what turns twists into joint rates.

    Returns:
        A track a seed; None for one that diverged.

    Raises:
        ValueError: the law takes one arm at a time.
    """
    if not controller.batched:
        raise ValueError(f"law '{controller.name}' takes one arm at a time")
    sensors = BatchedSensors(kinematics, motion.t, motion.period, disturbances, seeds)
    log = _Log(len(motion.t), (len(seeds),), kinematics)
    _simulate(
        motion, sensors, np.tile(start, (len(seeds), 1)), make_plant, controller, gains,
        disturbances, null, resolver, log, _drift(motion, disturbances, seeds),
        lambda k: progress(k / len(motion.t)) if k % REPORT_EVERY == 0 else None,
    )  # fmt: skip
    return [
        _make_track(
            log.one(i),
            motion,
            kinematics.card,
            controller.drives_torque,
            None if sensors.offset is None else sensors.offset[:, i],
        )
        if good
        else None
        for i, good in enumerate(log.finite.tolist())
    ]


def _simulate(
    motion: Motion,
    sensors: Sensors,
    start: Floats,
    make_plant: PlantMaker | ConfiguredPlant,
    controller: Controller[Any],
    gains: Schedule[Any],
    disturbances: Mapping[str, Disturbance],
    null: str,
    resolver: str,
    log: "_Log",
    drift: Floats | None,
    at_row: Callable[[int], None],
) -> None:
    """The control loop, of one arm (n,) or of many (B, n); it fills `log`."""
    n, card = len(motion.t), sensors.model.card
    arm = Arm(sensors.model)
    task = sensors.model.task if controller.is_resolved else POSE
    # what comes second has a law of its own, which sees a reference of its own
    laws = [controller.start(arm, motion, gains) for _ in task.parts]
    wish = make_secondary_task(null, card, start)
    walls = walls_of(motion, sensors.model)
    if controller.drives_torque and read_resolver(resolver)[0].holds_rates:
        resolver = DEFAULT_RESOLVER  # what holds rates is not for accelerations
    solver = make_resolver(resolver, Setup(sensors.model, motion.period, task, walls))
    log.history = solver.history if isinstance(solver, Qp) else []
    drive = make_drive(controller, laws, sensors.model, wish, motion.period, solver)
    late = DelayLine(total_delay(disturbances), drive.hold(start))
    parts = motion.clock / motion.clock[-1] if n > 1 else motion.clock
    plant = make_plant(card, start, motion.period, sensors.world)
    liars = [one for one in disturbances.values() if type(one).misread is not Disturbance.misread]
    remembers, clipped = isinstance(controller.law, type), np.zeros(start.shape[:-1], np.bool_)
    feels = pushes_at(sensors.world, motion.t) if "push" in controller.senses else None
    clips = not isinstance(make_plant, ConfiguredPlant) or make_plant.clips_rates
    asked = zip(
        motion.pose, motion.twist, motion.acceleration, motion.t.tolist(), gains.over(parts),
        strict=True,
    )  # fmt: skip
    try:
        for k, (pose_d, twist_d, acceleration_d, t, now) in enumerate(asked):
            measured = sensors.measure(k, plant)
            q, rates, x, J = measured
            for one in liars:
                x = one.misread(x, pose_d)
            truth = sensors.truth(k, plant, measured)
            seen = Seen(
                x, pose_d, twist_d, acceleration_d, J, q, t, motion.period, rates, k, arm.limits,
                motion, clipped=clipped,
            )  # fmt: skip
            if controller.senses:
                light = dq.translation(truth[0]) if motion.lit[k] else np.full(3, np.nan)
                seen = seen._replace(light=light, push=NOTHING if feels is None else feels[k])
            wanted = drive.command(seen, now)
            given = drive.clip(wanted, q) if clips else wanted
            if remembers:
                clipped = (given != wanted).any(axis=-1)
            log.record(k, plant, measured, truth, x, wanted, given)
            at_row(k)
            if k < n - 1:
                plant.run(late(given), log.drift_rates(k, drift))
    except np.linalg.LinAlgError:  # a posture that is not finite has no singular values
        raise _diverged(t) from None
    finally:
        plant.close()


class _Log:
    """The arrays of a run, filled row by row; of `shape` (B,) runs, if there are several."""

    def __init__(self, n: int, shape: tuple[int, ...], kinematics: Kinematics) -> None:
        joints = kinematics.card.joints
        of_joints = (n, *shape, joints)
        self.posture, self.effort = np.empty(of_joints), np.zeros(of_joints)
        self.measured_posture, self.measured_pose = np.empty(of_joints), np.empty((n, *shape, 8))
        self.measured_rates, self.measured_twist = np.empty(of_joints), np.empty((n, *shape, 6))
        self.wanted, self.command = np.empty(of_joints), np.empty(of_joints)
        self.pose, self.manipulability = np.empty((n, *shape, 8)), np.empty((n, *shape))
        self.disturbance = np.zeros((n, *shape, 6))
        self._jacobian = np.empty((JACOBIAN_ROWS, *shape, 6, joints))
        self._kinematics = kinematics
        self.history: list[Held] = []

    @property
    def finite(self) -> NDArray[np.bool_]:
        """Whether all postures and commands are finite, for each of several runs."""
        found = np.isfinite(self.posture).all(axis=(0, -1))
        return np.asarray(found & np.isfinite(self.command).all(axis=(0, -1)))

    def one(self, i: int) -> Self:
        """The i-th of several runs."""
        other = copy(self)
        for name, array in vars(self).items():
            if isinstance(array, np.ndarray):
                setattr(other, name, np.ascontiguousarray(array[:, i]))
        return other

    def record(
        self,
        k: int,
        plant: Plant,
        measured: Measurement,
        truth: tuple[Floats, Floats],
        read_pose: Floats,
        wanted: Floats,
        given: Floats,
    ) -> None:
        """Record row k; manipulabilities are computed a block at a time, which costs less."""
        self.posture[k], self.effort[k] = plant.posture, plant.effort
        self.measured_posture[k], self.measured_pose[k] = measured.posture, read_pose
        self.measured_rates[k] = measured.rates
        self.measured_twist[k] = np.matvec(measured.jacobian, measured.rates)
        self.pose[k], self._jacobian[k % JACOBIAN_ROWS] = truth
        self.wanted[k], self.command[k] = wanted, given
        if k % JACOBIAN_ROWS == JACOBIAN_ROWS - 1 or k == len(self.pose) - 1:
            first = k - k % JACOBIAN_ROWS
            controlled = self._kinematics.task_jacobian(
                self.pose[first : k + 1], self._jacobian[: k + 1 - first]
            )
            self.manipulability[first : k + 1] = manipulability(controlled)

    def stop_at_limit(self, card: Card, motion: Motion, torques: bool, k: int) -> None:
        """End the run where row k, or the period before it, met a limit.

        Raises:
            ScriptError: it did.
        """
        row = self.posture[k], self.wanted[k], self.command[k], self.effort[k]
        if meets_limit(card, *row, torques):
            held, _ = self.clamps(slice(max(k - 1, 0), k + 1), card, motion, torques)
            raise limit_error(motion, held[0])

    def clamps(
        self, rows: slice, card: Card, motion: Motion, torques: bool
    ) -> tuple[tuple[Clamp, ...], Clipped]:
        """The limits that held a joint in some rows, and where."""
        return find_clamps(
            card, motion.t[rows], motion.source[rows],
            (self.posture if torques else self.measured_posture)[rows], self.wanted[rows],
            self.command[rows], self.effort[rows], torques, motion.period,
        )  # fmt: skip

    def among_walls(self, motion: Motion) -> WallsOfRun | None:
        """How the run went among the walls of its drawing."""
        if not self.history:
            return among_walls(motion, self._kinematics, self.posture)
        active = np.array([held.walls for held in self.history])
        lost = np.array([held.lost for held in self.history])
        return among_walls(motion, self._kinematics, self.posture, active, lost)

    def drift_rates(self, k: int, drift: Floats | None) -> Floats | None:
        """The joint rates (n,) of an unmodelled velocity (N, 6) of the tool at row k."""
        if drift is None:
            return None
        point, J = dq.translation(self.pose[k]), self._jacobian[k % JACOBIAN_ROWS]
        self.disturbance[k] = dq.twist_from_point(drift[k, ..., :3], drift[k, ..., 3:], point)
        return resolve(J, point, self.disturbance[k], None)


def _drift(
    motion: Motion, disturbances: Mapping[str, Disturbance], seeds: Sequence[int]
) -> Floats | None:
    """Unmodelled velocities (N, B, 6) of the tool; each disturbance has its own random numbers."""
    if not disturbances:
        return None
    found = np.stack([
        sum(
            one.twist(motion.t, motion.period, random_numbers(seed, name))
            for name, one in disturbances.items()
        )
        for seed in seeds
    ], axis=1)  # fmt: skip
    return found if found.any() else None


def _make_track(
    log: _Log, motion: Motion, card: Card, torques: bool, offset: Floats | None
) -> Track:
    log.wanted[-1] = log.command[-1]  # the last command is never carried out
    held, clipped = log.clamps(slice(None), card, motion, torques)
    for poses in (log.pose, log.measured_pose):
        poses[0] = dq.nearest(poses[0], motion.pose[0])
    return Track(
        motion, log.posture, dq.continuous(log.pose), log.measured_posture,
        dq.continuous(log.measured_pose), log.measured_rates, log.measured_twist,
        log.manipulability, log.command, log.wanted, torques, log.effort, held,
        clipped, log.disturbance, _pose_disturbance(log.pose, offset, motion.period),
        log.among_walls(motion),
    )  # fmt: skip


def _pose_disturbance(pose: Floats, offset: Floats | None, period: float) -> Floats:
    """v_c (N, 6): the twist of the tool's displacement c (N, 8) from row to row.

    c(k+1) = c(k) exp(T v / 2), and v_c is v seen from the base: Ad(x) v.
    """
    found = np.zeros((len(pose), 6))
    if offset is not None:
        step = dq.mul(dq.conj(offset[:-1]), dq.nearest(offset[1:], offset[:-1]))
        found[:-1] = dq.adjoint(pose[:-1], (2 / period) * dq.log(step))
    return found


def _diverged(time: float) -> UnstableError:
    return UnstableError(
        f"the simulation diverged before {time:.3f} s: the loop is unstable; "
        "lower the gains or shorten the period"
    )

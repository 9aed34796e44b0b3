"""A card -> rigid bodies in a MuJoCo model of their own."""

from functools import cache
from typing import Any
from xml.etree import ElementTree as Xml

import numpy as np

from dqpaint import dq
from dqpaint.dq import Floats
from dqpaint.plants.engines.bodies import STOP_DISTANCE
from dqpaint.plants.engines.loads import Pushes, with_payloads
from dqpaint.plants.world import World
from dqpaint.robots.model import Card
from dqpaint.robots.urdf import prepare

STIFF_STOP = (0.99, 0.999, 1e-3, 0.5, 2.0)
"""The impedance of mechanical stops: as hard as MuJoCo's are while they stay stable."""
SURE_SHARE = 0.9
"""Part of a motor's torque up to which, at both ends of a short way, no step between reaches it."""
SHORT_WAY = 0.05
"""How far joints turn on a short way, all together [rad]."""


@cache
def _library() -> Any:
    """MuJoCo, which neither prints nor writes a log: what diverges is told by the run."""
    import mujoco

    mujoco.set_mju_user_warning(lambda _text: None)
    return mujoco


class MuJoCoBodies:
    """Bodies as `Bodies` has them.

    Friction is taken at the beginning of a step, as in the other engine: MuJoCo's implicit damping
    is switched off. What becomes infinite stays so, where MuJoCo would begin anew.

    Its own velocity motors are forces with gains. So here a motor's torque is worked out of its
    task: that with which the joints have their rates at the end of the step,

        tau = H (q_dot_c - q_dot) / h + C q_dot + G + D q_dot - push,   |tau| <= effort

    and where some reach their largest, that of the box-constrained problem in which the others keep
    their rates. That is the constraint which PyBullet's solver keeps, exact to rounding.
    """

    def __init__(
        self, card: Card, posture: Floats, step: float, world: World, driven: bool
    ) -> None:
        self._pushes = Pushes(world, card, step)
        self._mujoco = mj = _library()
        text = with_payloads(prepare(card).text, card, world.payloads)
        self.model = mj.MjModel.from_xml_string(_without_shapes(text))
        self.data = mj.MjData(self.model)
        off = mj.mjtDisableBit
        options = self.model.opt
        options.timestep = self._step = step
        options.gravity[:] = world.gravity
        options.disableflags |= (
            off.mjDSBL_CONTACT | off.mjDSBL_EULERDAMP | off.mjDSBL_AUTORESET | off.mjDSBL_WARMSTART
        )
        self.model.dof_frictionloss[:] = 0.0  # no law and no other engine knows of it
        self.model.jnt_limited[:] = 1
        self.model.jnt_range[:, 0] = card.lower - STOP_DISTANCE
        self.model.jnt_range[:, 1] = card.upper + STOP_DISTANCE
        self.model.jnt_solref[:] = 2.0 * step, 1.0
        self.model.jnt_solimp[:] = STIFF_STOP
        self._most = card.effort
        n = card.joints
        self._inertia = np.zeros((n, n))
        self._work = np.zeros((n, n + 7))
        self._flange, self._tool = self.model.body(card.link).id, card.tool.pose
        self.place(posture, np.zeros(n))

    def state(self) -> tuple[list[float], list[float]]:
        """Angles [rad] and rates [rad/s] of the joints."""
        return self.data.qpos.tolist(), self.data.qvel.tolist()

    def place(self, angles: Floats, rates: Floats) -> None:
        """Put the joints at angles (n,) [rad], moving at rates (n,) [rad/s]."""
        self.data.qpos[:], self.data.qvel[:] = angles, rates

    def turn(self, rates: Floats, steps: int) -> Floats:
        """Steps under velocity motors, see `Bodies.turn`."""
        if not self._pushes:
            found = self._turn_freely(rates, steps)
            if found is not None:
                return found
        first = last = self._turn_once(rates)
        for _ in range(steps - 1):
            last = self._turn_once(rates)
        return _larger(first, last)

    def apply(self, torques: list[float]) -> None:
        """One physics step at joint torques [Nm]."""
        self.data.qfrc_applied[:] = torques
        if self._pushes:
            self._mujoco.mj_kinematics(self.model, self.data)
            self._mujoco.mj_comPos(self.model, self.data)
            self._add_pushes()
        self._mujoco.mj_step(self.model, self.data)

    def weight(self, posture: Floats) -> Floats:
        """Gravity torques (n,) [Nm] of the arm and its load in a posture (n,) [rad]."""
        still = self._mujoco.MjData(self.model)
        still.qpos[:] = posture
        self._mujoco.mj_forward(self.model, still)
        return np.array(still.qfrc_bias)

    def close(self) -> None:
        """Does nothing: the memory goes with the object."""

    def _turn_freely(self, rates: Floats, steps: int) -> Floats | None:
        """All steps at once, where no motor reaches its torque; None where one may.

        Then each step adds h q_dot_c to the angles, whatever the bodies weigh. Torques are those of
        the first and last step. Between the two only the arm's weight and centrifugal torques
        change, along a short way.
        """
        data, h = self.data, self._step
        begin, before = data.qpos.copy(), data.qvel.copy()
        if steps * h * float(np.abs(rates).sum()) > SHORT_WAY:
            return None
        held = self._needed()
        first = held + self._inertia @ (rates - before) / h
        way = h * rates
        for _ in range(steps - 1):
            data.qpos[:] += way
        data.qvel[:] = rates
        last = self._needed() if steps > 1 else first
        sure = SURE_SHARE * self._most
        if (
            (np.abs(first) <= self._most).all()
            and (np.abs(held) <= sure).all()
            and (np.abs(last) <= (sure if steps > 1 else self._most)).all()
            and (self.model.jnt_range[:, 0] <= data.qpos).all()
            and (data.qpos <= self.model.jnt_range[:, 1]).all()
        ):
            data.qpos[:] += way
            return _larger(first, last)
        self.place(begin, before)
        return None

    def _turn_once(self, rates: Floats) -> Floats:
        """One physics step under velocity motors, and their torques (n,) [Nm]."""
        needed, h = self._needed(), self._step
        self.data.qfrc_applied[:] = 0.0
        if self._pushes:
            self._add_pushes()
            needed = needed - self.data.qfrc_applied
        missing = (rates - self.data.qvel) / h
        torque = needed + self._inertia @ missing
        if np.isfinite(torque).all() and (np.abs(torque) > self._most).any():
            torque = self._limited(needed, missing)
        self.data.qfrc_applied[:] += torque
        self._mujoco.mj_step(self.model, self.data)
        return np.asarray(torque)

    def _limited(self, needed: Floats, missing: Floats) -> Floats:
        """The torques (n,) [Nm] that miss the rates least: a motor at its limit, or its rate kept.

        Least is (tau - tau_c)' H^-1 (tau - tau_c) with tau_c that of all rates: its gradient is the
        acceleration that is missing, which is zero where a torque lies between its limits.
        """
        mobility = np.linalg.inv(self._inertia)
        torque = np.zeros_like(needed)
        gradient = -(mobility @ needed) - missing
        self._mujoco.mju_boxQP(
            torque, self._work, None, mobility, gradient, -self._most, self._most
        )
        return torque

    def _needed(self) -> Floats:
        """The torques (n,) [Nm] that keep the rates as they are; the inertia is set, too."""
        mj, model, data = self._mujoco, self.model, self.data
        mj.mj_fwdPosition(model, data)
        mj.mj_fwdVelocity(model, data)
        mj.mj_fullM(model, data, self._inertia)
        needed: Floats = data.qfrc_bias - data.qfrc_passive
        return needed

    def _add_pushes(self) -> None:
        """Add the generalised forces of pushes in the present posture."""
        data = self.data
        for link, force in self._pushes.of_next_step():
            body = self.model.jnt_bodyid[link - 1] if link else self._flange
            point = data.xipos[body]  # the link's own centre of mass
            if not link:
                flange = dq.pose_from(data.xpos[body], data.xquat[body])
                point = dq.translation(dq.mul(flange, self._tool))
            self._mujoco.mj_applyFT(
                self.model, data, force, np.zeros(3), point, body, data.qfrc_applied
            )


def _larger(first: Floats, last: Floats) -> Floats:
    return np.where(np.abs(first) >= np.abs(last), first, last)


def _without_shapes(text: str) -> str:
    """A description without shapes, in which MuJoCo keeps every link as a body of its own."""
    robot = Xml.fromstring(text)
    for link in robot.iter("link"):
        for shape in [*link.findall("visual"), *link.findall("collision")]:
            link.remove(shape)
    extension = Xml.SubElement(robot, "mujoco")
    Xml.SubElement(extension, "compiler", fusestatic="false")
    return Xml.tostring(robot, encoding="unicode")

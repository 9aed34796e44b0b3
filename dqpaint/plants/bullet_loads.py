"""Payloads and pushes of a world -> loads on an arm of rigid bodies."""

from collections.abc import Callable
from typing import TYPE_CHECKING
from xml.etree import ElementTree as Xml

import numpy as np

from dqpaint import dq
from dqpaint.dq import Floats
from dqpaint.errors import UsageError
from dqpaint.plants.world import ForceCourse, Payload, Push, World
from dqpaint.robots.bullet import bullet
from dqpaint.robots.model import Card

if TYPE_CHECKING:
    from dqpaint.plants.bullet_arm import RigidArm

BLOCK = 4096  # steps whose forces are read at once


def with_payloads(text: str, card: Card, payloads: tuple[Payload, ...]) -> str:
    """The URDF of a card's arm with payloads fixed to it, centred at the light."""
    if not payloads:
        return text
    robot = Xml.fromstring(text)
    for number, load in enumerate(payloads):
        moment = repr(0.4 * load.mass * load.radius**2)
        link = Xml.SubElement(robot, "link", name=f"payload {number}")
        body = Xml.SubElement(link, "inertial")
        Xml.SubElement(body, "mass", value=repr(load.mass))
        about = dict.fromkeys(("ixx", "iyy", "izz"), moment)
        Xml.SubElement(body, "inertia", {**about, **dict.fromkeys(("ixy", "ixz", "iyz"), "0")})
        joint = Xml.SubElement(robot, "joint", name=f"payload {number}", type="fixed")
        Xml.SubElement(joint, "parent", link=card.link)
        Xml.SubElement(joint, "child", link=f"payload {number}")
        Xml.SubElement(joint, "origin", xyz=" ".join(map(repr, card.tool.at_m)), rpy="0 0 0")
    return Xml.tostring(robot, encoding="unicode")


def check_pushes(world: World, card: Card) -> None:
    """Check that the pushed links exist.

    Raises:
        UsageError: a link the arm does not have.
    """
    for push in world.pushes:
        if push.link > card.joints:
            raise UsageError(
                f"disturbance 'push': link {push.link}, but {card.name} has {card.joints} links "
                "that move; 0 is the tool"
            )


class TimedPush:
    """Physics steps with pushes; PyBullet clears a force after each step."""

    def __init__(self, arm: "RigidArm", world: World) -> None:
        self._arm, self._world = arm, world
        self._courses = [(push.link, _course(push, arm.step)) for push in world.pushes]
        self._flange = self._link_named(arm.card.link)
        self._tool = arm.card.tool.pose
        self._done = 0  # steps

    def __call__(self) -> None:
        """Run one step."""
        for link, course in self._courses:
            force = course(self._done)
            if force is not None:
                self._push(link, self._world.in_base(force).tolist())
        bullet.stepSimulation(self._arm.client)
        self._done += 1

    def _push(self, number: int, force: list[float]) -> None:
        arm = self._arm
        link = arm.joints[number - 1] if number else self._flange
        state = bullet.getLinkState(
            arm.body, link, computeForwardKinematics=True, physicsClientId=arm.client
        )
        point = state[0]  # the centre of mass
        if not number:
            x, y, z, w = state[5]
            flange = dq.pose_from(state[4], np.array([w, x, y, z]))
            point = dq.translation(dq.mul(flange, self._tool)).tolist()
        bullet.applyExternalForce(
            arm.body, link, force, point, bullet.WORLD_FRAME, physicsClientId=arm.client
        )

    def _link_named(self, name: str) -> int:
        arm = self._arm
        count = bullet.getNumJoints(arm.body, physicsClientId=arm.client)
        names = [
            bullet.getJointInfo(arm.body, i, physicsClientId=arm.client)[12].decode()
            for i in range(count)
        ]
        return names.index(name)


def _course(push: Push | ForceCourse, step: float) -> Callable[[int], Floats | None]:
    """The force (3,) [N] of each physics step, by its number; None where there is none."""
    if isinstance(push, ForceCourse):
        return _Sampled(push, step)
    force = np.array(push.force)
    first = round(push.start / step)  # it begins and ends with the step nearest in time
    last = first + round(push.seconds / step)
    return lambda done: force if first <= done < last else None


class _Sampled:
    """A course of forces, sampled in the middle of each step, a block of steps at a time."""

    def __init__(self, course: ForceCourse, step: float) -> None:
        self._forces, self._step = course.forces, step
        self._block: Floats = np.zeros((0, 3))
        self._first = 0

    def __call__(self, done: int) -> Floats | None:
        """The force of a step."""
        if not self._first <= done < self._first + len(self._block):
            self._first = done
            middles = (done + 0.5 + np.arange(BLOCK, dtype=np.float64)) * self._step
            self._block = self._forces(np.asarray(middles))
        force = self._block[done - self._first]
        return force if force.any() else None

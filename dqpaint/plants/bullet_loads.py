"""Payloads and pushes of a world -> loads on an arm of rigid bodies."""

from typing import TYPE_CHECKING
from xml.etree import ElementTree as Xml

import numpy as np

from dqpaint import dq
from dqpaint.errors import UsageError
from dqpaint.plants.world import Payload, Push, World
from dqpaint.robots.bullet import bullet
from dqpaint.robots.model import Card

if TYPE_CHECKING:
    from dqpaint.plants.bullet_arm import RigidArm


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
        self._arm, self._pushes = arm, world.pushes
        self._forces = [world.in_base(np.array(push.force)).tolist() for push in world.pushes]
        self._flange = self._link_named(arm.card.link)
        self._tool = arm.card.tool.pose
        self._done = 0  # steps

    def __call__(self) -> None:
        """Run one step; a push begins and ends with the step nearest in time."""
        for push, force in zip(self._pushes, self._forces, strict=True):
            first = round(push.start / self._arm.step)
            if first <= self._done < first + round(push.seconds / self._arm.step):
                self._push(push, force)
        bullet.stepSimulation(self._arm.client)
        self._done += 1

    def _push(self, push: Push, force: list[float]) -> None:
        arm = self._arm
        link = arm.joints[push.link - 1] if push.link else self._flange
        state = bullet.getLinkState(
            arm.body, link, computeForwardKinematics=True, physicsClientId=arm.client
        )
        point = state[0]  # the centre of mass
        if not push.link:
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

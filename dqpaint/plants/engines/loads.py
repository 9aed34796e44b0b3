"""Payloads and pushes of a world -> masses in an arm's description, and forces by physics step."""

from collections.abc import Callable, Iterator
from xml.etree import ElementTree as Xml

import numpy as np

from dqpaint.dq import Floats
from dqpaint.errors import UsageError
from dqpaint.plants.world import ForceCourse, Payload, Push, World
from dqpaint.robots.model import Card

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


class Pushes:
    """The pushes of a world, step by step.

    Raises:
        UsageError: a push on a link that the arm does not have.
    """

    def __init__(self, world: World, card: Card, step: float) -> None:
        for push in world.pushes:
            if push.link > card.joints:
                raise UsageError(
                    f"disturbance 'push': link {push.link}, but {card.name} has {card.joints} "
                    "links that move; 0 is the tool"
                )
        self._world = world
        self._courses = [(push.link, _course(push, step)) for push in world.pushes]
        self._done = 0  # steps

    def __bool__(self) -> bool:
        """Whether there are any."""
        return bool(self._courses)

    def of_next_step(self) -> Iterator[tuple[int, Floats]]:
        """The link, from 1, or 0 for the tool, and the force (3,) [N] on it, in the base frame."""
        for link, course in self._courses:
            force = course(self._done)
            if force is not None:
                yield link, self._world.in_base(force)
        self._done += 1


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

"""An arm's description as the libraries read it: whole, checked, and the same for all of them.

PyBullet and pinocchio read one text. What they would answer differently, or with a guess of their
own, is settled in it: joints off the arm stand still, every link has a mass, every mesh its path.
"""

import math
import os
import tempfile
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path
from typing import NamedTuple
from xml.etree import ElementTree as Xml

import numpy as np

from dqpaint.dq import Floats
from dqpaint.errors import DqpaintError, UsageError
from dqpaint.robots.built import WEIGHTLESS, write_urdf
from dqpaint.robots.card import Card

BALL = 0.05  # [m], radius of the ball that stands for a shape nobody gave
LIGHTEST = 0.1  # [kg], of a link that moves and has no mass
TURNING = ("revolute", "continuous")


class Prepared(NamedTuple):
    """A description, and what had to be assumed for it, a sentence each."""

    text: str
    notes: tuple[str, ...]


def prepare(card: Card) -> Prepared:
    """The description of a card's arm.

    Raises:
        UsageError: its package is not installed, its file is not there, or it has no such link.
        DqpaintError: the file is no tree of links, or the arm has joints that do not turn.
    """
    if card.urdf is None:
        return Prepared(write_urdf(card), ())
    tree = Tree(card.urdf.path)
    return tree.prepare(card)


@contextmanager
def urdf_file(card: Card) -> Iterator[str]:
    """The description as a file of its own, for libraries that read nothing else; gone afterwards.

    Its name is new each time: PyBullet remembers files by their names.
    """
    handle, path = tempfile.mkstemp(prefix="dqpaint-", suffix=".urdf")
    try:
        with os.fdopen(handle, "w", encoding="utf-8") as file:
            file.write(prepare(card).text)
        yield path
    finally:
        os.unlink(path)


@dataclass(frozen=True)
class Joint:
    """A joint of a description: what it joins, and its element."""

    name: str
    kind: str
    parent: str
    child: str
    element: Xml.Element

    def limit(self, what: str) -> float | None:
        """`lower`, `upper` [rad], `velocity` [rad/s] or `effort` [Nm]; None where not said."""
        limit = self.element.find("limit")
        value = None if limit is None else limit.get(what)
        try:
            number = float(value) if value is not None else None
        except ValueError:
            number = math.nan
        if number is not None and not math.isfinite(number):
            raise DqpaintError(f"joint '{self.name}': {what} '{value}' is not a number")
        return number


class Tree:
    """The links and joints of a URDF file, found to be one tree.

    Attributes:
        path: of the file.
        links: their elements, by name.
        joints: by the name of the link each one carries.
        root: the link nothing carries.
    """

    def __init__(self, path: Path) -> None:
        self.path = path
        self._robot = _parse(path)
        self.links: dict[str, Xml.Element] = {}
        for element in self._robot.findall("link"):
            name = element.get("name", "")
            if not name or name in self.links:
                raise self._fault(f"two links named '{name}'" if name else "a link has no name")
            self.links[name] = element
        self.joints: dict[str, Joint] = {}
        for element in self._robot.findall("joint"):
            joint = self._joint(element)
            if joint.child in self.joints:
                other = self.joints[joint.child].name
                raise self._fault(
                    f"joints '{other}' and '{joint.name}' both carry link '{joint.child}': "
                    "a loop of links is no arm"
                )
            self.joints[joint.child] = joint
        self.root = self._find_root()

    @property
    def tips(self) -> list[str]:
        """The links that carry no other."""
        parents = {joint.parent for joint in self.joints.values()}
        return [name for name in self.links if name not in parents]

    def chain(self, link: str) -> list[Joint]:
        """The joints from the root to a link."""
        found: list[Joint] = []
        while link in self.joints:
            found.append(self.joints[link])
            link = found[-1].parent
        return found[::-1]

    def prepare(self, card: Card) -> Prepared:
        """The description of an arm that ends at the card's link."""
        if card.link not in self.links:
            raise UsageError(
                f"robot '{card.name}' has no link named '{card.link}'; known: {_some(self.links)}"
            )
        arm = self.chain(card.link)
        self._still(arm, card)
        if card.urdf is not None and card.urdf.products_negated:
            self._negate_products()
        notes = [*self._weigh(), *self._find_meshes()]
        return Prepared(Xml.tostring(self._robot, encoding="unicode"), tuple(notes))

    def _still(self, arm: list[Joint], card: Card) -> None:
        """Fix every joint that is not of the arm; those that are turn within the card's limits."""
        number = 0
        for joint in self.joints.values():
            mimic = joint.element.find("mimic")
            if mimic is not None:
                joint.element.remove(mimic)
            if joint not in arm:
                joint.element.set("type", "fixed")
        for joint in arm:
            if joint.kind == "fixed":
                continue
            if joint.kind not in TURNING:
                raise self._fault(
                    f"joint '{joint.name}' is {joint.kind}, and lies between the base and "
                    f"'{card.link}': only joints that turn are known"
                )
            if number < card.joints:
                limit = joint.element.find("limit")
                if limit is None:
                    limit = Xml.SubElement(joint.element, "limit")
                limit.set("lower", repr(float(card.lower[number])))
                limit.set("upper", repr(float(card.upper[number])))
                limit.set("velocity", repr(float(card.speed[number])))
                limit.set("effort", repr(float(card.effort[number])))
            joint.element.set("type", "revolute")
            number += 1

    def _negate_products(self) -> None:
        for inertia in self._robot.iter("inertia"):
            for name in ("ixy", "ixz", "iyz"):
                value = inertia.get(name, "0")
                inertia.set(name, value[1:] if value.startswith("-") else f"-{value}")

    def _weigh(self) -> Iterator[str]:
        """Give every link a mass, and say which ones of it are guesses."""
        for body in self._bodies():
            weights = {name: self._mass(name) for name in body}
            moving = self.root not in body
            for name in body:
                element = self.links[name]
                if element.find("inertial") is None:
                    _set_inertial(element, 0.0, WEIGHTLESS)
                elif moving and weights[name] > 0:
                    yield from self._judge(name, weights[name])
            if moving and sum(weights.values()) == 0:
                ball = 0.4 * LIGHTEST * BALL**2
                _set_inertial(self.links[body[0]], LIGHTEST, ball)
                yield (
                    f"link '{body[0]}' moves and has no mass: "
                    f"{LIGHTEST} kg in a ball of {BALL * 1e3:.0f} mm is assumed"
                )

    def _judge(self, name: str, mass: float) -> Iterator[str]:
        """Whether a link's inertia can be that of a body; nothing at all is replaced."""
        moments = _moments(self.links[name])
        if not np.isfinite(moments).all():
            raise self._fault(f"the inertia of link '{name}' is not six numbers")
        if not moments.any():
            _set_inertial(self.links[name], mass, 0.4 * mass * BALL**2, keep_origin=True)
            yield (
                f"link '{name}' has a mass and no inertia: "
                f"that of a ball of {BALL * 1e3:.0f} mm is assumed"
            )
        elif not possible(moments):
            yield f"the inertia of link '{name}' is not that of any body: its motion may look odd"

    def _bodies(self) -> list[list[str]]:
        """The links that move as one, the first of each being the one its joint carries."""
        heads: dict[str, str] = {}

        def head(name: str) -> str:
            joint = self.joints.get(name)
            if joint is None or joint.element.get("type") != "fixed":
                return name
            return head(joint.parent)

        for name in self.links:
            heads[name] = head(name)
        bodies: dict[str, list[str]] = {name: [name] for name in heads.values()}
        for name, first in heads.items():
            if name != first:
                bodies[first].append(name)
        return list(bodies.values())

    def _mass(self, name: str) -> float:
        """Of a link [kg]; 0 where the file does not say."""
        element = self.links[name].find("inertial/mass")
        text = "0" if element is None else element.get("value", "")
        try:
            mass = float(text)
        except ValueError:
            mass = math.nan
        if not (math.isfinite(mass) and mass >= 0):
            raise self._fault(f"the mass of link '{name}' is '{text}', not a number of kg")
        return mass

    def _find_meshes(self) -> Iterator[str]:
        """Give each mesh its full path; say which are not there."""
        missing = []
        for mesh in self._robot.iter("mesh"):
            name = mesh.get("filename", "")
            found = self._find(name.removeprefix("package://").removeprefix("file://"))
            if found is None:
                missing.append(name)
            else:
                mesh.set("filename", str(found))
        if missing:
            more = f" and {len(set(missing)) - 1} more" if len(set(missing)) > 1 else ""
            yield f"mesh '{missing[0]}'{more} is not there: the arm's shape cannot be shown"

    def _find(self, name: str) -> Path | None:
        path = Path(name)
        if path.is_absolute():
            return path if path.is_file() else None
        inner = Path(*path.parts[1:])  # without the name of a ROS package
        for folder in self.path.resolve().parents:
            for candidate in (folder / path, folder / inner):
                if candidate.is_file():
                    return candidate
        return None

    def _joint(self, element: Xml.Element) -> Joint:
        name, kind = element.get("name", ""), element.get("type", "")
        ends = []
        for end in ("parent", "child"):
            link = element.find(end)
            named = "" if link is None else link.get("link", "")
            if named not in self.links:
                what = f"names the {end} '{named}', which is no link" if named else f"has no {end}"
                raise self._fault(f"joint '{name}' {what}")
            ends.append(named)
        return Joint(name, kind, ends[0], ends[1], element)

    def _find_root(self) -> str:
        """The one link that no joint carries, from which all others are reached."""
        roots = [name for name in self.links if name not in self.joints]
        if len(roots) > 1:
            raise self._fault(f"links {_some(roots)} are not joined to each other")
        for start in self.links:
            seen = {start}
            link = start
            while link in self.joints:
                link = self.joints[link].parent
                if link in seen:
                    raise self._fault(f"link '{link}' carries itself: a loop of links is no arm")
                seen.add(link)
        if not roots:
            raise self._fault("it has no links")
        return roots[0]

    def _fault(self, text: str) -> DqpaintError:
        return DqpaintError(f"{self.path.name}: {text}")


def possible(moments: Floats) -> bool:
    """Whether an inertia (3, 3) can be a body's.

    Its principal moments are positive, and none exceeds the sum of the others.
    """
    small, middle, large = np.linalg.eigvalsh(moments)
    return bool(small > 0 and small + middle >= large * (1 - 1e-9))


def _parse(path: Path) -> Xml.Element:
    try:
        robot = Xml.fromstring(path.read_bytes())
    except OSError as problem:
        raise UsageError(f"{path} cannot be read: {problem.strerror}") from None
    except Xml.ParseError as problem:
        raise DqpaintError(f"{path.name} is no URDF: {problem}") from None
    if robot.tag != "robot":
        raise DqpaintError(
            f"{path.name} is no URDF: it begins with <{robot.tag}>, not with <robot>"
        )
    if any("xacro" in child.tag for child in robot):
        raise DqpaintError(
            f"{path.name} is a xacro file: run xacro on it first, and give the result"
        )
    return robot


def _moments(link: Xml.Element) -> Floats:
    element = link.find("inertial/inertia")
    values = []
    for name in ("ixx", "ixy", "ixz", "iyy", "iyz", "izz"):
        try:
            values.append(float(element.get(name, "0")) if element is not None else 0.0)
        except ValueError:
            values.append(math.nan)
    xx, xy, xz, yy, yz, zz = values
    return np.array([[xx, xy, xz], [xy, yy, yz], [xz, yz, zz]])


def _set_inertial(link: Xml.Element, mass: float, moment: float, keep_origin: bool = False) -> None:
    """Replace what a link weighs by a ball's mass [kg] and moment [kg m^2]."""
    old = link.find("inertial")
    new = Xml.Element("inertial")
    if old is not None:
        origin = old.find("origin")
        if keep_origin and origin is not None:
            new.append(origin)
        link.remove(old)
    Xml.SubElement(new, "mass", value=repr(mass))
    diagonal = dict.fromkeys(("ixx", "iyy", "izz"), repr(moment))
    Xml.SubElement(new, "inertia", {**diagonal, **dict.fromkeys(("ixy", "ixz", "iyz"), "0")})
    link.append(new)


def _some(names: object) -> str:
    """A list of names, cut where it gets long."""
    listed = list(names)  # type: ignore[call-overload]
    more = f" and {len(listed) - 12} more" if len(listed) > 12 else ""
    return ", ".join(listed[:12]) + more

"""A URDF file -> its links and joints as one tree, with valid numbers."""

import math
from collections.abc import Iterable
from dataclasses import dataclass
from pathlib import Path
from xml.etree import ElementTree as Xml

import numpy as np

from dqpaint.core.inputs import parse_xml, read_regular
from dqpaint.dq import Floats
from dqpaint.errors import DqpaintError, UsageError

MOST_NAMED = 12  # names in a message
LARGEST_FILE = 5_000_000  # bytes
MOST_LINKS = 2000
MOST_JOINTS = 32  # that move the light
FARTHEST = 1e3  # [m] of an origin, a size or a scale; more is a slip
LARGEST_ANGLE = 1e6  # [rad] of an origin or a limit
LARGEST_NUMBER = 1e9  # of a mass, an inertia, a speed or a torque, in their units
ORIGIN = {"xyz": FARTHEST, "rpy": LARGEST_ANGLE}
LEAST_SCALE, LEAST_AXIS = 1e-6, 1e-6
LEAST_LIMIT = 1e-6  # [rad/s, Nm] below which a joint does not move; and its range [rad]
ROUND_SIZES = {"radius": 1, "length": 1}
SIZES: dict[str, dict[str, int]] = {
    "box": {"size": 3}, "sphere": {"radius": 1}, "cylinder": ROUND_SIZES, "capsule": ROUND_SIZES,
    "mesh": {},
}  # fmt: skip
REVOLUTE_KINDS = ("revolute", "continuous")


@dataclass(frozen=True)
class Joint:
    """A joint of a description, with its links and its XML element."""

    name: str
    kind: str
    parent: str
    child: str
    element: Xml.Element
    file: str

    def limit(self, what: str) -> float | None:
        """`lower`, `upper` [rad], `velocity` [rad/s] or `effort` [Nm]; None if missing."""
        limit = self.element.find("limit")
        value = None if limit is None else limit.get(what)
        try:
            number = float(value) if value is not None else None
        except ValueError:
            number = math.nan
        most = LARGEST_ANGLE if what in ("lower", "upper") else LARGEST_NUMBER
        if number is not None and not abs(number) <= most:
            raise DqpaintError(
                f"{self.file}: joint '{self.name}': {what} '{value}' is not a number up to {most:g}"
            )
        return number


class Tree:
    """The links and joints of a URDF file, checked to be one tree.

    Attributes:
        path: of the file.
        robot: the root element.
        links: their elements, by name.
        joints: by the name of the link each one carries.
        root: the link nothing carries.
    """

    def __init__(self, path: Path) -> None:
        self.path = path
        self.robot = _parse(path)
        self.links: dict[str, Xml.Element] = {}
        if (links := len(self.robot.findall("link"))) > MOST_LINKS:
            raise self.error(f"it has {links} links; at most {MOST_LINKS} are read")
        for element in self.robot.findall("link"):
            name = element.get("name", "")
            if not name or name in self.links:
                raise self.error(f"two links named '{name}'" if name else "a link has no name")
            self.links[name] = element
            self._check_shapes(element, name)
        self.joints: dict[str, Joint] = {}
        named: set[str] = set()
        for element in self.robot.findall("joint"):
            joint = self._joint(element)
            if not joint.name or joint.name in named:
                raise self.error(
                    f"two joints named '{joint.name}'" if joint.name else "a joint has no name"
                )
            named.add(joint.name)
            if joint.child in self.joints:
                other = self.joints[joint.child].name
                raise self.error(
                    f"joints '{other}' and '{joint.name}' share the child link '{joint.child}': "
                    "a loop of links is not supported"
                )
            self.joints[joint.child] = joint
        self.root = self._find_root()

    @property
    def tips(self) -> list[str]:
        """The links without child links."""
        parents = {joint.parent for joint in self.joints.values()}
        return [name for name in self.links if name not in parents]

    def chain(self, link: str) -> list[Joint]:
        """The joints from the root to a link."""
        found: list[Joint] = []
        while link in self.joints:
            found.append(self.joints[link])
            link = found[-1].parent
        return found[::-1]

    def arm(self, link: str) -> list[Joint]:
        """The joints that move a link, all of which are revolute.

        Raises:
            UsageError: there is no such link.
            DqpaintError: one of the joints slides, or floats.
        """
        if link not in self.links:
            raise UsageError(
                f"{self.path.name} has no link named '{link}'; known: {shortened_list(self.links)}"
            )
        joints = [joint for joint in self.chain(link) if joint.kind != "fixed"]
        for joint in joints:
            if joint.kind not in REVOLUTE_KINDS:
                raise self.error(
                    f"joint '{joint.name}' is {joint.kind}, and is between the base and "
                    f"'{link}': only revolute joints are supported"
                )
        if len(joints) > MOST_JOINTS:
            raise self.error(
                f"{len(joints)} joints turn between the base and '{link}'; at most {MOST_JOINTS} do"
            )
        return joints

    def _check_shapes(self, link: Xml.Element, name: str) -> None:
        """Check that a link's origins and shapes have finite numbers."""
        for part in ("inertial", "visual", "collision"):
            for element in link.findall(part):
                origin = element.find("origin")
                for attribute, most in ORIGIN.items():
                    text = "0 0 0" if origin is None else origin.get(attribute, "0 0 0")
                    if len(parse_numbers(text, most)) != 3:
                        raise self.error(
                            f"link '{name}': {part} origin {attribute}=\"{text[:60]}\" is not "
                            f"three numbers up to {most:g}"
                        )
                if part != "inertial":
                    self._check_geometry(element, f"link '{name}': {part}")

    def _check_geometry(self, shape: Xml.Element, where: str) -> None:
        geometry = shape.find("geometry")
        if geometry is None or len(geometry) == 0:
            raise self.error(f"{where} has no geometry")
        if geometry[0].tag not in SIZES:
            raise self.error(f"{where} is a {geometry[0].tag}; known: {', '.join(SIZES)}")
        scale = geometry[0].get("scale", "1 1 1")
        if geometry[0].tag == "mesh" and (
            len(parse_numbers(scale, FARTHEST)) != 3
            or (np.abs(parse_numbers(scale, FARTHEST)) < LEAST_SCALE).any()
        ):
            raise self.error(
                f'{where} mesh scale="{scale[:60]}" is not three numbers '
                f"from {LEAST_SCALE:g} to {FARTHEST:g}"
            )
        for attribute, count in SIZES[geometry[0].tag].items():
            text = geometry[0].get(attribute, "")
            values = parse_numbers(text, FARTHEST)
            if len(values) != count or (values < 0).any():
                what = "a number" if count == 1 else f"{count} numbers"
                raise self.error(
                    f'{where} {geometry[0].tag} {attribute}="{text[:60]}" is not {what} '
                    f"from 0 to {FARTHEST:g}"
                )

    def _joint(self, element: Xml.Element) -> Joint:
        name, kind = element.get("name", ""), element.get("type", "")
        ends = []
        for end in ("parent", "child"):
            link = element.find(end)
            named = "" if link is None else link.get("link", "")
            if named not in self.links:
                what = (
                    f"names the {end} '{named}', which is not a link" if named else f"has no {end}"
                )
                raise self.error(f"joint '{name}' {what}")
            ends.append(named)
        for attribute, most in ORIGIN.items():
            self._check_triple(element, "origin", attribute, most)
        self._check_triple(element, "axis", "xyz", LARGEST_NUMBER)
        dynamics = element.find("dynamics")
        for what in ("damping", "friction"):
            text = "0" if dynamics is None else dynamics.get(what, "0")
            said = parse_numbers(text, LARGEST_NUMBER)
            if len(said) != 1 or said[0] < 0:
                raise self.error(
                    f"joint '{name}': {what} '{text[:60]}' is not a number from 0 to "
                    f"{LARGEST_NUMBER:g}"
                )
        return Joint(name, kind, ends[0], ends[1], element, self.path.name)

    def _check_triple(self, joint: Xml.Element, part: str, attribute: str, most: float) -> None:
        """Check that a part of a joint, if it exists, has three numbers up to `most`."""
        element = joint.find(part)
        text = None if element is None else element.get(attribute)
        if text is None:
            return
        values = parse_numbers(text, most)
        turns = part == "axis" and joint.get("type") != "fixed"
        idle = turns and np.abs(values).max(initial=0.0) < LEAST_AXIS
        if len(values) != 3 or idle:
            raise self.error(
                f"joint '{joint.get('name')}': {part} {attribute}=\"{text[:60]}\" is not three "
                f"numbers up to {most:g}" + (", not all zero" if part == "axis" else "")
            )

    def _find_root(self) -> str:
        """The only link that is no child, from which all others are reachable."""
        roots = [name for name in self.links if name not in self.joints]
        if len(roots) > 1:
            raise self.error(f"links {shortened_list(roots)} are not connected to each other")
        rooted: set[str] = set()
        for start in self.links:
            way = {start}
            link = start
            while link in self.joints and link not in rooted:
                link = self.joints[link].parent
                if link in way:
                    raise self.error(
                        f"link '{link}' is its own descendant: a loop of links is not supported"
                    )
                way.add(link)
            rooted |= way
        if not roots:
            raise self.error("it has no links")
        return roots[0]

    def error(self, text: str) -> DqpaintError:
        """An error about this file."""
        return DqpaintError(f"{self.path.name}: {text}")


def _parse(path: Path) -> Xml.Element:
    try:
        robot = parse_xml(read_regular(path, LARGEST_FILE))
    except OSError as problem:
        raise DqpaintError(f"robot '{path}' cannot be read: {problem.strerror}") from None
    except ValueError as problem:
        raise DqpaintError(f"{path.name} is not a valid URDF: {problem}") from None
    if robot.tag != "robot":
        raise DqpaintError(
            f"{path.name} is not a URDF: it begins with <{robot.tag}>, not with <robot>"
        )
    if not robot.get("name"):
        robot.set(
            "name", path.stem or "robot"
        )  # libraries insist on one, and nothing depends on it
    if any("xacro" in child.tag for child in robot.iter()):
        raise DqpaintError(f"{path.name} is a xacro file: run xacro on it first and use the result")
    return robot


def parse_numbers(text: str, most: float) -> Floats:
    """The numbers of a text, separated by spaces; empty if a word is not one up to `most`."""
    try:
        values = np.array([float(word) for word in text.split()])
    except ValueError:
        return np.zeros(0)
    return values if (np.abs(values) <= most).all() else np.zeros(0)


def shortened_list(names: Iterable[str]) -> str:
    """A list of names, shortened if it is long."""
    listed = list(names)
    more = f" and {len(listed) - MOST_NAMED} more" if len(listed) > MOST_NAMED else ""
    return ", ".join(listed[:MOST_NAMED]) + more

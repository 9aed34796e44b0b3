"""A card with rows, screw axes or numbers -> a URDF whose links are capsules.

With rows or axes every frame is parallel to the base at q = 0, so each joint is a position and the
direction of its axis, and only the flange is turned; numbers have frames of their own.
"""

from collections.abc import Iterable
from dataclasses import replace
from xml.etree import ElementTree as Xml

import numpy as np

from dqpaint import dq
from dqpaint.dq import Floats
from dqpaint.robots.model.card import FLANGE, Card
from dqpaint.robots.model.numbers import Numbers
from dqpaint.robots.urdf.capsules import Capsule, Link, build_links

LEAST_INERTIA = 1e-12  # [kg m^2]: PyBullet takes a link of nothing at all to weigh 1 kg
COLOURS = {"shell": "0.86 0.87 0.88 1", "hub": "0.16 0.42 0.62 1"}


def write_urdf(card: Card) -> str:
    """The URDF of a card with rows or axes; the same card gives the same text."""
    assert card.axes is not None
    assert card.body is not None
    screws = card.axes
    links = build_links(screws, card.body.mass_kg, card.body.radius_m)
    robot, names = _robot(card), ["base", *(f"link{i}" for i in range(1, len(links)))]
    for name, link in zip(names, links, strict=True):
        _link(robot, name, link)
    for i in range(1, len(links)):
        joint = _moving_joint(robot, card, i, names[i - 1], names[i], screws.axes[i - 1, :3])
        _origin(joint, links[i].pose - links[i - 1].pose)
    T = dq.matrix_from_pose(screws.home)
    _flange(robot, FLANGE, names[-1], T[:3, 3] - links[-1].pose, T[:3, :3])
    Xml.indent(robot)
    return Xml.tostring(robot, encoding="unicode")


def write_numbers(card: Card, numbers: Numbers) -> str:
    """The URDF of an arm whose own is not installed: its chain and masses, shapes of our own."""
    masses = [link.mass_kg for link in numbers.links]
    shapes = build_links(numbers.screws, masses, numbers.radius_m)
    robot, names = _robot(card), ["base", *(f"body{i}" for i in range(1, len(shapes)))]
    _link(robot, names[0], shapes[0])
    for i, (one, pose) in enumerate(zip(numbers.links, numbers.frames, strict=True), start=1):
        R, t = dq.matrix_from_quaternion(dq.rotation(pose)), dq.translation(pose)
        solids = tuple(
            replace(solid, start=R.T @ (solid.start - t), end=R.T @ (solid.end - t))
            for solid in shapes[i].solids
        )
        centre = np.array(one.centre_m)
        _link(robot, names[i], Link(np.zeros(3), solids, one.mass_kg, centre, one.inertia))
        joint = _moving_joint(robot, card, i, names[i - 1], names[i], np.array([0.0, 0.0, 1.0]))
        _origin(joint, np.array(one.at_m), dq.matrix_from_pose(one.pose)[:3, :3])
        Xml.SubElement(joint, "dynamics", damping=repr(one.friction_Nm_s))
    T = dq.matrix_from_pose(numbers.flange.pose)
    _flange(robot, card.link, names[-1], T[:3, 3], T[:3, :3])
    Xml.indent(robot)
    return Xml.tostring(robot, encoding="unicode")


def _robot(card: Card) -> Xml.Element:
    robot = Xml.Element("robot", name=card.name)
    for name, colour in COLOURS.items():
        material = Xml.SubElement(robot, "material", name=name)
        Xml.SubElement(material, "color", rgba=colour)
    return robot


def _moving_joint(
    robot: Xml.Element, card: Card, number: int, parent: str, child: str, axis: Floats
) -> Xml.Element:
    joint = _joint(robot, f"joint{number}", "revolute", parent, child)
    Xml.SubElement(joint, "axis", xyz=_text(axis))
    lower, upper, speed, effort = (
        repr(float(values[number - 1]))
        for values in (card.lower, card.upper, card.speed, card.effort)
    )
    Xml.SubElement(joint, "limit", lower=lower, upper=upper, velocity=speed, effort=effort)
    return joint


def _flange(robot: Xml.Element, name: str, parent: str, place: Floats, rotation: Floats) -> None:
    """The last frame, a link of nothing."""
    flange = Xml.SubElement(robot, "link", name=name)
    _inertial(flange, np.zeros(3), 0.0, LEAST_INERTIA * np.eye(3))
    joint = _joint(robot, name, "fixed", parent, name)
    _origin(joint, place, rotation)


def _joint(robot: Xml.Element, name: str, kind: str, parent: str, child: str) -> Xml.Element:
    joint = Xml.SubElement(robot, "joint", name=name, type=kind)
    Xml.SubElement(joint, "parent", link=parent)
    Xml.SubElement(joint, "child", link=child)
    return joint


def _link(robot: Xml.Element, name: str, link: Link) -> None:
    element = Xml.SubElement(robot, "link", name=name)
    _inertial(element, link.centre - link.pose, link.mass, link.inertia)
    for solid in link.solids:
        _capsule(element, solid, link.pose)


def _inertial(link: Xml.Element, centre: Floats, mass: float, inertia: Floats) -> None:
    element = Xml.SubElement(link, "inertial")
    _origin(element, centre)
    Xml.SubElement(element, "mass", value=repr(float(mass)))
    moments = {f"i{'xyz'[i]}{'xyz'[j]}": inertia[i, j] for i in range(3) for j in range(i, 3)}
    Xml.SubElement(
        element, "inertia", {name: repr(float(value)) for name, value in moments.items()}
    )


def _capsule(link: Xml.Element, solid: Capsule, place: Floats) -> None:
    """A cylinder and two spheres, as URDF has no capsules."""
    along = solid.end - solid.start
    length, radius = float(np.linalg.norm(along)), repr(float(solid.radius))
    kinds = ("visual", "collision")
    material = "hub" if solid.hub else "shell"
    if length > 0:
        rotation = _rotation_to(along / length)
        for shape in _shapes(link, kinds, solid.centre - place, rotation, material):
            Xml.SubElement(shape, "cylinder", radius=radius, length=repr(length))
    for end in (solid.start, solid.end):
        for shape in _shapes(link, kinds, end - place, np.eye(3), material):
            Xml.SubElement(shape, "sphere", radius=radius)


def _shapes(
    link: Xml.Element, kinds: Iterable[str], place: Floats, rotation: Floats, material: str
) -> Iterable[Xml.Element]:
    for kind in kinds:
        element = Xml.SubElement(link, kind)
        _origin(element, place, rotation)
        yield Xml.SubElement(element, "geometry")
        if kind == "visual":
            Xml.SubElement(element, "material", name=material)


def _rotation_to(direction: Floats) -> Floats:
    """A rotation (3, 3) with a unit vector as its z axis."""
    side = np.eye(3)[np.argmin(np.abs(direction))]
    x = dq.cross(side, direction)
    x = x / np.linalg.norm(x)
    return np.stack([x, dq.cross(direction, x), direction], axis=1)


def _origin(element: Xml.Element, place: Floats, rotation: Floats | None = None) -> None:
    turn = np.zeros(3) if rotation is None else roll_pitch_yaw(rotation)
    Xml.SubElement(element, "origin", xyz=_text(place), rpy=_text(turn))


def roll_pitch_yaw(R: Floats) -> Floats:
    """The fixed-axis angles (3,) [rad] of R = Rz Ry Rx; exact at pitch +-90 degrees, too.

    Roll is measured after yaw is undone: where the two are indistinguishable, any yaw will do.
    """
    yaw = np.arctan2(R[1, 0], R[0, 0])
    s, c = np.sin(yaw), np.cos(yaw)
    pitch = np.arctan2(-R[2, 0], np.hypot(R[0, 0], R[1, 0]))
    roll = np.arctan2(s * R[0, 2] - c * R[1, 2], c * R[1, 1] - s * R[0, 1])
    return np.array([roll, pitch, yaw])


def _text(numbers: Floats) -> str:
    return " ".join(repr(float(x) + 0.0) for x in numbers)

"""The URDF of an arm -> a complete, checked description that all libraries read alike.

PyBullet and pinocchio read one text. What they would answer differently, or with a guess of their
own, is settled in it: joints outside the arm are fixed, every link has a mass, every mesh its path.
"""

import math
import os
import tempfile
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import NamedTuple
from xml.etree import ElementTree as Xml

import numpy as np

from dqpaint.dq import Floats
from dqpaint.errors import UsageError
from dqpaint.robots.model.card import Card
from dqpaint.robots.urdf.meshes import MOST_TRIANGLES, MeshError, check_mesh, try_meshes
from dqpaint.robots.urdf.tree import FARTHEST, LARGEST_NUMBER, Joint, Tree, parse_numbers
from dqpaint.robots.urdf.write import LEAST_INERTIA, write_numbers, write_urdf

GUESSED_BALL_RADIUS = 0.05  # [m], radius of the ball that replaces a missing shape
GUESSED_MASS = 0.1  # [kg], of a link that moves and has no mass


class PreparedUrdf(NamedTuple):
    """A description, and the assumptions made for it, one sentence each."""

    text: str
    notes: tuple[str, ...]
    whole: bool = True  # whether every mesh is there


def prepare(card: Card) -> PreparedUrdf:
    """The description of a card's arm.

    Raises:
        UsageError: its package is not installed, its file is not there, or it has no such link.
        DqpaintError: the file is no tree of links, or the arm has joints that do not turn.
    """
    if card.numbers is not None and card.is_of_numbers:
        return PreparedUrdf(write_numbers(card, card.numbers), ())
    if card.urdf is None:
        return PreparedUrdf(write_urdf(card), ())
    tree = Tree(card.urdf.path)
    arm = tree.arm(card.link)
    if len(arm) != card.joints:
        raise UsageError(
            f"robot '{card.name}' has {len(arm)} joints that move, "
            f"its card gives limits for {card.joints}"
        )
    _strip(tree)
    _fix_other_joints(tree, arm, card)
    if card.urdf.products_negated:
        _negate_products(tree)
    if card.urdf.frictionless:
        for joint in tree.joints.values():
            for dynamics in joint.element.findall("dynamics"):
                joint.element.remove(dynamics)
    weighed, missing = list(_add_masses(tree)), list(_find_meshes(tree, bool(card.urdf.package)))
    text = Xml.tostring(tree.robot, encoding="unicode")
    return PreparedUrdf(text, (*weighed, *missing), not missing)


@contextmanager
def urdf_file(card: Card, change: Callable[[str], str] = str) -> Iterator[str]:
    """The description as a temporary file, for libraries that read only files.

    Its name is new each time: PyBullet remembers files by their names.

    Args:
        card: of the arm.
        change: applied to the description first.
    """
    handle, path = tempfile.mkstemp(prefix="dqpaint-", suffix=".urdf")
    try:
        with os.fdopen(handle, "w", encoding="utf-8") as file:
            file.write(change(prepare(card).text))
        yield path
    finally:
        os.unlink(path)


def _strip(tree: Tree) -> None:
    """Remove elements that affect neither motion nor looks: libraries fail on errors in them."""
    tree.robot.attrib.pop("version", None)
    _set_materials(tree)
    for element in list(tree.robot):
        if element.tag not in ("link", "joint"):
            tree.robot.remove(element)
    for joint in tree.joints.values():
        for idle in ("safety_controller", "calibration"):
            for element in joint.element.findall(idle):
                joint.element.remove(element)


def _set_materials(tree: Tree) -> None:
    """Give each shape with a valid colour, or the name of one, a material with that colour."""
    known = {one.get("name", ""): _rgba(one) for one in tree.robot.iter("material") if _rgba(one)}
    for visual in tree.robot.iter("visual"):
        for material in visual.findall("material"):
            name = material.get("name", "")
            rgba = _rgba(material) or known.get(name)
            visual.remove(material)
            if rgba:
                kept = Xml.SubElement(visual, "material", {"name": name or rgba})
                Xml.SubElement(kept, "color", {"rgba": rgba})


def _rgba(material: Xml.Element) -> str:
    """The text of a material's colour; empty if it is missing or not four shares of one."""
    colour = material.find("color")
    written = "" if colour is None else colour.get("rgba", "")
    shares = parse_numbers(written, 1.0)
    sound = len(shares) == 4 and (shares >= 0.0).all() and (shares <= 1.0).all()
    return written if sound else ""


def _fix_other_joints(tree: Tree, arm: list[Joint], card: Card) -> None:
    """Fix every joint outside the arm; the arm's joints get the card's limits."""
    for joint in tree.joints.values():
        mimic = joint.element.find("mimic")
        if mimic is not None:
            joint.element.remove(mimic)
        if joint not in arm:
            joint.element.set("type", "fixed")
    limits = {
        "lower": card.lower, "upper": card.upper, "velocity": card.speed, "effort": card.effort
    }  # fmt: skip
    for i, joint in enumerate(arm):
        joint.element.set("type", "revolute")
        element = joint.element.find("limit")
        if element is None:
            element = Xml.SubElement(joint.element, "limit")
        for name, values in limits.items():
            element.set(name, repr(float(values[i])))


def _negate_products(tree: Tree) -> None:
    for inertia in tree.robot.iter("inertia"):
        for name in ("ixy", "ixz", "iyz"):
            value = inertia.get(name, "0")
            inertia.set(name, value[1:] if value.startswith("-") else f"-{value}")


def _add_masses(tree: Tree) -> Iterator[str]:
    """Give every link a mass, and note which masses are guesses."""
    for body in _bodies(tree):
        weights = {name: _mass(tree, name) for name in body}
        moving = tree.root not in body
        for name in body:
            element = tree.links[name]
            inertial = element.find("inertial")
            if inertial is None:
                _set_inertial(element, 0.0, LEAST_INERTIA)
            elif weights[name] == 0 and (
                inertial.find("mass") is None or inertial.find("inertia") is None
            ):
                _set_inertial(element, 0.0, LEAST_INERTIA, keep_origin=True)
            elif weights[name] > 0 and (moving or inertial.find("inertia") is None):
                yield from _check_inertia(tree, name, weights[name])
        if moving and sum(weights.values()) == 0:
            ball = 0.4 * GUESSED_MASS * GUESSED_BALL_RADIUS**2
            _set_inertial(tree.links[body[0]], GUESSED_MASS, ball)
            yield (
                f"link '{body[0]}' moves but has no mass: "
                f"{GUESSED_MASS} kg in a ball of {GUESSED_BALL_RADIUS * 1e3:.0f} mm is assumed"
            )


def _check_inertia(tree: Tree, name: str, mass: float) -> Iterator[str]:
    """Check that a body can have a link's inertia; otherwise PyBullet would invent one."""
    moments = _moments(tree.links[name])
    if not (np.abs(moments) <= LARGEST_NUMBER).all():
        raise tree.error(
            f"the inertia of link '{name}' is not six numbers up to {LARGEST_NUMBER:g}"
        )
    if not moments.any():
        _set_inertial(tree.links[name], mass, 0.4 * mass * GUESSED_BALL_RADIUS**2, keep_origin=True)
        yield (
            f"link '{name}' has a mass but no inertia: "
            f"that of a ball of {GUESSED_BALL_RADIUS * 1e3:.0f} mm is assumed"
        )
    elif not is_valid_inertia(moments):
        moment = float(np.abs(np.trace(moments))) / 3
        _set_inertial(tree.links[name], mass, moment, keep_origin=True)
        yield (
            f"the inertia of link '{name}' is not physically possible: "
            "that of a ball with the same sum of moments is assumed"
        )


def _bodies(tree: Tree) -> list[list[str]]:
    """The links that move together; the first of each group is the child of its joint."""
    heads: dict[str, str] = {}

    for name in tree.links:
        way = [name]
        while way[-1] not in heads:
            joint = tree.joints.get(way[-1])
            if joint is None or joint.element.get("type") != "fixed":
                heads[way[-1]] = way[-1]
            else:
                way.append(joint.parent)
        heads.update(dict.fromkeys(way, heads[way[-1]]))
    bodies: dict[str, list[str]] = {name: [name] for name in heads.values()}
    for name, first in heads.items():
        if name != first:
            bodies[first].append(name)
    return list(bodies.values())


def _mass(tree: Tree, name: str) -> float:
    """The mass of a link [kg]; 0 if the file has none."""
    element = tree.links[name].find("inertial/mass")
    text = "0" if element is None else element.get("value", "")
    try:
        mass = float(text)
    except ValueError:
        mass = math.nan
    if not 0 <= mass <= LARGEST_NUMBER:
        raise tree.error(
            f"the mass of link '{name}' is '{text[:60]}', not a number of kg up to "
            f"{LARGEST_NUMBER:g}"
        )
    return mass


def _find_meshes(tree: Tree, trusted: bool) -> Iterator[str]:
    """Give each mesh its full path; remove and name those that are missing or unsound.

    Args:
        tree: the description.
        trusted: it comes with a package: its meshes are not read here.
    """
    missing: list[str] = []
    unsound: dict[str, str] = {}
    checked: dict[Path, list[Shape]] = {}
    triangles = 0
    for link, shape, mesh in _mesh_shapes(tree):
        name = mesh.get("filename", "")
        found = _find(tree, name.removeprefix("package://").removeprefix("file://"))
        if found is None:
            missing.append(name)
            link.remove(shape)
            continue
        mesh.set("filename", str(found))
        if trusted:
            continue
        try:
            facts = check_mesh(found)
            triangles += facts.triangles
            scale = np.abs(parse_numbers(mesh.get("scale", "1 1 1"), FARTHEST)).max()
            if facts.extent * scale > FARTHEST:
                raise MeshError(f"is larger than {FARTHEST:g} m: scale makes it smaller")
        except MeshError as problem:
            unsound[name] = str(problem)
            link.remove(shape)
            continue
        if facts.tried:
            checked.setdefault(found, []).append((link, shape, mesh))
    if triangles > MOST_TRIANGLES:
        raise tree.error(
            f"its meshes have {triangles:,} triangles together; at most {MOST_TRIANGLES:,} are read"
        )
    for path in try_meshes(tuple(checked)):
        unsound[path.name] = "cannot be read: it takes the library that reads it down"
        for link, shape, _ in checked[path]:
            link.remove(shape)
    if missing:
        others = len(set(missing)) - 1
        them = f" and {others} more are" if others else " is"
        yield f"mesh '{missing[0]}'{them} missing: the arm is drawn without"
    for name, why in unsound.items():
        yield f"mesh '{name}' {why}; the arm is drawn without, and collisions ignore it"


Shape = tuple[Xml.Element, Xml.Element, Xml.Element]


def _mesh_shapes(tree: Tree) -> Iterator[Shape]:
    """Each shape that is a mesh: its link, itself and the mesh."""
    for link in tree.links.values():
        for shape in [*link.findall("visual"), *link.findall("collision")]:
            mesh = shape.find("geometry/mesh")
            if mesh is not None:
                yield link, shape, mesh


def _find(tree: Tree, name: str) -> Path | None:
    path = Path(name)
    if path.is_absolute():
        return path if _is_file(path) else None
    inner = Path(*path.parts[1:])  # without the name of a ROS package
    for folder in tree.path.resolve().parents:
        for candidate in (folder / path, folder / inner):
            if _is_file(candidate):
                return candidate
    return None


def _is_file(path: Path) -> bool:
    try:
        return path.exists() and not path.is_dir()
    except (OSError, ValueError):  # a name no file can have
        return False


def is_valid_inertia(moments: Floats) -> bool:
    """Whether a body can have an inertia (3, 3).

    Its principal moments are positive, and none exceeds the sum of the others.
    """
    small, middle, large = np.linalg.eigvalsh(moments)
    return bool(small > 0 and small + middle >= large * (1 - 1e-9))


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
    """Replace the inertia of a link by a ball's mass [kg] and moment [kg m^2]."""
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

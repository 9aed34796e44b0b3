"""Screw axes, masses and radii -> the links of an arm as solid capsules.

A joint sits on its axis halfway between the two feet of the common normals to its neighbours: so a
long offset along an axis is shared by the link before and the link after it, as in real arms. Each
link goes from its joint along its axis, over the common normal, and along the next axis.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import pairwise

import numpy as np

from dqpaint import dq
from dqpaint.dq import Floats
from dqpaint.robots.model.screws import Screws

PARALLEL_SINE = 0.02  # sine of an angle between axes below which they count as parallel
SHORTEST_ROD = 1e-6  # [m] of a rod
HUB_RADIUS_RATIO = 1.08  # a joint's hub is thicker than its link by this factor
HUB_HALF_LENGTH_RATIO = 0.6  # half the length of a hub, in radii of the link, without round ends
GUESSED_RADII = (0.07, 0.035)  # a guessed arm's radii at base and flange, as parts of its length
GUESSED_DENSITY = 900.0  # [kg/m^3] of a guessed arm: aluminium, motors and air


@dataclass(frozen=True)
class Capsule:
    """A rod with round ends, from `start` to `end` (3,) [m]; its `radius` [m] extends past both."""

    start: Floats
    end: Floats
    radius: float
    hub: bool = False

    @property
    def volume(self) -> float:
        """Volume of the solid [m^3]."""
        length = float(np.linalg.norm(self.end - self.start))
        return np.pi * self.radius**2 * (length + 4 / 3 * self.radius)

    @property
    def centre(self) -> Floats:
        """Centre of mass (3,) [m]."""
        return 0.5 * (self.start + self.end)

    def inertia(self, mass: float) -> Floats:
        """Inertia about the centre (3, 3) [kg m^2], for a uniform solid."""
        along, r = self.end - self.start, self.radius
        length = float(np.linalg.norm(along))
        rod = mass * length / (length + 4 / 3 * r)
        ends = mass - rod
        axial = rod * r**2 / 2 + ends * 2 / 5 * r**2
        across = rod * (length**2 / 12 + r**2 / 4)
        across += ends * (2 / 5 * r**2 + length**2 / 4 + 3 / 8 * length * r)
        unit = along / length if length > 0 else np.zeros(3)
        return np.asarray(across * np.eye(3) + (axial - across) * np.outer(unit, unit))


@dataclass(frozen=True)
class Link:
    """A rigid body at q = 0, in the base frame.

    Attributes:
        pose: of its joint (3,) [m]; the base's own is the origin.
        solids: its shape.
        mass: [kg].
        centre: of mass (3,) [m].
        inertia: about the centre (3, 3) [kg m^2].
    """

    pose: Floats
    solids: tuple[Capsule, ...]
    mass: float
    centre: Floats
    inertia: Floats


def build_links(screws: Screws, masses: Sequence[float], radii: Sequence[float]) -> list[Link]:
    """The base and the n links of an arm.

    Args:
        screws: the arm's axes.
        masses: of the links (n,) [kg]. The base does not move: any mass will do.
        radii: of the base and the links (n + 1,) [m].
    """
    places, paths = _paths(screws)
    links = []
    for i, (place, path) in enumerate(zip(places, paths, strict=True)):
        solids = [
            Capsule(a, b, radii[i])
            for a, b in pairwise(path)
            if np.linalg.norm(b - a) > SHORTEST_ROD
        ]
        if i > 0:
            half = HUB_HALF_LENGTH_RATIO * radii[i] * screws.axes[i - 1, :3]
            solids.append(
                Capsule(place - half, place + half, HUB_RADIUS_RATIO * radii[i], hub=True)
            )
        elif not solids:  # the first axis goes through the origin
            solids.append(Capsule(place, place, radii[i]))
        links.append(_combine_solids(place, solids, masses[i - 1] if i else masses[0]))
    return links


def default_body(screws: Screws) -> dict[str, list[float]]:
    """Masses and radii, in the form of a card, for an arm with only axes."""
    places, paths = _paths(screws)
    lengths = [sum(float(np.linalg.norm(b - a)) for a, b in pairwise(path)) for path in paths]
    reach = max(sum(lengths), SHORTEST_ROD)
    radii = (reach * np.linspace(*GUESSED_RADII, len(places))).tolist()
    weightless = build_links(screws, [1.0] * (len(places) - 1), radii)
    masses = [GUESSED_DENSITY * sum(s.volume for s in link.solids) for link in weightless[1:]]
    return {"mass_kg": masses, "radius_m": radii}


def _combine_solids(place: Floats, solids: list[Capsule], mass: float) -> Link:
    """One body of several solids, without regard to overlaps."""
    volumes = np.array([solid.volume for solid in solids])
    shares = mass * volumes / volumes.sum()
    centre = sum((m * s.centre for m, s in zip(shares, solids, strict=True)), np.zeros(3)) / mass
    inertia = np.zeros((3, 3))
    for m, solid in zip(shares, solids, strict=True):
        gap = solid.centre - centre
        inertia += solid.inertia(m) + m * (gap @ gap * np.eye(3) - np.outer(gap, gap))
    return Link(place, tuple(solids), mass, centre, inertia)


def _paths(screws: Screws) -> tuple[list[Floats], list[list[Floats]]]:
    """The position of each joint (the base's first), and the corners of each link."""
    directions = screws.axes[:, :3]
    points = dq.cross(directions, screws.axes[:, 3:])  # of each axis the nearest to the origin
    end = dq.translation(screws.home)
    arrive = [_foot(np.zeros(3), points[0], directions[0])]  # on each axis, from the one before
    leave = []
    for i in range(len(points) - 1):
        here, there = _common_normal(
            arrive[i], points[i], directions[i], points[i + 1], directions[i + 1]
        )
        leave.append(here)
        arrive.append(there)
    leave.append(_foot(end, points[-1], directions[-1]))
    joints = [0.5 * (a + b) for a, b in zip(arrive, leave, strict=True)]
    paths = [[np.zeros(3), arrive[0], joints[0]]]
    for i in range(len(joints) - 1):
        paths.append([joints[i], leave[i], arrive[i + 1], joints[i + 1]])
    paths.append([joints[-1], leave[-1], end])
    return [np.zeros(3), *joints], paths


def _foot(point: Floats, on: Floats, direction: Floats) -> Floats:
    """The point of a line that is nearest to another point."""
    return np.asarray(on + direction * ((point - on) @ direction))


def _common_normal(
    arrived: Floats, p: Floats, u: Floats, q: Floats, v: Floats
) -> tuple[Floats, Floats]:
    """The nearest points of two lines; for parallel lines, opposite the point of arrival."""
    normal = dq.cross(u, v)
    sine = float(np.linalg.norm(normal))
    if sine < PARALLEL_SINE:
        return arrived, _foot(arrived, q, v)
    here = p + u * (dq.cross(q - p, v) @ normal) / sine**2
    return here, _foot(here, q, v)

"""The shapes and weights of arms that are built from rows or axes."""

from itertools import pairwise

import numpy as np
import pytest

from dqpaint import dq
from dqpaint.robots.model.screws import Screws
from dqpaint.robots.urdf.capsules import SHORTEST_ROD, Capsule, build_links
from dqpaint.robots.urdf.prepare import is_valid_inertia
from tests.support.robot_cards import CARDS


@pytest.mark.parametrize("length", [0.0, 0.2])
def test_a_capsule_weighs_what_its_points_do(length, rng):
    """Volume, and moments about the centre, against a million points inside its box."""
    axis = np.array([0.6, 0.0, 0.8])
    start, radius = np.array([0.1, -0.2, 0.3]), 0.05
    capsule = Capsule(start, start + length * axis, radius)
    box = length / 2 + radius
    points = rng.uniform(-box, box, (1_000_000, 3))
    along = np.clip(points @ axis, -length / 2, length / 2)
    inside = points[np.linalg.norm(points - along[:, None] * axis, axis=1) < radius]
    volume = len(inside) / len(points) * (2 * box) ** 3
    assert capsule.volume == pytest.approx(volume, rel=0.01)
    mass = 3.0
    second = inside.T @ inside / len(inside)
    moments = mass * (np.trace(second) * np.eye(3) - second)
    np.testing.assert_allclose(capsule.inertia(mass), moments, atol=0.01 * moments.max())
    np.testing.assert_allclose(capsule.centre, start + length / 2 * axis)


def test_a_link_weighs_what_its_capsules_do():
    """Steiner: about any point, the moments of the parts add up to that of the whole."""
    for link in build_links(CARDS["meka-a2"].axes, range(1, 8), [0.05] * 8)[1:]:
        volumes = np.array([s.volume for s in link.solids])
        shares = link.mass * volumes / volumes.sum()
        about = np.array([0.3, -0.1, 0.2])

        def moved(inertia, mass, centre, to=about):
            gap = centre - to
            return inertia + mass * (gap @ gap * np.eye(3) - np.outer(gap, gap))

        parts = [moved(s.inertia(m), m, s.centre) for m, s in zip(shares, link.solids, strict=True)]
        np.testing.assert_allclose(
            moved(link.inertia, link.mass, link.centre), sum(parts), atol=1e-14
        )
        assert is_valid_inertia(link.inertia)


@pytest.mark.parametrize("name", CARDS)
def test_a_chain_hangs_together_from_the_base_to_the_flange(name):
    """Each joint lies on its axis, where the link before it ends."""
    card = CARDS[name]
    screws = card.axes
    links = build_links(screws, card.body.mass_kg, card.body.radius_m)
    assert len(links) == card.joints + 1
    for link, axis in zip(links[1:], screws.axes, strict=True):
        np.testing.assert_allclose(
            dq.cross(link.pose, axis[:3]), axis[3:], atol=1e-12
        )  # on the line
    for here, there in pairwise(links):
        ends = [end for s in here.solids for end in (s.start, s.end)]
        reach = min(np.linalg.norm(end - there.pose) for end in ends)
        assert reach < 2 * SHORTEST_ROD or np.linalg.norm(here.pose - there.pose) < SHORTEST_ROD
    tip = dq.translation(screws.home)
    ends = [end for s in links[-1].solids for end in (s.start, s.end)]
    assert min(np.linalg.norm(end - tip) for end in ends) < card.body.radius_m[-1]


def test_a_long_offset_is_shared_by_its_two_links():
    """The upper arm of the LWR: half of it turns with joint 2, half with joint 3."""
    card = CARDS["lwr4"]
    links = build_links(card.axes, card.body.mass_kg, card.body.radius_m)
    np.testing.assert_allclose(links[3].pose, [0, 0, 0.31 + 0.2], atol=1e-12)
    np.testing.assert_allclose(links[1].pose, [0, 0, 0.155], atol=1e-12)


def test_parallel_axes_are_joined_where_the_arm_arrives():
    """The second axis is reached half a metre aside of its point nearest to the origin."""
    directions, points = (
        [[0, 0, 1], [0, 1, 0], [0, 1, 0]],
        [[0, 0.5, 0], [0, 0, 0.3], [0.4, 0, 0.3]],
    )
    axes = dq.twist_from_screw(directions, points, np.zeros(3))
    arm = Screws(axes, dq.pose_from([0.5, 0.5, 0.3], [1, 0, 0, 0]))
    links = build_links(arm, [1] * 3, [0.05] * 4)
    np.testing.assert_allclose(links[2].pose, [0, 0.5, 0.3], atol=1e-12)
    np.testing.assert_allclose(links[3].pose, [0.4, 0.5, 0.3], atol=1e-12)


def test_parallel_axes_are_joined_straight_across():
    axes = dq.twist_from_screw([[0, 1, 0]] * 2, [[0, 0.7, 0.1], [0.4, -3, 0.1]], np.zeros(2))
    arm = Screws(axes, dq.pose_from([0.5, 0, 0.1], [1, 0, 0, 0]))
    links = build_links(arm, [1, 1], [0.05] * 3)
    np.testing.assert_allclose(links[1].pose, [0, 0, 0.1], atol=1e-12)
    np.testing.assert_allclose(links[2].pose, [0.4, 0, 0.1], atol=1e-12)

"""Chains: what they are made of, turned round, mapped, measured."""

import math

import numpy as np
import pytest

from dqpaint.program import piecewise
from dqpaint.program.program import PiecewiseCurve
from tests.support.drawn import rotation

CONTROL = np.array([[0.1, 0.2, 0.3], [1.0, -0.5, 0.2], [0.4, 2.0, -1.0], [2.0, 1.0, 0.5]])
HALF = np.array([[2.0, 0.5, 0.1], [-0.3, 1.0, 0.4]])


def at(curve: PiecewiseCurve, count: int = 201) -> np.ndarray:
    """Places all along a curve, piece by piece."""
    pieces = len(curve.cubic)
    g = np.tile(np.linspace(0, 1, count), pieces)
    return piecewise.derivatives(curve, np.repeat(np.arange(pieces), count), g)[0]


def test_bezier_against_bernstein() -> None:
    t = np.linspace(0, 1, 201)[:, None]
    b = (1 - t) ** 3, 3 * t * (1 - t) ** 2, 3 * t**2 * (1 - t), t**3
    wanted = sum(w * c for w, c in zip(b, CONTROL, strict=True))
    np.testing.assert_allclose(at(piecewise.bezier(CONTROL)), wanted, atol=1e-14)
    b = (1 - t) ** 2, 2 * t * (1 - t), t**2
    wanted = sum(w * c for w, c in zip(b, CONTROL, strict=False))
    np.testing.assert_allclose(at(piecewise.bezier(CONTROL[:3])), wanted, atol=1e-14)


def test_derivatives_are_derivatives() -> None:
    curve = PiecewiseCurve(piecewise.bezier(CONTROL).cubic, HALF[None], np.array([[0.4, -2.7]]))
    g, h, piece = np.linspace(0.1, 0.9, 9), 1e-5, np.zeros(9, dtype=int)
    now, ahead, behind = (piecewise.derivatives(curve, piece, g + d) for d in (0, h, -h))
    for order in range(3):
        slope = (ahead[order] - behind[order]) / (2 * h)
        np.testing.assert_allclose(slope, now[order + 1], rtol=1e-6, atol=1e-6)


def mixed() -> PiecewiseCurve:
    arc = piecewise.arc(CONTROL[3] - HALF[0], *HALF, 0.0, 2.0)
    return piecewise.join([piecewise.bezier(CONTROL), arc])


def test_reversed() -> None:
    curve = mixed()
    back = at(piecewise.reverse(curve))
    np.testing.assert_allclose(back, at(curve)[::-1], atol=1e-14)
    ends = np.array(piecewise.ends(piecewise.reverse(curve)))
    np.testing.assert_allclose(ends, piecewise.ends(curve)[::-1], atol=1e-14)


def test_mapped() -> None:
    matrix = rotation((1, 2, -1), 40) @ np.diag([1.0, 3.0, -2.0])
    shift = np.array([5.0, -1.0, 2.0])
    mapped = piecewise.transform(mixed(), matrix, shift)
    np.testing.assert_allclose(at(mapped), at(mixed()) @ matrix.T + shift, atol=1e-13)


def test_joined_closes_a_gap_and_leaves_the_far_end() -> None:
    first = piecewise.straight(np.array([[0, 0, 0], [1, 0, 0.0]]))
    second = piecewise.bezier(CONTROL + np.array([1e-4, 0, 0]))
    curve = piecewise.join([first, second])
    ends = at(curve, 2).reshape(2, 2, 3)
    np.testing.assert_allclose(
        ends[1], [[1, 0, 0], CONTROL[3] + np.array([1e-4, 0, 0])], atol=1e-15
    )


def test_box_against_many_places() -> None:
    """A curve bulges out between its ends; so does an arc, over any of its quadrants."""
    made = [mixed(), piecewise.bezier(CONTROL[:3])]
    made += [
        piecewise.arc(CONTROL[0], *HALF, a, t) for a in (0.1, 2, -3) for t in (0.5, 2, -4, 6.28)
    ]
    for curve in made:
        least, most = piecewise.bounding_box([curve])
        places = at(curve, 20_001)
        np.testing.assert_allclose(least, places.min(axis=0), atol=1e-7)
        np.testing.assert_allclose(most, places.max(axis=0), atol=1e-7)


def test_length() -> None:
    for curve in (mixed(), piecewise.straight(CONTROL)):
        steps = np.linalg.norm(np.diff(at(curve, 20_001), axis=0), axis=1).sum()
        assert piecewise.lengths([curve]) == pytest.approx([steps], rel=1e-4)


# Smooth lines.


def circle(count: int, turn: float = 2 * np.pi) -> np.ndarray:
    a = np.linspace(0, turn, count)
    points = np.stack([np.cos(a), np.sin(a), 0 * a], axis=1)
    if turn == 2 * np.pi:
        points[-1] = points[0]
    return points


@pytest.mark.parametrize(("turn", "count"), [(2 * np.pi, 9), (2 * np.pi, 13), (2.0, 5)])
def test_points_of_a_circle_make_a_circle(turn: float, count: int) -> None:
    places = at(piecewise.smooth_curve(circle(count, turn)))
    step = turn / (count - 1)
    # a cubic comes this close to an arc: its error goes with the sixth power of the angle
    assert np.abs(np.linalg.norm(places, axis=1) - 1).max() < 4e-4 * (step / 1.57) ** 6 + 1e-12


def test_uneven_points_of_a_circle_make_a_circle() -> None:
    """At each point the direction is that of the circle, whatever the distances."""
    a = np.cumsum([0.0, 0.3, 0.6, 0.2, 0.5, 0.7])
    curve = piecewise.smooth_curve(np.stack([np.cos(a), np.sin(a), 0 * a], axis=1))
    way = piecewise.derivatives(curve, np.arange(5), np.zeros(5))[1][1:]
    way /= np.linalg.norm(way, axis=1)[:, None]
    tangent = np.stack([-np.sin(a), np.cos(a), 0 * a], axis=1)[1:5]
    assert (way * tangent).sum(1).min() > math.cos(0.02)


def test_a_smooth_line_goes_through_its_points_without_corners(
    rng: np.random.Generator,
) -> None:
    points = np.cumsum(rng.uniform(0.2, 1.0, (40, 3)), axis=0)
    curve = piecewise.smooth_curve(points)
    sharp = piecewise.turn_angles(points)[1:-1] > piecewise.CORNER_ANGLE
    np.testing.assert_allclose(at(curve, 2)[::2], points[:-1], atol=1e-12)
    np.testing.assert_allclose(at(curve, 2)[1::2], points[1:], atol=1e-12)
    piece = np.arange(39)
    out = piecewise.derivatives(curve, piece, np.ones(39))[1][:-1]
    into = piecewise.derivatives(curve, piece, np.zeros(39))[1][1:]
    out, into = (v / np.linalg.norm(v, axis=1)[:, None] for v in (out, into))
    np.testing.assert_allclose(out[~sharp], into[~sharp], atol=1e-12)
    assert (~sharp).sum() > 20


def test_corners_stay_and_what_is_straight_stays_straight() -> None:
    square = np.array([[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0], [0, 0, 0.0]])
    curve = piecewise.smooth_curve(square)
    assert not curve.cubic[:, 2:].any()
    line = np.array([[0, 0, 0], [1, 0, 0], [3, 0, 0.0]])
    assert not piecewise.smooth_curve(line).cubic[:, 2:].any()


def test_a_stem_stays_straight_where_a_bow_begins() -> None:
    bow = circle(7, np.pi) - np.array([1, 0, 0])  # from (0, 0) upwards
    points = np.concatenate([[[0, -4, 0]], bow])
    stem = piecewise.smooth_curve(points, stiff=2.2).cubic[0]
    assert not stem[2:].any()
    assert piecewise.smooth_curve(points).cubic[0, 2:].any()


def test_the_length_of_an_ellipse_is_its_integral_and_that_of_a_circle_its_radius() -> None:
    """Against the perimeter by the arithmetic-geometric mean (Abramowitz & Stegun 17.6)."""
    a, b = 3.0, 1.0
    x, y, total, power = a, b, a * a, 0.5
    while abs(x - y) > 1e-15:
        total -= power * (x * x - y * y)
        x, y, power = (x + y) / 2, np.sqrt(x * y), 2 * power
    perimeter = 2 * np.pi * total / x
    axes = np.array([a, 0.0, 0.0]), np.array([0.0, b, 0.0])
    for quarter in range(4):
        arc = piecewise.arc(np.ones(3), *axes, 0.5 * np.pi * quarter, 0.5 * np.pi)
        assert piecewise.is_nonuniform(arc).all()
        assert piecewise.lengths([arc])[0] == pytest.approx(perimeter / 4, rel=1e-6)
    circle = piecewise.arc(np.ones(3), 2 * axes[0], 6 * axes[1], 0.3, -2.0)
    assert not piecewise.is_nonuniform(circle).any()
    assert piecewise.lengths([circle])[0] == pytest.approx(12.0, rel=1e-15)
    skewed = piecewise.arc(np.ones(3), axes[0], np.array([0.1, 3.0, 0.0]), 0.3, -2.0)
    assert piecewise.is_nonuniform(skewed).all()

"""Piecewise curves: on their curves, at one speed, through corners without a stop."""

import numpy as np
import pytest

from dqpaint.motion.geometry.piecewise_paths import piecewise_positions
from dqpaint.program import piecewise
from dqpaint.program.program import PiecewiseCurve
from tests.support.strokes import BEZIER, HALF_AXES

CUSP = np.array([[0, 0, 0], [1, 1, 0], [0, 1, 0], [1, 0, 0]], dtype=float)  # at (0.5, 0.75)
POINTS = np.array([[0, 0, 0], [3, 0, 0], [3, 4, 0], [3, 4, 12]], dtype=float)


def place_chain(curve: PiecewiseCurve):
    return piecewise_positions([curve]).select(0)


def mixed() -> PiecewiseCurve:
    """A line, a Bezier curve, an arc and a line, end to end."""
    centre = BEZIER[3] - np.cos(0.4) * HALF_AXES[0] - np.sin(0.4) * HALF_AXES[1]
    arc = piecewise.arc(centre, *HALF_AXES, 0.4, 2.2)
    to = np.array(piecewise.ends(arc)[1])
    lines = [np.array([[0.5, 0.1, 0.0], BEZIER[0]]), np.array([to, to + 0.1])]
    first, last = map(piecewise.straight, lines)
    return piecewise.join([first, piecewise.bezier(BEZIER), arc, last])


def test_a_polyline_by_hand():
    """Lengths 3, 4, 12: at 0, 3, 5, 7, 13 and 19 of 19."""
    p = place_chain(piecewise.straight(POINTS))(np.array([0, 3, 5, 7, 13, 19]) / 19)
    where = [[0, 0, 0], [3, 0, 0], [3, 2, 0], [3, 4, 0], [3, 4, 6], [3, 4, 12]]
    np.testing.assert_allclose(p[0], where, atol=1e-14)
    # at a corner it is the direction of the piece that begins there, at the end the last one
    ways = [[1, 0, 0], [0, 1, 0], [0, 1, 0], [0, 0, 1], [0, 0, 1], [0, 0, 1]]
    np.testing.assert_allclose(p[1], 19 * np.array(ways), atol=1e-13)
    assert not p[2:].any()


def test_one_speed_from_end_to_end(rng):
    """Also at the corners: the speed over the fraction is the length."""
    places = place_chain(mixed())
    speed = np.linalg.norm(places(np.linspace(0, 1, 3001))[1], axis=1)
    np.testing.assert_allclose(speed, speed[0], rtol=1e-13)
    fine = places(np.linspace(0, 1, 50_001))[0]
    assert np.linalg.norm(np.diff(fine, axis=0), axis=1).sum() == pytest.approx(speed[0], rel=1e-4)


def test_places_are_on_the_curves(rng):
    """By other means: de Casteljau's points, and the ellipse's implicit equation."""
    curve = mixed()
    at = place_chain(curve)(np.linspace(0, 1, 20_001))[0]
    t = np.linspace(0, 1, 50)[:, None, None]
    points = np.broadcast_to(BEZIER, (50, 4, 3))
    while points.shape[1] > 1:
        points = (1 - t) * points[:, :-1] + t * points[:, 1:]
    gaps = np.linalg.norm(at[None] - points, axis=2).min(axis=1)
    assert gaps.max() < 3.2e-5  # half a step of the samples
    arc = curve.cubic[2, 0]
    near = np.linalg.lstsq(HALF_AXES.T, (at - arc).T, rcond=None)[0].T
    flat = np.linalg.norm(near @ HALF_AXES - (at - arc), axis=1) < 1e-12
    lengths = piecewise.lengths(
        [PiecewiseCurve(*(a[i : i + 1] for a in parts(curve))) for i in range(4)]
    )
    s = np.linspace(0, 1, 20_001) * sum(lengths)
    on = (s > lengths[0] + lengths[1] + 1e-3) & (s < sum(lengths[:3]) - 1e-3)
    assert on.sum() > 1000
    assert flat[on].all()
    np.testing.assert_allclose((near[on] ** 2).sum(1), 1, atol=1e-12)


def parts(curve):
    return curve.cubic, curve.ellipse, curve.angles


def test_derivatives_are_derivatives():
    """Up to the third, which no tool of a curve needs, but the shape promises."""
    places, h = place_chain(piecewise.bezier(BEZIER)), 1e-5
    f = np.linspace(0.05, 0.95, 19)
    now, ahead, behind = (places(f + d) for d in (0, h, -h))
    for order in range(3):
        slope = (ahead[order] - behind[order]) / (2 * h)
        size = np.abs(now[order + 1]).max()
        np.testing.assert_allclose(slope, now[order + 1], atol=1e-5 * size)


def test_a_circle_is_a_circle():
    circle = piecewise.arc(
        np.zeros(3), np.array([0.3, 0, 0]), np.array([0, 0.3, 0]), 0.0, 2 * np.pi
    )
    f = np.linspace(0, 1, 101)
    p = place_chain(circle)(f)
    a = 2 * np.pi * f
    round_ = 0.3 * np.stack([np.cos(a), np.sin(a), 0 * a], axis=1)
    np.testing.assert_allclose(p[0], round_, atol=1e-14)
    np.testing.assert_allclose(p[2], -((2 * np.pi) ** 2) * round_, atol=1e-11)


def test_beyond_its_ends_it_goes_on_straight():
    places = place_chain(mixed())
    for f, end in ((-0.1, 0.0), (1.1, 1.0)):
        p, q = places(np.array([f])), places(np.array([end]))
        np.testing.assert_allclose(p[0], q[0] + (f - end) * q[1], atol=1e-15)
        np.testing.assert_allclose(p[1], q[1])
        assert not p[2:].any()


@pytest.mark.parametrize(
    "control",
    [
        CUSP,
        BEZIER[[0, 0, 1, 2]],  # handles of no length, as many drawings have them
        BEZIER[[0, 1, 2, 2]],
        BEZIER[[0, 0, 0, 1]],
        BEZIER[[0, 0, 1, 1]],
        np.array([[0, 0, 0], [2, 0, 0], [-1, 0, 0], [1, 0, 0]], dtype=float),  # to and fro
    ],
)
def test_where_a_formula_stands_still_the_point_does_not(control):
    places = place_chain(piecewise.bezier(control))
    p = places(np.concatenate([np.linspace(0, 1, 1001), [1e-9, 1 - 1e-9]]))
    assert np.isfinite(p).all()
    stands = np.linalg.norm(np.diff(control, axis=0)[[0, -1]], axis=1) == 0
    assert not p[2:, [0, 1000]][:, stands].any()  # no curvature is made up there
    speed = np.linalg.norm(p[1], axis=1)
    np.testing.assert_allclose(speed, speed[0], rtol=1e-12)
    t = np.linspace(0, 1, 400_001)[:, None]
    b = (1 - t) ** 3, 3 * t * (1 - t) ** 2, 3 * t**2 * (1 - t), t**3
    curve = sum(w * c for w, c in zip(b, control, strict=True))
    length = np.linalg.norm(np.diff(curve, axis=0), axis=1).sum()
    assert speed[0] == pytest.approx(length, rel=1e-9)


def test_the_tip_of_a_cusp_lies_half_way():
    np.testing.assert_allclose(
        place_chain(piecewise.bezier(CUSP))(np.array([0.5]))[0], [[0.5, 0.75, 0]]
    )


def test_a_million_pieces_fit(rng):
    points = np.cumsum(rng.normal(size=(300_000, 3)), axis=0)
    p = place_chain(piecewise.straight(points))(np.linspace(0, 1, 11))
    np.testing.assert_allclose(p[0, [0, -1]], points[[0, -1]], atol=1e-9)

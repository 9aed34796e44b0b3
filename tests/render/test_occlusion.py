"""What is hidden and when, with a wall whose shadow is known in closed form."""

import numpy as np
import pytest

from dqpaint.render import occlusion
from dqpaint.render.occlusion import LONGEST_LAMP_STEP, visible_share
from tests.support.shadow import EYE, Wall


def on_a_line(n, length=1.0, lamps=1):
    x = np.linspace(-length / 2, length / 2, n)
    places = np.zeros((n, lamps, 3))
    places[:, :, 0] = x[:, None] + 0.01 * np.arange(lamps)
    return places


def test_the_edge_of_a_shadow_is_found_to_a_sample():
    n = 20_000
    places, wall = on_a_line(n), Wall(0.05, 0.15)  # hides lamps from x = 0.1 to 0.3
    share = visible_share(wall, np.zeros((n, 1)), places, EYE, np.ones(n, bool))[:, 0]
    x = places[:, 0, 0]
    np.testing.assert_array_equal(share < 0.5, (x > 0.1) & (x < 0.3))
    assert set(np.unique(share)) == {0.0, 1.0}
    assert len(wall.stood) < 1.0 / LONGEST_LAMP_STEP + 60  # most samples are not asked


def test_the_posture_of_the_same_instant_counts():
    n = 4001
    places = np.zeros((n, 1, 3))  # the lamp stands, the wall goes by
    at = np.linspace(-0.5, 0.5, n)
    share = visible_share(Wall(-0.1, 0.2), at[:, None], places, EYE, np.ones(n, bool))[:, 0]
    np.testing.assert_array_equal(share < 0.5, (at > -0.2) & (at < 0.1))


def test_each_lamp_of_a_bar_has_its_own_shadow():
    n = 3000
    places, wall = on_a_line(n, lamps=5), Wall(0.05, 0.15)
    share = visible_share(wall, np.zeros((n, 1)), places, EYE, np.ones(n, bool))
    x = places[..., 0]
    np.testing.assert_array_equal(share < 0.5, (x > 0.1) & (x < 0.3))


def test_dark_instants_are_not_asked_and_no_run_speaks_for_another():
    n = 2000
    places, lit = on_a_line(n, 0.02), np.zeros(n, bool)
    lit[100:101] = lit[700:800] = True
    wall = Wall(-0.01, places[400, 0, 0] / 2)  # hides the first run, not the second
    share = visible_share(wall, np.zeros((n, 1)), places, EYE, lit)[:, 0]
    assert share[100] == 0.0
    assert (share[700:800] == 1.0).all()
    assert (share[~lit] == 1.0).all()
    assert len(wall.stood) < 30
    assert visible_share(wall, np.zeros((n, 1)), places, EYE, np.zeros(n, bool)).all()


def test_both_ends_of_a_lit_run_are_asked():
    n = 1000
    places, lit = on_a_line(n, 0.02), np.zeros(n, bool)  # shorter than the steps that are tried
    lit[200:300] = lit[900:] = True
    edge = 0.5 * (places[249, 0, 0] + places[250, 0, 0])
    after = 0.5 * places[600, 0, 0]
    share = visible_share(Wall(edge / 2, after), np.zeros((n, 1)), places, EYE, lit)[:, 0]
    assert (share[:250] == 1.0).all()
    assert (share[250:300] == 0.0).all()
    assert (share[900:] == 1.0).all()


def test_a_ray_begins_off_its_lamp():
    near = Wall(-1, 1)
    near.blocked = lambda postures, start, end: (
        start[..., 2] < 0.5 * occlusion.CLEARANCE
    )  # the lamp's own socket
    one = np.ones(1, bool)
    assert visible_share(near, np.zeros((1, 1)), np.zeros((1, 1, 3)), EYE, one) == 1.0
    # even where the lamp touches the camera
    assert np.isfinite(visible_share(near, np.zeros((1, 1)), EYE[None, None], EYE, one)).all()


@pytest.mark.parametrize("turn", [0.5, 2.0])
def test_turning_joints_are_tried_every_degree(turn):
    n = 5000
    at = np.linspace(0, turn, n)
    wall = Wall(9, 10)
    visible_share(wall, at[:, None], np.zeros((n, 1, 3)), EYE, np.ones(n, bool))
    assert np.degrees(np.diff(np.sort(wall.stood)).max()) < 1.05

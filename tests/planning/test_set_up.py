"""Other places and start postures by seed: the same for all, as far as they say, and reached."""

import numpy as np
import pytest

from dqpaint import dq
from dqpaint.errors import UsageError
from dqpaint.language import parse
from dqpaint.planning import prepared_motion
from dqpaint.planning.set_up import displaced, other_posture
from dqpaint.robots.kinematics import Kinematics
from dqpaint.robots.model import read_card
from dqpaint.settings import make_settings, read_spread

CARD = read_card("iiwa")
ARM = Kinematics(CARD)
LINE = "period 10 ms\nline to (40, 20) mm\n"


def prepared(text=LINE, arm=ARM, **settings):
    return prepared_motion.prepare_motion(parse(text, "x.traj"), arm, make_settings(**settings))


def test_a_place_is_off_by_the_size_and_follows_from_the_seed():
    for text in (LINE, "place at (0.6, 0.1, 0.4) m\n" + LINE):
        program = parse(text, "x.traj")
        still = prepared(text).motion
        canvas = CARD.canvas.pose
        shifts = []
        for seed in range(400):
            placed = displaced(program, canvas, 0.02, seed).placement
            shifts.append(np.array(placed.position) - dq.translation(still.canvas))
            np.testing.assert_allclose(placed.orientation, dq.rotation(still.canvas), atol=1e-12)
        np.testing.assert_allclose(np.std(shifts, axis=0), 0.02, rtol=0.12)
        np.testing.assert_allclose(np.mean(shifts, axis=0), 0, atol=0.004)
    moved = prepared(spread="place=20", seed=3).motion
    shift = moved.points - prepared().motion.points
    np.testing.assert_allclose(shift, np.broadcast_to(shift[0], shift.shape), atol=1e-12)
    np.testing.assert_array_equal(moved.points, prepared(spread="place", seed=3).motion.points)
    assert np.linalg.norm(shift[0]) > 1e-3


def test_a_posture_is_another_one_for_the_same_pose():
    still = prepared()
    several = [prepared(spread="posture=5", seed=seed) for seed in range(6)]
    for one in several:
        np.testing.assert_array_equal(one.motion.pose, still.motion.pose)
        error = 2 * dq.log(dq.mul(dq.conj(ARM.pose(one.start)), one.motion.pose[0]))
        assert np.abs(error).max() < 1e-8
        assert 1e-3 < np.abs(one.start - still.start).max() < np.radians(40)
        assert ((CARD.lower <= one.start) & (one.start <= CARD.upper)).all()
    assert len({tuple(one.start) for one in several}) == 6
    np.testing.assert_array_equal(prepared(spread="posture", seed=2).start, several[2].start)
    home = prepared(spread="posture", seed=2, start="home").start
    assert np.abs(home - CARD.home).max() > 1e-3


def test_an_arm_without_freedom_is_told():
    arm = Kinematics(read_card("viper850"))
    with pytest.raises(UsageError, match="6 joints"):
        other_posture(arm, arm.card.home, arm.pose(arm.card.home), 0.1, 0)


@pytest.mark.parametrize(
    "text", ["", "noise", "place,place", "place=0", "place=-1", "posture=90", "place=x", "place="]
)
def test_a_spread_that_is_none_is_refused(text):
    with pytest.raises(UsageError, match="posture=5,place=20"):
        make_settings(spread=text)


def test_sizes_are_degrees_and_millimetres():
    assert read_spread(None) == (0, 0)
    assert read_spread("posture=3, place=10") == pytest.approx((np.radians(3), 0.01))

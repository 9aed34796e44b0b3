import numpy as np

from dqpaint.plants.stiff import Stiff
from dqpaint.robots.bullet.client import bullet
from dqpaint.robots.model.card import read_card


def test_the_effort_of_a_period_is_the_larger_of_its_first_and_its_last_step():
    """A new rate is a jolt in the first step; once it is reached the last may need more."""
    card = read_card("iiwa")
    arm = Stiff(card, card.home, 0.008)
    torques, step = [], arm.advance

    def watched():
        step()
        torques.append([s[3] for s in bullet.getJointStates(arm.body, arm.joints, arm.client)])

    arm.advance = watched
    more = []
    try:
        for _ in range(2):
            torques.clear()
            arm.run(np.full(7, 0.1))
            first, last = np.array(torques[0]), np.array(torques[-1])
            more.append(np.abs(last) > np.abs(first))
            np.testing.assert_array_equal(arm.effort, np.where(more[-1], last, first))
    finally:
        arm.close()
    assert not more[0][0]
    assert more[1].any()
    assert not more[1].all()

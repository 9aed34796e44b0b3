"""Motors of infinite bandwidth: what torque of a period is told."""

import numpy as np

from dqpaint.plants.stiff import Stiff
from dqpaint.robots.model.card import read_card

CARD = read_card("iiwa")
RATES = np.full(7, 0.1)


def test_the_effort_of_a_period_is_the_larger_of_its_first_and_its_last_step(engine):
    """A new rate is a jolt in the first step; once it is reached the last may need more."""
    whole, fine = (Stiff(CARD, CARD.home, period) for period in (0.008, 0.001))
    more = []
    for _ in range(2):
        whole.run(RATES)
        torques = []
        for _ in range(8):
            fine.run(RATES)
            torques.append(fine.effort)
        first, last = torques[0], torques[-1]
        more.append(np.abs(last) > np.abs(first))
        np.testing.assert_allclose(whole.effort, np.where(more[-1], last, first), atol=1e-9)
        np.testing.assert_allclose(whole.posture, fine.posture, atol=1e-15)
    whole.close()
    fine.close()
    assert not more[0][0]
    assert more[1].any()
    assert not more[1].all()

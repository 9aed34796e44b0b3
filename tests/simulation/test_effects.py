"""When a second run counts as another: from 1 um or 0.001 deg on, whatever a pose's sign."""

from types import SimpleNamespace

import numpy as np
import pytest

from dqpaint import dq
from dqpaint.simulation import has_effect

AXIS = np.array([0.48, 0.6, 0.64])


def differ(rng, shift=0.0, degrees=0.0, sign=1.0):
    """Whether a run counts as another that is elsewhere in its fourth row."""
    turns = dq.exp(np.concatenate([rng.uniform(-1, 1, (6, 3)), np.zeros((6, 3))], axis=1))
    points = rng.uniform(-1, 1, (6, 3))
    pose = dq.pose_from(points, dq.rotation(turns))
    other = pose.copy()
    more = dq.exp(np.r_[0.5 * np.radians(degrees) * AXIS, np.zeros(3)])
    rotation = dq.rotation(dq.mul(more, turns[3]))
    other[3] = sign * dq.pose_from(points[3] + shift * AXIS, rotation)

    def again(watch):
        for row, one in enumerate(other):
            watch(row, one)

    return has_effect(SimpleNamespace(pose=pose, points=points), again)


@pytest.mark.parametrize("sign", [1.0, -1.0])
def test_from_a_micrometre_or_a_thousandth_of_a_degree_on_a_run_is_another(rng, sign):
    assert not differ(rng, sign=sign)
    assert not differ(rng, shift=0.98e-6, degrees=0.98e-3, sign=sign)
    assert differ(rng, shift=1.02e-6, sign=sign)
    assert differ(rng, degrees=1.02e-3, sign=sign)

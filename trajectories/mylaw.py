"""mylaw.py - a control law of one's own: dqpaint draw star --controller trajectories/mylaw.py."""

from dqpaint import dq


def mylaw(seen, k=20.0):
    """Follow the screw from the measured to the reference pose, with feed-forward."""
    x_e = dq.mul(seen.pose_d, dq.conj(dq.nearest(seen.pose, seen.pose_d)))
    return seen.twist_d + k * 2 * dq.log(x_e)

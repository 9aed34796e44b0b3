"""pi.py - a law with state: dqpaint draw star --controller pi.py --disturb twist=x=0.01."""

import numpy as np

from dqpaint import dq


class PI:
    """Follow the screw from the measured to the reference pose, and add up the error."""

    def start(self, arm, motion, gains):
        """Set the sum of the error to zero."""
        self.sum = np.zeros(6)

    def __call__(self, seen, k=20.0, k_i=100.0):
        """The spatial twist that is commanded."""
        e = 2 * dq.log(dq.mul(seen.pose_d, dq.conj(dq.nearest(seen.pose, seen.pose_d))))
        self.sum += seen.period * e
        return seen.twist_d + k * e + k_i * self.sum

"""pi.py - a law that remembers: dqpaint draw star --controller pi.py --disturb twist=x=0.01."""

import numpy as np

from dqpaint import dq


class PI:
    """Goes along the screw between what is and what is asked, and adds up what is left of it."""

    def start(self, arm, motion, gains):
        """Nothing is left before the first step."""
        self.sum = np.zeros(6)

    def __call__(self, seen, k=20.0, k_i=100.0):
        """The spatial twist that is commanded."""
        e = 2 * dq.log(dq.mul(seen.pose_d, dq.conj(dq.nearest(seen.pose, seen.pose_d))))
        self.sum += seen.period * e
        return seen.twist_d + k * e + k_i * self.sum

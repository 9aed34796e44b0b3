"""unwinding.py - a law that forgets that x and -x are one pose."""

import numpy as np

from dqpaint import dq


def unwinding(seen, k=20.0):
    """As hinf, without the sign rule: where x and x_d have opposite signs it turns away."""
    x_e = dq.mul(seen.pose, dq.conj(seen.pose_d))
    u = np.concatenate([-2 * k * x_e[1:4], -k * dq.translation(x_e)])
    return u + dq.adjoint(x_e, seen.twist_d)

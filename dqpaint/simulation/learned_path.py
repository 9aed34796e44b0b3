"""A reference and what rehearsals taught -> the reference that a law is given instead.

The correction a (N, 6) is a displacement in the frame that rides with the reference, angular part
first [rad, m]: x_d exp(1/2 a). It rides along, so what a bent tool or the arm's own weight does
stays smooth, and a drawing that is put elsewhere may keep it.
"""

from dataclasses import replace

import numpy as np

from dqpaint import dq
from dqpaint.core import NumberTable, tables
from dqpaint.dq import Floats
from dqpaint.errors import DqpaintError, UsageError
from dqpaint.motion import Motion

COLUMNS = ("wx_rad", "wy_rad", "wz_rad", "x_m", "y_m", "z_m")
FADE = 0.2  # s, over which a correction begins: a run begins at rest, at the reference


def body_errors(pose_d: Floats, pose: Floats) -> Floats:
    """2 log(x_d* x) (N, 6): the displacement of poses (N, 8) along the axes of the reference."""
    return np.asarray(2.0 * dq.log(dq.mul(dq.conj(pose_d), pose)))


def corrected(motion: Motion, a: Floats) -> Motion:
    """The motion along x_d exp(1/2 a), its twists exact but for the difference that makes a_dot.

    xi = xi_d + Ad(x_d) Jl(a) a_dot, from the derivative of the product.

    Args:
        motion: the reference.
        a: the correction (N, 6); its beginning is faded in.
    """
    if len(motion.t) < 2:
        return motion
    part = np.clip(motion.t / FADE, 0.0, 1.0)[:, None]
    a = part**2 * (3.0 - 2.0 * part) * a
    rate = np.gradient(a, motion.period, axis=0)
    jacobians = np.array([dq.left_jacobian(one) for one in a])
    added = dq.adjoint(motion.pose, np.matvec(jacobians, rate))
    return replace(
        motion,
        pose=dq.mul(motion.pose, dq.exp(0.5 * a)),
        twist=motion.twist + added,
        acceleration=motion.acceleration + np.gradient(added, motion.period, axis=0),
    )


def read_learned(path: str, t: Floats) -> Floats:
    """The correction (N, 6) of a file at times (N,) [s].

    Raises:
        UsageError: it cannot be read, or belongs to a drawing of another length.
        DqpaintError: it is no such table.
    """
    table = NumberTable(path, "learned path")
    times, rows = table.times(), table.columns(COLUMNS)
    if abs(times[-1] - t[-1]) > 1e-6 * max(1.0, float(t[-1])):
        raise UsageError(
            f"learned path '{table.name}' is {times[-1]:.4g} s long, the drawing {t[-1]:.4g} s: it "
            "was learned from another one, or at another pace"
        )
    return np.stack([np.interp(t, times, column) for column in rows.T], axis=-1)


def encode_learned(t: Floats, a: Floats) -> bytes:
    """The file of a correction (N, 6) at times (N,) [s]."""
    rows = np.column_stack([t, a]).tolist()
    return tables.encode_csv([["t_s", *COLUMNS], *rows])


def check_repeats(motion: Motion) -> None:
    """Check that a motion is one that can be learned.

    Raises:
        DqpaintError: a set point jumps in it.
    """
    if motion.jump.any():
        line = motion.program.line_name(motion.source.at(int(np.argmax(motion.jump))))
        raise DqpaintError(
            f"{line}: the set point jumps, and no correction of a path makes an arm jump; "
            "rehearse a drawing without step"
        )

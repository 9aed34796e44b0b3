"""Where the point is along a stroke: place and derivatives over the fraction of its parameter."""

from collections.abc import Callable

import numpy as np

from dqpaint import dq
from dqpaint.dq import Floats
from dqpaint.language.program import Arc, Curve, Straight, Vector
from dqpaint.language.taylor import Taylor

Places = Callable[[Floats], Floats]  # f (N,) -> (4, N, 3): p, p', p'', p''' [m]


def place_straight(path: Straight, start: Vector) -> Places:
    """A straight line: p = p0 + f b."""
    p0, by = np.array(start), np.array(path.by)

    def places(f: Floats) -> Floats:
        out = np.zeros((4, len(f), 3))
        out[0] = p0 + f[:, None] * by
        out[1] = by
        return out

    return places


def place_arc(path: Arc, start: Vector) -> Places:
    """Circle, helix, spiral, cone: p = c + f rise l + (r0 + f grow) (cos(f A) e1 + sin(f A) e2).

    c is the foot of the start on the axis, e1 points from there to the start, e2 = l x e1.
    """
    axis, p0 = np.array(path.axis), np.array(start)
    arm = p0 - np.array(path.centre)
    foot = p0 - (arm - axis * (arm @ axis))
    radius = float(np.linalg.norm(p0 - foot))
    e1 = (p0 - foot) / radius
    e2 = dq.cross(axis, e1)
    angle = path.angle

    def places(f: Floats) -> Floats:
        c, s = np.cos(f * angle)[:, None], np.sin(f * angle)[:, None]
        outward, along = c * e1 + s * e2, c * e2 - s * e1
        r = radius + f[:, None] * path.grow
        rise, grow = path.rise * axis, path.grow
        return np.stack([
            foot + f[:, None] * rise + r * outward,
            rise + grow * outward + angle * r * along,
            2 * angle * grow * along - angle**2 * r * outward,
            -3 * angle**2 * grow * outward - angle**3 * r * along,
        ])  # fmt: skip

    return places


def place_curve(path: Curve) -> Places:
    """The formula's own value and its exact derivatives, scaled from the parameter to f.

    The function raises FloatingPointError where place, velocity or acceleration is not finite.
    """
    span = path.upper - path.lower
    scale = np.array([1.0, span, span**2, span**3])[:, None, None]

    def places(f: Floats) -> Floats:
        with np.errstate(all="ignore"):
            point = path.formula(Taylor.variable(path.lower + f * span))
            derivatives: Floats = np.stack([c.derivatives for c in point], axis=-1) * scale
        if not np.isfinite(derivatives[:3]).all():
            raise FloatingPointError("a formula, or one of its derivatives, is not finite")
        return derivatives

    return places

"""What laws see, made for tests: everything any of them may look at, from general states."""

import numpy as np

from dqpaint import dq
from dqpaint.controllers import CONTROLLERS, Arm, Controller, Seen
from dqpaint.controllers.laws.pereira.p import RateGains
from dqpaint.language import parse
from dqpaint.motion import plan
from dqpaint.robots.kinematics.kinematics import Kinematics, manipulability
from dqpaint.robots.model.card import read_card

ARM = Kinematics(read_card("iiwa"))
SHORT = plan(
    parse("period 8 ms\nline to (60, 20, 5) mm tool rot(y, 20 deg) in 0.8 s\n", "short.traj"),
    ARM.card.canvas.pose,
)
STILL = plan(parse("period 8 ms\nhold 0.8 s\n", "still.traj"), ARM.card.canvas.pose)


def started(controller, arm=ARM, motion=SHORT, **gains):
    """The law of a run along a motion."""
    return controller.start(Arm(arm), motion, controller.read_gains(gains))


def law(name, motion=SHORT, **gains):
    """The law of a run, as a function of what it sees alone."""
    chosen = CONTROLLERS[name]
    said, now = started(chosen, motion=motion, **gains), chosen.read_gains(gains).first
    return lambda seen: said(seen, now)


def seen_by(arm, q, x_d, rng=None):
    """In a posture (n,), asked for a pose; with `rng` everything moves, without it nothing."""
    x, J = arm.pose_and_jacobian(q)
    draw = (lambda n: np.zeros(n)) if rng is None else (lambda n: rng.normal(size=n))
    return Seen(x, x_d, draw(6), draw(6), J, q, 0.0, 0.008, draw(len(q)))


def body_sees(x, x_d, twist_d=None, acceleration_d=None, twist=None, time=0.0):
    """A free body whose six joint rates are its twist: J_w = I."""
    zero = np.zeros(6)
    return Seen(
        x, x_d, zero if twist_d is None else twist_d,
        zero if acceleration_d is None else acceleration_d, np.eye(6), zero, time, 0.008,
        zero if twist is None else twist,
    )  # fmt: skip


def states(rng, n, size=0.3):
    """What a law sees at random healthy postures, with errors up to about `size`."""
    out = []
    while len(out) < n:
        q = rng.uniform(ARM.card.lower, ARM.card.upper)
        x, J = ARM.pose_and_jacobian(q)
        if manipulability(J) < 0.03:
            continue
        error = dq.exp(rng.uniform(-size, size, 6) / 2)
        out.append(seen_by(ARM, q, dq.mul(error, x) * rng.choice([-1, 1]), rng))
    return out


def accelerate(seen, gains):
    """Resolved acceleration at the tool, enough of a law for the torque-driven arm."""
    x_e = dq.mul(dq.nearest(seen.pose_d, seen.pose), dq.conj(seen.pose))
    return 400 * dq.log(x_e) + 20 * (seen.twist_d - seen.twist) + seen.acceleration_d


ACCEL = Controller("accelerate", "none", RateGains, accelerate, "acceleration")

"""One angle -> how fast four laws turn home from it: the functions, and their chart."""

import numpy as np

from dqpaint.controllers import CONTROLLERS, Arm, Seen
from dqpaint.dq import Floats, exp, pose_from
from dqpaint.language import parse
from dqpaint.motion import plan
from dqpaint.robots.kinematics import Kinematics
from dqpaint.robots.model import DEFAULT_ROBOT, read_card
from dqpaint.studies.report.charts import Line, Panel, chart

LAWS = {
    "log": ({"k": 1.0}, "theta"),
    "sine": ({"k": 1.0}, "2 sin(theta / 2)"),
    "hinf": ({"K_O": 1.0}, "sin(theta / 2)"),
    "se3": ({"k_R": 1.0}, "sin(theta)"),
}
"""The same gain K = 1 1/s for all, and what each is of theta."""
ANGLES = np.linspace(0.0, np.pi, 181)


def turning_rates(law: str, gains: dict[str, float], angles: Floats) -> Floats:
    """How fast (N,) [rad/s] a law turns the tool home from angles (N,) [rad] about z.

    The law itself is asked, about a free body whose six joint rates are its twist.
    """
    zero, x_d = np.zeros(6), pose_from([0.0, 0.0, 0.0], [1.0, 0.0, 0.0, 0.0])
    chosen = CONTROLLERS[law]
    schedule = chosen.read_gains(gains)
    arm = Kinematics(read_card(DEFAULT_ROBOT))
    still = plan(parse("hold 0.1 s\n", "still.traj"), arm.card.canvas.pose)
    said = chosen.start(Arm(arm), still, schedule)
    found = []
    for angle in angles.tolist():
        x = exp(0.5 * np.array([0.0, 0.0, angle, 0.0, 0.0, 0.0]))
        seen = Seen(x, x_d, zero, zero, np.eye(6), zero, 0.0, 0.008, zero)
        found.append(-said(seen, schedule.first)[2])
    return np.array(found)


def picture() -> bytes:
    """The four functions as a PNG."""
    degrees = np.degrees(ANGLES)
    lines = [
        Line(degrees, turning_rates(law, gains, ANGLES), f"{law}: {told}")
        for law, (gains, told) in LAWS.items()
    ]
    panel = Panel("Which error?", "error [deg]", "rate at which it turns home, by K [rad]", lines)
    return chart([panel])


def table() -> list[list[str]]:
    """Rates at some angles, by K: the table of `docs/which-error.md`."""
    at = np.radians([10.0, 90.0, 179.0])
    rows = [["law", "near 0", "10 deg", "90 deg", "179 deg"]]
    for law, (gains, _told) in LAWS.items():
        near = turning_rates(law, gains, np.array([1e-6]))[0] / 1e-6
        rates = turning_rates(law, gains, at)
        rows.append([law, f"{near:.2f}", *(f"{rate:.3f}" for rate in rates)])
    return rows

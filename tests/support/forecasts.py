"""Random drawings and an arm that no limit stops: to run what a forecast speaks of."""

import numpy as np

from dqpaint.robots.model.card import Limits


def random_drawing(seed):
    """Four lines within reach; some of them too fast, some with corners, some turning far."""
    rng = np.random.default_rng([2016, seed])
    text = "period 4 ms\nstart at (0, 0) mm\n"
    for _ in range(4):
        x, y, z = rng.uniform(-140, 140, 3) * [1, 1, 0.3]
        profile = rng.choice(["trapezoid", "quintic", "constant"], p=[0.5, 0.35, 0.15])
        speed = np.exp(rng.uniform(np.log(60), np.log(1200)))
        text += f"line to ({x:.0f}, {y:.0f}, {z:.0f}) mm speed {speed:.0f} mm/s profile {profile}"
        if rng.random() < 0.6:
            text += f" tool rot({rng.choice(list('xyz'))}, {rng.uniform(-60, 60):.0f} deg)"
        text += " light red\n"
    return text


def lifted(card):
    """The same arm with limits so wide that none is ever met."""
    n = card.joints
    limits = Limits(
        lower_deg=(-2000,) * n, upper_deg=(2000,) * n, speed_deg_s=(1e6,) * n, effort_Nm=(1e6,) * n
    )
    return card.model_copy(update={"limits": limits})


def rows_of(track, line):
    return np.flatnonzero(track.motion.source.line[:-1] == line)

"""The Riccati equation of lqr8 against RK4 of the same: `python tests/bench/bench_riccati.py`.

3000 control periods of 8 ms with P and g, in numpy; rounds are interleaved. The target is at most
0.7 times the RK4, which is less exact, and diverges for small r. Both need the twists.
"""

import statistics
import sys
import time

import numpy as np

from dqpaint import dq
from dqpaint.controllers import CONTROLLERS
from dqpaint.controllers.laws.pereira import lqr, lqr8
from dqpaint.controllers.laws.pereira.lqr8 import PLACES
from dqpaint.language import parse
from dqpaint.motion import plan
from dqpaint.robots.model.card import read_card

TEXT = "period 8 ms\narc centre (50, 0) mm angle 3 turn in 24 s profile constant tool rpy(30 deg, 0 deg, 60 deg)\n"  # noqa: E501


def runge_kutta(motion, q, r):
    """P (N, 8, 8) and g (N, 8) by explicit steps of the period; twists half-way by their mean."""
    y = 0.5 * dq.adjoint(dq.conj(motion.pose), motion.twist)
    y = dq.pure(np.stack([y[:-1], 0.5 * (y[:-1] + y[1:]), y[1:]]))
    A, c = dq.hamilton_minus(y), -y
    P, g, h, Q, W = np.eye(8) * np.sqrt(q * r), np.zeros(8), -motion.period, q * np.eye(8), 1 / r
    Ps, gs = np.empty((len(motion.t), 8, 8)), np.empty((len(motion.t), 8))
    Ps[-1], gs[-1] = P, g

    def slope(P, g, A, c):
        PA, PW = P @ A, W * P
        return PW @ P - PA - PA.T - Q, PW @ g - A.T @ g - P @ c

    for k in range(len(motion.t) - 2, -1, -1):
        a, e = slope(P, g, A[2, k], c[2, k])
        b, f = slope(P + h / 2 * a, g + h / 2 * e, A[1, k], c[1, k])
        d, j = slope(P + h / 2 * b, g + h / 2 * f, A[1, k], c[1, k])
        m, n = slope(P + h * d, g + h * j, A[0, k], c[0, k])
        P = P + h / 6 * (a + 2 * b + 2 * d + m)
        g = g + h / 6 * (e + 2 * f + 2 * j + n)
        Ps[k], gs[k] = P, g
    return Ps, gs


def main():
    rounds = int(sys.argv[1]) if len(sys.argv) > 1 else 15
    motion = plan(parse(TEXT, "bench.traj"), read_card("iiwa").canvas.pose)
    gains = {name: CONTROLLERS[name].read_gains({}) for name in ("lqr8", "lqr")}
    ways = {
        "RK4": lambda: runge_kutta(motion, 4.0, 0.01),
        "lqr8": lambda: lqr8.riccati(motion, gains["lqr8"]),
        "lqr": lambda: lqr.riccati(motion, gains["lqr"]),
    }
    times = {name: [] for name in ways}
    for _ in range(rounds + 1):
        for name, way in ways.items():
            begin = time.perf_counter()
            way()
            times[name].append(time.perf_counter() - begin)
    medians = {name: statistics.median(values[1:]) for name, values in times.items()}
    for name, middle in medians.items():
        print(f"{name:5} {middle * 1e3:7.1f} ms   {middle / medians['RK4']:.2f} x RK4")
    exact, rough = ways["lqr8"](), ways["RK4"]()
    gaps = [np.abs(exact[0][:, PLACES] - rough[0]).max(), np.abs(exact[1] - rough[1]).max()]
    print(f"apart by {gaps[0]:.1e} in P, {gaps[1]:.1e} in g")


if __name__ == "__main__":
    main()

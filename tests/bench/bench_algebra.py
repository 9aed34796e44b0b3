"""Dual quaternions in batches: python -m tests.bench.bench_algebra. Read the ratios.

Each function of 100,000 rows against a copy of the arrays of a product, and the product against
the C++ library dqrobotics, one object a pose.
"""

from __future__ import annotations

import numpy as np
from dqrobotics import DQ

from dqpaint import dq
from tests.bench.bench_film import best

ROWS = 100_000


def main() -> None:
    rng = np.random.default_rng(1)
    a, b = rng.normal(size=(2, ROWS, 8))
    twist, s = a[:, :6], a[:, 0]
    x, y = dq.exp(a[:, :6]), dq.exp(b[:, :6])
    pairs = [(DQ(p), DQ(q)) for p, q in zip(a[:5_000], b[:5_000], strict=True)]
    copy = best(lambda: (a.copy(), b.copy()), 9)
    peer = best(lambda: [p * q for p, q in pairs], 9) * ROWS / len(pairs)
    print(f"copy of two arrays: {ROWS / copy / 1e3:.1f} M rows/s")
    print(f"{'':12} {'M/s':>6} {'times a copy':>13}")
    for name, work in {
        "dqrobotics *": None,
        "mul": lambda: dq.mul(a, b),
        "exp": lambda: dq.exp(twist),
        "log": lambda: dq.log(x),
        "adjoint": lambda: dq.adjoint(x, twist),
        "sclerp": lambda: dq.sclerp(x, y, s),
        "translation": lambda: dq.translation(x),
        "rotate": lambda: dq.rotate(x[:, :4], a[:, :3]),
        "pose_from": lambda: dq.pose_from(a[:, :3], x[:, :4]),
    }.items():
        ms = best(work, 9) if work else peer
        print(f"{name:12} {ROWS / ms / 1e3:6.1f} {ms / copy:13.2f}")


if __name__ == "__main__":
    main()

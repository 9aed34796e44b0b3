"""Weights and dynamics -> the Riccati solutions of the LQR laws, backwards and always stable.

P_dot = -P A - A'P + P W P - Q and g_dot = -A'g + P W g - P c, with W = R^-1, belong to a linear
flow of the error e and its costate p = P e + g:

    [e; p]_dot = [[A, -W], [-Q, -A']] [e; p] + [c; 0]

Over one control interval the flow is the exponential of a 4th-order Magnus exponent, from its two
Gauss points. Written as what leaves the interval by what enters it, e at its start and p at its
end (Redheffer's scattering form), it stays bounded however stiff the equation is:

    e1 = E e0 - G p1 + d,    p0 = E' p1 + H e0 + f,    G and H symmetric, not negative

so P0 = H + E' P1 (I + G P1)^-1 E. An explicit step of P itself diverges once h |W P| > 2.8. At the
usual 20 1/s and 8 ms P and g are exact to 1e-6; at the thesis's best gain, 164 1/s, g is to 1e-4.
Where the rate sqrt(q / r) is beyond pi / h, the exponent's commutator is left out: it might make Q
or W negative, and a mean of positive ones is positive.
"""

from typing import NamedTuple

import numpy as np

from dqpaint.dq import Floats
from dqpaint.robots.kinematics import solve

GAUSS = np.array([0.5 - np.sqrt(3) / 6, 0.5 + np.sqrt(3) / 6])  # of an interval
SERIES_NORM = 0.5  # norm of an exponent whose exponential is a short series
MAGNUS_NORM = np.pi  # norm of an exponent beyond which Magnus' series means nothing


class Scattering(NamedTuple):
    """What leaves intervals by what enters them, see above; (n, m, m) and (n, m)."""

    E: Floats
    G: Floats
    H: Floats
    d: Floats
    f: Floats


def scattering(A: Floats, W: Floats, Q: Floats, c: Floats, h: float) -> Scattering:
    """Of n intervals at once.

    Args:
        A: (2, n, m, m) at the two Gauss points of each interval [1/s].
        W: R^-1 (2, n, m, m), positive definite.
        Q: (2, n, m, m), positive definite.
        c: (2, n, m).
        h: the length of an interval [s].
    """
    m = A.shape[-1]
    sizes = (np.diagonal(one.sum(0), axis1=-2, axis2=-1) for one in (Q, W))
    root = np.divide(*sizes) ** 0.25  # e in units of 1 / root, p of root: W and Q are alike
    products = root[..., :, None] * root[..., None, :]
    K = np.zeros((*A.shape[:2], 2 * m + 1, 2 * m + 1))
    K[..., :m, :m] = root[..., :, None] * A / root[..., None, :]
    K[..., m : 2 * m, m : 2 * m] = -K[..., :m, :m].swapaxes(-1, -2)
    K[..., :m, m : 2 * m] = -W * products
    K[..., m : 2 * m, :m] = -Q / products
    K[..., :m, -1] = root * c
    exponent = 0.5 * h * (K[0] + K[1])
    tame = np.abs(exponent).sum(-1).max(-1) < MAGNUS_NORM
    size = np.where(tame, np.sqrt(3) / 12 * h**2, 0.0)[:, None, None]
    exponent += size * (K[1] @ K[0] - K[0] @ K[1])
    norm = np.abs(exponent).sum(-1).max()
    halvings = max(0, int(np.ceil(np.log2(max(norm, 1e-300) / SERIES_NORM))))
    piece = _scattered(_exponential(exponent / 2.0**halvings), m)
    for _ in range(halvings):
        piece = _doubled(piece)
    E, G, H, d, f = piece
    left, right = root[..., :, None], root[..., None, :]
    return Scattering(E / left * right, G / (left * right), H * left * right, d / root, f * root)


def _exponential(K: Floats) -> Floats:
    """exp(K) (n, k, k) by its series of degree 8, for norms up to `SERIES_NORM`."""
    eye = np.eye(K.shape[-1])
    K2 = K @ K
    K3, K4 = K2 @ K, K2 @ K2
    upper = eye / 24 + K / 120 + K2 / 720 + K3 / 5040 + K4 / 40320
    return np.asarray(eye + K + K2 / 2 + K3 / 6 + K4 @ upper)


def _scattered(flow: Floats, m: int) -> Scattering:
    """The scattering form of flows (n, 2m+1, 2m+1) of [e; p; 1]."""
    lower = flow[:, m : 2 * m]
    known = np.concatenate(
        [np.broadcast_to(np.eye(m), lower[..., :m].shape), -lower[..., :m], -lower[..., -1:]], -1
    )
    solved = np.linalg.solve(lower[..., m : 2 * m], known)
    F, H, f = solved[..., :m], solved[..., m : 2 * m], solved[..., -1]
    to_error = flow[:, :m, m : 2 * m]
    d = flow[:, :m, -1] + np.matvec(to_error, f)
    return Scattering(F.swapaxes(-1, -2), -to_error @ F, H, d, f)


def _doubled(one: Scattering) -> Scattering:
    """Two equal intervals, one after the other, as one (Anderson 1978's doubling)."""
    E, G, H, d, f = one
    back = E.swapaxes(-1, -2)
    m = E.shape[-1]
    rest = (d - np.matvec(G, f))[..., None]
    solved = np.linalg.solve(np.eye(m) + G @ H, np.concatenate([E, G @ back, rest], -1))
    on, through, drift = solved[..., :m], solved[..., m : 2 * m], solved[..., -1]
    return Scattering(
        E @ on,
        G + E @ through,
        H + back @ H @ on,
        d + np.matvec(E, drift),
        f + np.matvec(back, f + np.matvec(H, drift)),
    )


def solve_backwards(intervals: Scattering, P: Floats, g: Floats) -> tuple[Floats, Floats]:
    """P (n, m, m) and g (n, m) at the starts of n intervals, from those at the end of the last."""
    m = intervals.d.shape[-1]
    slack = np.linalg.inv(intervals.G)  # (I + G P)^-1 = (G^-1 + P)^-1 G^-1, and that is symmetric
    enters = slack @ np.concatenate([intervals.E, intervals.d[..., None]], axis=-1)
    prices = np.concatenate([intervals.H, intervals.f[..., None]], axis=-1)
    after = np.column_stack([P, g])
    for k in range(len(slack) - 1, -1, -1):
        enters[k, :, m] -= after[:, m]
        costate = np.dot(after[:, :m], solve(slack[k] + after[:, :m], enters[k]))
        costate[:, m] += after[:, m]
        after = prices[k]
        after += np.dot(intervals.E[k].T, costate)  # in place: row k of what is returned
    return prices[..., :m], prices[..., m]


def solve_elements_backwards(W: Floats, Q: Floats, P: Floats, h: float) -> Floats:
    """P (n + 1, m) of P_dot = W P^2 - Q, each element by itself, backwards from P (m,) at the end.

    Args:
        W: the diagonal of R^-1 (2, n, m) at the two Gauss points of each interval.
        Q: the diagonal (2, n, m).
        P: at the end (m,).
        h: the length of an interval [s].

    The exponent is [[a, -w], [-q, -a]], with a from the Magnus commutator; its exponential is a
    matter of tanh, which never overflows.
    """
    w, q = 0.5 * h * W.sum(0), 0.5 * h * Q.sum(0)
    a = np.sqrt(3) / 12 * h**2 * (W[1] * Q[0] - W[0] * Q[1])
    root = np.sqrt(a**2 + w * q)
    T = np.tanh(root) / root
    Ps = np.empty((len(w) + 1, *w.shape[1:]))
    Ps[-1] = P
    gain, over, under = T * q, 1.0 + T * a, 1.0 - T * a
    slope = T * w
    for k in range(len(w) - 1, -1, -1):
        Ps[k] = P = (gain[k] + over[k] * P) / (under[k] + slope[k] * P)
    return Ps

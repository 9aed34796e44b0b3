"""Damped pseudo-inverses: what is done near a singularity, side by side.

    q_dot = J^# u + (I - J^# J) z

With u_i, v_i, s_i the singular vectors and values of the tool's Jacobian, lengths in units of 0.3 m
so that radians and metres can be compared. Of a task with several parts each later one moves in
what those before it leave free: q_dot = J_1^# u_1 + (J_2 N_1)^# (u_2 - J_2 J_1^# u_1).
"""

from collections.abc import Sequence
from typing import ClassVar, cast

import numpy as np
from pydantic import Field
from typing_extensions import override

from dqpaint import dq
from dqpaint.dq import Floats
from dqpaint.robots.kinematics import (
    DAMPING_THRESHOLD,
    damped_force,
    damped_inverse,
    damped_inverse_times,
    resolve,
    resolve_parts,
)
from dqpaint.robots.resolvers.resolver import RESOLVERS, Setup, State, Values

NO_TWIST = np.zeros(6)  # of a tool that stays


class NoValues(Values):
    """None."""


class PseudoInverse:
    """A resolver by a function of the singular values; without one, that of `filter`."""

    options: ClassVar[type[Values]] = NoValues
    batched: ClassVar[bool] = True
    holds_rates: ClassVar[bool] = False

    def __init__(self, setup: Setup, values: Values) -> None:
        self._parts = setup.task.parts

    def damping(self, squares: Floats) -> Floats:
        """What stands for 1 / s^2, for s^2 (..., m) in ascending order."""
        raise NotImplementedError

    def inverse_times(self, J: Floats, left: Floats) -> Floats:
        """J^# left (..., n), for J (..., m, n)."""
        return np.asarray(np.vecmat(damped_force(J @ J.mT, left, self.damping), J))

    def rates(self, state: State, twists: Sequence[Floats], wish: Floats | None) -> Floats:
        """See `Resolver`."""
        return resolve_parts(
            state.jacobian, state.pose, twists, self._parts, wish, self.inverse_times
        )

    def null_motion(self, state: State, wish: Floats) -> Floats:
        """See `Resolver`."""
        return self.rates(state, [NO_TWIST] * len(self._parts), wish)

    def allowed(self, state: State, rates: Floats) -> Floats:
        """The same rates."""
        return rates


@RESOLVERS.add("filter")
class Filter(PseudoInverse):
    """Numerical filter: each singular direction is damped by itself, below a threshold alone.

    l_i^2 = l^2 (1 - (s_i / t)^2) for s_i < t, so that the other directions stay exact (after
    Maciejewski and Klein 1988, and Chiaverini 1997, who damps all of the small ones).
    """

    class Options(Values):
        """Where it begins, and how strongly."""

        threshold: float = Field(
            DAMPING_THRESHOLD, gt=0, le=1, description="singular values below it are damped"
        )
        peak: float = Field(
            DAMPING_THRESHOLD / 2, ge=1e-6, le=1, description="l, the damping at a singularity"
        )

    options: ClassVar[type[Values]] = Options

    def __init__(self, setup: Setup, values: Values) -> None:
        super().__init__(setup, values)
        given = cast(Filter.Options, values)
        self._limit, self._most = given.threshold**2, (given.peak / given.threshold) ** 2
        self._usual = given == Filter.Options.model_validate(
            {}
        )  # then an inverse often spares the directions

    @override
    def damping(self, squares: Floats) -> Floats:
        squares = np.maximum(squares, 0.0)
        return np.asarray(1.0 / (squares + self._most * np.maximum(self._limit - squares, 0.0)))

    @override
    def inverse_times(self, J: Floats, left: Floats) -> Floats:
        return damped_inverse_times(J, left) if self._usual else super().inverse_times(J, left)

    @override
    def rates(self, state: State, twists: Sequence[Floats], wish: Floats | None) -> Floats:
        if not self._usual or len(self._parts) > 1:
            return super().rates(state, twists, wish)
        rows = self._parts[0].rows(state.pose)
        point = dq.translation(state.pose)
        return resolve(state.jacobian, point, twists[0], wish, damped_inverse, rows)


@RESOLVERS.add("none")
class Plain(PseudoInverse):
    """Moore and Penrose's: nothing is damped, and joint rates grow without end at a singularity."""

    @override
    def damping(self, squares: Floats) -> Floats:
        rounding = 6 * np.finfo(np.float64).eps * squares[..., -1:]
        known = squares > rounding
        return np.where(known, 1.0 / np.where(known, squares, 1.0), 0.0)


@RESOLVERS.add("wampler")
class Wampler(PseudoInverse):
    """One damping everywhere: l^2 is added to every s^2 (Wampler 1986, damped least squares)."""

    class Options(Values):
        """How strongly."""

        factor: float = Field(
            0.01, ge=1e-6, le=1, description="l in rad/rad, lengths in units of 0.3 m"
        )

    options: ClassVar[type[Values]] = Options

    def __init__(self, setup: Setup, values: Values) -> None:
        super().__init__(setup, values)
        self._square = cast(Wampler.Options, values).factor ** 2

    @override
    def damping(self, squares: Floats) -> Floats:
        return np.asarray(1.0 / (np.maximum(squares, 0.0) + self._square))


@RESOLVERS.add("uniform")
class Uniform(PseudoInverse):
    """One damping for all directions, near singularities alone (Nakamura and Hanafusa 1986).

    l^2 = l_0^2 (1 - w / w_0)^2 where w = sqrt(det(J J')) is below w_0: the healthy directions pay
    for the singular one, which `filter` spares them.
    """

    class Options(Values):
        """Where it begins, and how strongly."""

        factor: float = Field(0.04, ge=1e-6, le=1, description="l_0, the damping at a singularity")
        below: float = Field(
            0.02, gt=0, le=10, description="w_0, the manipulability below which it begins"
        )

    options: ClassVar[type[Values]] = Options

    def __init__(self, setup: Setup, values: Values) -> None:
        super().__init__(setup, values)
        given = cast(Uniform.Options, values)
        self._square, self._below = given.factor**2, given.below

    @override
    def damping(self, squares: Floats) -> Floats:
        squares = np.maximum(squares, 0.0)
        volume = np.sqrt(squares.prod(axis=-1, keepdims=True))
        near = np.maximum(1.0 - volume / self._below, 0.0)
        return np.asarray(1.0 / np.maximum(squares + self._square * near**2, 1e-300))


@RESOLVERS.add("selective")
class Selective(PseudoInverse):
    """Selectively damped: each direction is clamped by what it would cost the joints (Buss 2005).

    tau_i = v_i (u_i'u) / s_i is clamped to g_i = g min(1, 1 / M_i) with M_i = sum_j |v_ji| |J_j| /
    s_i, and the sum to g. Buss and Kim clamp steps of an iteration, at 45 degrees; here they are
    rates, so g is in rad/s and scales with how fast a drawing is.
    """

    class Options(Values):
        """How fast at most."""

        most: float = Field(10.0, gt=0, le=100, description="g in rad/s, of the largest joint rate")

    options: ClassVar[type[Values]] = Options

    def __init__(self, setup: Setup, values: Values) -> None:
        super().__init__(setup, values)
        self._most = cast(Selective.Options, values).most

    @override
    def inverse_times(self, J: Floats, left: Floats) -> Floats:
        U, s, Vt = np.linalg.svd(J, full_matrices=False)
        known = s > 1e-12
        inverse = np.where(known, 1.0 / np.where(known, s, 1.0), 0.0)
        steps = (np.vecmat(left, U) * inverse)[..., None] * Vt  # (..., m, n), a direction a row
        columns = np.sqrt((J * J).sum(axis=-2))
        cost = np.matvec(np.abs(Vt), columns) * inverse
        most = self._most * np.minimum(1.0, 1.0 / np.maximum(cost, 1e-12))
        return _clamped(_clamped(steps, most).sum(axis=-2), np.array(self._most))


def _clamped(rates: Floats, most: Floats) -> Floats:
    """Vectors (..., n) made shorter where their largest entry is above `most` (...,)."""
    largest = np.maximum(np.abs(rates).max(axis=-1), 1e-300)
    return np.asarray(rates * np.minimum(1.0, most / largest)[..., None])

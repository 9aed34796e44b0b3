"""Commanded twist and inequalities -> the nearest joint rates that keep them, by a program.

    min |J (q_dot - q_dot_0)|^2 + l |q_dot - q_dot_0|^2
    A q_dot <= b,  lower <= q_dot <= upper

q_dot_0 is what the resolver `filter` gives for the law's twist and the wish of the null space, J
the task's rows at the tool's point: where J q_dot_0 = u that is |J q_dot - u|^2, and where nothing
is active it is q_dot_0 itself. Inequalities are vector fields (Marinho et al. 2019): a distance d
may shrink no faster than d_dot >= -eta d, so that d(t) >= d(0) exp(-eta t).
"""

from collections.abc import Callable, Sequence
from ctypes import c_int
from typing import ClassVar, NamedTuple, cast

import numpy as np
from numpy.typing import NDArray
from pydantic import Field

from dqpaint import dq
from dqpaint.dq import Floats
from dqpaint.errors import DqpaintError, UsageError
from dqpaint.robots.kinematics import tool_jacobian_map
from dqpaint.robots.resolvers.pseudo_inverses import Filter
from dqpaint.robots.resolvers.resolver import RESOLVERS, Setup, State, Values

FLATNESS = 1e-5  # l, what a joint rate costs beside the tool's motion
SLACK_COST = 1e4  # of a unit by which all inequalities are missed
MOST_SLACK = 1e6
FEASIBLE = 1e-9  # by which an inequality may be missed for rounding
SECOND_PART = 1e-3  # weight of what comes second in a task beside what comes first
USUAL_APPROACH = 0.1  # eta T
SOLVED = (1, 2)  # answers of the solver


class Bounds(NamedTuple):
    """What joint rates have to keep.

    Attributes:
        lower: (n,) [rad/s].
        upper: (n,) [rad/s].
        A: (m, n), of distances: A q_dot <= b.
        b: (m,) [m/s].
        wall: of the drawing, that a row is of (m,).
        distance: the distances themselves (m,) [m].
    """

    lower: Floats
    upper: Floats
    A: Floats
    b: Floats
    wall: NDArray[np.intp] = np.zeros(0, dtype=np.intp)
    distance: Floats = np.zeros(0)


class Held(NamedTuple):
    """What walls did in a row.

    Attributes:
        walls: whether each of the drawing's held the arm back (W,).
        lost: the tool's velocity that was given up [m/s].
    """

    walls: NDArray[np.bool_]
    lost: float


class Answer(NamedTuple):
    """Joint rates and what they had to give up.

    Attributes:
        rates: (n,) [rad/s].
        active: which rows of A (m,) held them.
        slack: by how much all rows are missed [m/s]; 0 where they are kept.
    """

    rates: Floats
    active: NDArray[np.bool_]
    slack: float


@RESOLVERS.add("qp")
class Qp:
    """A quadratic program: walls, joint limits, rates and accelerations are kept as inequalities.

    With eta T <= 1 a step never passes a wall; above 1 it does, which is refused unless forced.
    """

    class Options(Values):
        """How near limits and walls may be approached."""

        eta: float | None = Field(
            None, gt=0, le=1e4,
            description="1/s, how fast a distance may shrink, as a part of it; 0.1 a period",
        )  # fmt: skip
        acceleration: float | None = Field(
            None, gt=0, le=1e5, description="rad/s2, of every joint; without end if not said"
        )
        force: bool = Field(False, description="yes: take an eta that passes walls")

    options: ClassVar[type[Values]] = Options
    batched: ClassVar[bool] = False
    holds_rates: ClassVar[bool] = True

    def __init__(self, setup: Setup, values: Values) -> None:
        given, card = cast(Qp.Options, values), setup.kinematics.card
        self.eta = USUAL_APPROACH / setup.period if given.eta is None else given.eta
        if self.eta * setup.period > 1.0 + 1e-12 and not given.force:
            raise UsageError(
                f"resolver 'qp': eta {self.eta:g} 1/s with a period of {setup.period * 1e3:g} ms "
                f"passes walls: it is kept to 1 a period, {1 / setup.period:g} here; force=yes "
                "takes it all the same"
            )
        self._task, self._arm, self._period = setup.task, setup.kinematics, setup.period
        self._nominal = Filter(setup, Filter.options.model_validate({}))
        self._lower, self._upper, self._speed = card.lower, card.upper, card.speed
        self._approach = min(self.eta, 1.0 / setup.period)  # joint limits are kept in any case
        self._change = np.inf if given.acceleration is None else given.acceleration * setup.period
        self._last: Floats | None = None
        self._walls = setup.walls
        self.history: list[Held] = []

    def rates(self, state: State, twists: Sequence[Floats], wish: Floats | None) -> Floats:
        """See `Resolver`."""
        nominal = self._nominal.rates(state, twists, wish)
        return self._keep(state, nominal, lambda: self.weight(state))

    def null_motion(self, state: State, wish: Floats) -> Floats:
        """See `Resolver`."""
        return self._nominal.null_motion(state, wish)

    def allowed(self, state: State, rates: Floats) -> Floats:
        """The nearest rates to a law's own (n,), joint by joint."""
        return self._keep(state, rates, lambda: np.eye(len(rates)))

    def _keep(self, state: State, wanted: Floats, weight: Callable[[], Floats]) -> Floats:
        bounds = self.bounds(state)
        found = self.nearest(wanted, weight, bounds)
        if found.active.any() and self._approach == self.eta:
            found = self.nearest(wanted, weight, self._ahead(state, bounds, found.rates))
        self._last = found.rates
        if self._walls is not None:
            held = np.zeros(len(self._walls.given), dtype=bool)
            held[bounds.wall[found.active]] = True
            velocity = dq.point_velocity(
                state.jacobian @ (found.rates - wanted), dq.translation(state.pose)
            )
            self.history.append(Held(held, float(np.linalg.norm(velocity))))
        return found.rates

    def _ahead(self, state: State, bounds: Bounds, rates: Floats) -> Bounds:
        """The bounds, less what the bend of the joints' way takes of the distances in a period.

        A wall is straight and a joint's way is not: what the distances will be, beside what the
        gradients promise, is d(q + T q_dot) - (1 - eta T) d, of second order in T.
        """
        assert self._walls is not None
        after = state.posture + self._period * rates
        pose, J = self._arm.pose_and_jacobian(after)
        reached = self._walls.rows(after, pose, J, state.t + self._period).distance
        promised = (1.0 - self.eta * self._period) * bounds.distance
        missing = np.maximum(promised - reached, 0.0)
        return bounds._replace(b=bounds.b - missing / self._period)

    def bounds(self, state: State) -> Bounds:
        """What the next joint rates have to keep, those of the last call included."""
        low = np.maximum(-self._speed, self._approach * (self._lower - state.posture))
        high = np.minimum(self._speed, self._approach * (self._upper - state.posture))
        low, high = np.minimum(low, self._speed), np.maximum(high, -self._speed)
        if self._last is not None and np.isfinite(self._change):
            # limits go before accelerations where they exclude each other
            low, high = (
                np.clip(self._last - self._change, low, high),
                np.clip(self._last + self._change, low, high),
            )
        if self._walls is None:
            return Bounds(low, high, np.zeros((0, len(low))), np.zeros(0))
        rows = self._walls.rows(state.posture, state.pose, state.jacobian, state.t)
        b = self.eta * rows.distance + rows.drift
        return Bounds(low, high, -rows.gradient, b, rows.wall, rows.distance)

    def weight(self, state: State) -> Floats:
        """J'J (n, n): what a change of the joint rates changes of the task, at the tool's point."""
        J = tool_jacobian_map(dq.translation(state.pose)) @ state.jacobian
        total = np.zeros((J.shape[-1],) * 2)
        for part, share in zip(self._task.parts, (1.0, SECOND_PART), strict=False):
            rows = part.rows(state.pose)
            mine = J if rows is None else rows @ J
            total += share * mine.T @ mine
        return total

    @staticmethod
    def nearest(wanted: Floats, weight: Callable[[], Floats], bounds: Bounds) -> Answer:
        """The joint rates nearest to some (n,) that keep the bounds.

        Args:
            wanted: (n,) [rad/s].
            weight: gives the matrix (n, n) by which distances are measured; only called where
                something is in the way.
            bounds: to be kept. Where no rates keep all of A, all are missed by the same least
                slack; the bounds of joints are kept.

        Raises:
            DqpaintError: the solver has no answer.
        """
        A, b = bounds.A, bounds.b
        inside = bool(((bounds.lower <= wanted) & (wanted <= bounds.upper)).all())
        if inside and bool((A @ wanted <= b).all()):
            return Answer(wanted, np.zeros(len(b), dtype=bool), 0.0)
        H = weight() + FLATNESS * np.eye(len(wanted))
        change, lams = _solve(H, bounds.lower - wanted, bounds.upper - wanted, A, b - A @ wanted)
        slack = 0.0
        if change is None:
            n = len(wanted)
            wider = np.zeros((n + 1, n + 1))
            wider[:n, :n], wider[n, n] = H, SLACK_COST
            low, high = (np.append(side - wanted, end) for side, end in
                         ((bounds.lower, 0.0), (bounds.upper, MOST_SLACK)))  # fmt: skip
            missed = np.column_stack([A, -np.ones(len(b))])
            change, lams = _solve(wider, low, high, missed, b - A @ wanted)
            if change is None:
                raise DqpaintError("resolver 'qp': the solver found no rates, not even with slack")
            change, slack, lams = change[:n], float(change[n]), lams[1:]
        rates = np.clip(wanted + change, bounds.lower, bounds.upper)
        return Answer(rates, np.abs(lams[len(wanted) :]) > 0.0, slack)


def _solve(
    H: Floats, low: Floats, high: Floats, A: Floats, b: Floats
) -> tuple[Floats | None, Floats]:
    """The x (n,) of the least x'Hx with low <= x <= high and A x <= b, and multipliers (n + m,)."""
    import daqp  # only what has something in its way needs it

    upper, lower = np.append(high, b), np.append(low, np.full(len(b), -1e30))
    sense = np.zeros(len(upper), dtype=c_int)
    rows = np.ascontiguousarray(A) if len(A) else np.zeros((0, len(low)))
    x, _, answer, info = daqp.solve(
        H, np.zeros(len(low)), rows, upper, lower, sense, primal_tol=FEASIBLE
    )
    return (np.asarray(x) if answer in SOLVED else None), np.asarray(info["lam"])

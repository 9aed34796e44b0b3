"""Ways to the rate of a Jacobian -> their operations, counted: Chandra's (38) and two others.

Each is written out once for any kind of number; the tests hold all against finite differences.
What is counted is the rate alone: the Jacobian, from which all begin, is there already.
"""

from collections import Counter
from collections.abc import Callable, Sequence
from typing import Any

from dqpaint.studies.experiment.statistics import spread
from dqpaint.studies.replay.measure import MEASURES, MeasureRequest, MeasureResult
from dqpaint.studies.replay.measures.cost import Counting
from dqpaint.studies.replay.papers import Paper

Vector = Sequence[Any]
Column = tuple[Vector, Vector]
"""Direction z and velocity v of a joint's column: at the base's origin, or at the tool."""
ARMS = 6, 7, 30


def cross(a: Vector, b: Vector) -> list[Any]:
    """6 multiplications, 3 additions."""
    return [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]


def _plus(a: Vector | None, b: Vector) -> Vector:
    return b if a is None else [x + y for x, y in zip(a, b, strict=True)]


def _times(a: Vector, rate: Any) -> list[Any]:
    return [x * rate for x in a]


def by_screws(columns: Sequence[Column], rates: Vector) -> list[Column]:
    """Chandra (38): s_i_dot = xi_i x s_i, with xi_i the screw velocity of the link before.

    Columns and rates are those at the base's origin. The first does not change.
    """
    w: Vector | None = None
    v: Vector | None = None
    found: list[Column] = []
    for (z, u), rate in zip(columns, rates, strict=True):
        if w is None or v is None:
            found.append(([0.0] * 3, [0.0] * 3))
        else:
            found.append((cross(w, z), _plus(cross(w, u), cross(v, z))))
        w, v = _plus(w, _times(z, rate)), _plus(v, _times(u, rate))
    return found


def by_pairs(columns: Sequence[Column], rates: Vector) -> list[Column]:
    """The sum over all pairs of joints of dJ_i/dq_j q_j_dot, as KDL's solver does it.

    Columns and rates are those at the tool: dz_i/dq_j = z_j x z_i for j before i, dv_i/dq_j = z_j x
    v_i up to i, z_i x v_j beyond.
    """
    found: list[Column] = []
    for i, (z, v) in enumerate(columns):
        turn: Vector | None = None
        shift: Vector | None = None
        for j, (other, w) in enumerate(columns):
            if j < i:
                turn = _plus(turn, _times(cross(other, z), rates[j]))
            change = cross(other, v) if j <= i else cross(z, w)
            shift = _plus(shift, _times(change, rates[j]))
        found.append((turn or [0.0] * 3, shift or [0.0] * 3))
    return found


def by_sums(columns: Sequence[Column], rates: Vector) -> list[Column]:
    """The same rates at the tool in two passes: sums of z q_dot before, and of v q_dot beyond."""
    beyond: list[Vector | None] = [None]
    for (_, v), rate in zip(reversed(columns[1:]), reversed(list(rates[1:])), strict=True):
        beyond.append(_plus(beyond[-1], _times(v, rate)))
    w: Vector | None = None
    found: list[Column] = []
    for (z, v), rate, rest in zip(columns, rates, reversed(beyond), strict=True):
        turn = [0.0] * 3 if w is None else cross(w, z)
        w = _plus(w, _times(z, rate))
        shift = cross(w, v)
        found.append((turn, shift if rest is None else _plus(shift, cross(z, rest))))
    return found


WAYS: dict[str, Callable[[Sequence[Column], Vector], list[Column]]] = {
    "screws (38)": by_screws,
    "pairs of joints, as KDL": by_pairs,
    "sums, at the tool": by_sums,
}
"""By the name of a cell."""


def counted(name: str, joints: int) -> Counter[str]:
    """What a way does for an arm of some joints, on numbers of no meaning."""
    tally: Counter[str] = Counter()

    def some() -> list[Counting]:
        return [Counting(0.25 + 0.01 * i, tally) for i in range(3)]

    columns = [(some(), some()) for _ in range(joints)]
    WAYS[name](columns, [Counting(0.1, tally) for _ in range(joints)])
    return tally


@MEASURES.add("rate-cost")
def rate_cost(paper: Paper, request: MeasureRequest) -> MeasureResult:
    """Multiplications and additions, for arms of 6, 7 and 30 joints."""
    request.nothing_but(paper)
    numbers = {}
    for name in WAYS:
        tallies = {joints: counted(name, joints) for joints in ARMS}
        numbers[name] = {
            "multiplications": spread([tallies[7]["multiplications"]]),
            **{
                f"operations_{n}": spread([tally["multiplications"] + tally["additions"]])
                for n, tally in tallies.items()
            },
        }
    return MeasureResult(numbers, "counted on formulas that are written out")

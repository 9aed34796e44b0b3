"""Ways to compose two poses -> their operations, counted, and the time of ours, measured.

Every way is written out once for any kind of number; the tests see that each gives the pose that
`dq.mul` gives. Counted is what is written: no zero or one is skipped that a program would not know
of beforehand. A negative sign is free, a division counts as a multiplication.
"""

import math
import time
from collections import Counter
from collections.abc import Callable, Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from dqpaint import dq
from dqpaint.dq import Floats
from dqpaint.studies.experiment.statistics import Spread, spread
from dqpaint.studies.replay.measure import MEASURES, MeasureRequest, MeasureResult
from dqpaint.studies.replay.papers import Paper

MANY = 10_000
ROUNDS = 25
JOINTS = 7


class Counting:
    """A number that counts what is done with it; its count is shared by all that come of it."""

    def __init__(self, value: float, tally: Counter[str]) -> None:
        self.value, self.tally = value, tally

    def _new(self, value: float, what: str) -> "Counting":
        self.tally[what] += 1
        return Counting(value, self.tally)

    def __mul__(self, other: "Counting | float") -> "Counting":
        return self._new(self.value * _value(other), "multiplications")

    def __truediv__(self, other: "Counting | float") -> "Counting":
        return self._new(self.value / _value(other), "multiplications")

    def __add__(self, other: "Counting | float") -> "Counting":
        return self._new(self.value + _value(other), "additions")

    def __sub__(self, other: "Counting | float") -> "Counting":
        return self._new(self.value - _value(other), "additions")

    def __rsub__(self, other: float) -> "Counting":
        return self._new(other - self.value, "additions")

    def __neg__(self) -> "Counting":
        return Counting(-self.value, self.tally)


def _value(number: "Counting | float") -> float:
    return number.value if isinstance(number, Counting) else number


def _function(f: Callable[[float], float], what: str) -> Callable[[Any], Any]:
    def apply(number: Any) -> Any:
        if isinstance(number, Counting):
            return number._new(f(number.value), what)
        return f(number)

    return apply


sin, cos = _function(math.sin, "trigonometric"), _function(math.cos, "trigonometric")
acos, sqrt = _function(math.acos, "trigonometric"), _function(math.sqrt, "square_roots")


def quaternions(a: Sequence[Any], b: Sequence[Any]) -> list[Any]:
    """Hamilton's product: 16 multiplications, 12 additions."""
    return [
        a[0] * b[0] - a[1] * b[1] - a[2] * b[2] - a[3] * b[3],
        a[0] * b[1] + a[1] * b[0] + a[2] * b[3] - a[3] * b[2],
        a[0] * b[2] - a[1] * b[3] + a[2] * b[0] + a[3] * b[1],
        a[0] * b[3] + a[1] * b[2] - a[2] * b[1] + a[3] * b[0],
    ]


def dual_quaternions(a: Sequence[Any], b: Sequence[Any]) -> list[Any]:
    """Of 8 numbers each: three products of quaternions."""
    dual = zip(quaternions(a[:4], b[4:]), quaternions(a[4:], b[:4]), strict=True)
    return [*quaternions(a[:4], b[:4]), *(x + y for x, y in dual)]


def whole_matrices(a: Sequence[Any], b: Sequence[Any]) -> list[Any]:
    """Of 16 numbers each, row by row."""
    return _numbers(_matrix(a, 4) @ _matrix(b, 4))


def matrices(a: Sequence[Any], b: Sequence[Any]) -> list[Any]:
    """Of 12 numbers each, the row 0 0 0 1 left out."""
    A = _matrix(a, 3)
    product = A[:, :3] @ _matrix(b, 3)
    product[:, 3] += A[:, 3]
    return _numbers(product)


def hamilton(a: Sequence[Any], b: Sequence[Any]) -> list[Any]:
    """A Hamilton operator H+ (64 numbers) by the 8 numbers of the other pose."""
    return _numbers(_matrix(a, 8) @ _matrix(b, 8))


def _matrix(numbers: Sequence[Any], rows: int) -> NDArray[np.object_]:
    """A matrix of any kind of number: numpy multiplies and adds as they do."""
    return np.array(numbers, dtype=object).reshape(rows, -1)


def _numbers(matrix: NDArray[np.object_]) -> list[Any]:
    return list(matrix.ravel().tolist())


def axis_angles(a: Sequence[Any], b: Sequence[Any]) -> list[Any]:
    """Of 7 numbers each: translation, axis, angle, after Rodrigues; singular without a rotation."""
    (t, axis), p, angle = _matrix(a[:6], 2), _matrix(b[:3], 1)[0], a[6]
    first, second = ([cos(h), *(sin_h * n for n in x[3:6])] for x in (a, b)
                     for h in [x[6] * 0.5] for sin_h in [sin(h)])  # fmt: skip
    w, *v = quaternions(first, second)
    length = sqrt(v[0] * v[0] + v[1] * v[1] + v[2] * v[2])
    s, c = sin(angle), cos(angle)
    position = p * c + np.cross(axis, p) * s + axis * ((axis @ p) * (1.0 - c)) + t
    return [*position, *(x / length for x in v), acos(w) * 2.0]


def screw_dual_quaternion(screw: Sequence[Any], angle: Any) -> list[Any]:
    """exp(angle s / 2) of a unit line s (6), as a dual quaternion; s has no pitch."""
    half = angle * 0.5
    s = sin(half)
    m = [s * x for x in screw]
    return [cos(half), *m[:3], half * 0.0, *m[3:]]


def screw_matrix(screw: Sequence[Any], angle: Any) -> list[Any]:
    """The same as 12 numbers: R after Rodrigues, and (I - R) q for the point q nearest the origin.

    The line comes as its direction, the six products of that, and the point q (12).
    """
    l, squares, q = screw[:3], screw[3:9], screw[9:]  # noqa: E741  the paper's letter
    s, c = sin(angle), cos(angle)
    rest = 1.0 - c
    xx, xy, xz, yy, yz, zz = (rest * x for x in squares)
    x, y, z = (s * a for a in l)
    R = [xx + c, xy - z, xz + y, xy + z, yy + c, yz - x, xz - y, yz + x, zz + c]
    t = np.array(q, dtype=object) - _matrix(R, 3) @ np.array(q, dtype=object)
    return [*R[:3], t[0], *R[3:6], t[1], *R[6:], t[2]]


COMPOSE: dict[str, tuple[int, Callable[..., list[Any]], tuple[int, int]]] = {
    "dual quaternion": (8, dual_quaternions, (8, 8)),
    "4 x 4 matrix": (16, whole_matrices, (16, 16)),
    "3 x 4 matrix": (12, matrices, (12, 12)),
    "Hamilton operator": (64, hamilton, (64, 8)),
    "translation, axis, angle": (7, axis_angles, (7, 7)),
}
"""By the name of a cell: numbers that are stored, the composition, and what it takes."""


def counted(compose: Callable[..., list[Any]], sizes: tuple[int, int]) -> Counter[str]:
    """What a composition does, on numbers of no meaning."""
    tally: Counter[str] = Counter()
    compose(*([Counting(0.25 + 0.01 * i, tally) for i in range(size)] for size in sizes))
    return tally


def arm_operations(name: str) -> int:
    """Multiplications and additions of seven exponentials and their product with the tool."""
    tally: Counter[str] = Counter()

    def some(n: int) -> list[Counting]:
        return [Counting(0.25 + 0.01 * i, tally) for i in range(n)]

    size, compose, _ = COMPOSE[name]
    pose: list[Any] = []
    for _ in range(JOINTS):
        if name == "dual quaternion":
            turn = screw_dual_quaternion(some(6), some(1)[0])
            tally["multiplications"] -= 1  # the zero beside the cosine is no operation
        else:
            turn = screw_matrix(some(12), some(1)[0])
            turn += some(4) if size == 16 else []
        pose = compose(pose, turn) if pose else turn
    compose(pose, some(size))
    return tally["multiplications"] + tally["additions"]


def measured_seconds() -> dict[str, Spread]:
    """The processor's time for one of many compositions [s], rounds interleaved."""
    rng = np.random.default_rng(0)
    q = rng.normal(size=(2, MANY, 4))
    a, b = dq.pose_from(
        rng.normal(size=(2, MANY, 3)), q / np.linalg.norm(q, axis=-1, keepdims=True)
    )
    A, B, H = dq.matrix_from_pose(a), dq.matrix_from_pose(b), dq.hamilton_plus(a)
    works: dict[str, Callable[[], object]] = {
        "dual quaternion": lambda: dq.mul(a, b),
        "4 x 4 matrix": lambda: A @ B,
        "Hamilton operator": lambda: np.matvec(H, b),
    }
    times: dict[str, list[float]] = {name: [] for name in works}
    for turn in range(ROUNDS + 1):
        for name, work in works.items():
            begin = time.thread_time()
            work()
            if turn:  # the first round only warms up
                times[name].append((time.thread_time() - begin) / MANY)
    return {name: spread(values) for name, values in times.items()}


def drifts() -> dict[str, float]:
    """How far from rigid many products of one pose are: | |r| - 1 |, and |R'R - I| by entries."""
    step = dq.pose_from(
        np.array([0.1, -0.2, 0.3]), dq.rotation(dq.exp(np.array([0.3, 0.2, -0.4, 0, 0, 0])))
    )
    x, T = step, dq.matrix_from_pose(step)
    X: Floats = T.copy()
    for _ in range(MANY):
        x, X = dq.mul(step, x), T @ X
    return {
        "dual quaternion": abs(float(np.linalg.norm(x[:4])) - 1.0),
        "4 x 4 matrix": float(np.abs(X[:3, :3].T @ X[:3, :3] - np.eye(3)).max()),
    }


@MEASURES.add("cost")
def cost(paper: Paper, request: MeasureRequest) -> MeasureResult:
    """Storage and operations, counted; time and drift, measured."""
    request.nothing_but(paper)
    numbers: dict[str, dict[str, Spread]] = {}
    for name, (storage, compose, sizes) in COMPOSE.items():
        tally = counted(compose, sizes)
        row = {
            "storage": storage,
            "operations": tally["multiplications"] + tally["additions"],
            **{kind: tally[kind] for kind in ("multiplications", "trigonometric", "square_roots")},
        }
        numbers[name] = {figure: spread([value]) for figure, value in row.items()}
    for name in ("dual quaternion", "4 x 4 matrix", "3 x 4 matrix"):
        numbers[name]["arm_operations"] = spread([arm_operations(name)])
    for name, seconds in measured_seconds().items():
        numbers[name]["seconds"] = seconds
    for name, drift in drifts().items():
        numbers[name]["drift"] = spread([drift])
    return MeasureResult(
        numbers, f"counted on written-out products; measured on numpy {np.__version__}"
    )

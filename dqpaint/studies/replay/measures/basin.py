"""Many postures -> where the transpose law, without limits, has them end: a claim of stability."""

import numpy as np

from dqpaint.controllers.base import difference_error
from dqpaint.dq import Floats
from dqpaint.language import read
from dqpaint.motion import plan
from dqpaint.robots.kinematics import Kinematics, ManyKinematics, pose_map
from dqpaint.robots.model import Mount, read_card
from dqpaint.studies.experiment.statistics import spread
from dqpaint.studies.replay.measure import MEASURES, MeasureRequest, MeasureResult
from dqpaint.studies.replay.measures.setpoint import INITIAL_DEG, ROBOT
from dqpaint.studies.replay.papers import Paper, find_paper_drawing
from dqpaint.studies.report.charts import HeatMap
from dqpaint.studies.report.page import Map

GAIN, STEP, SECONDS = 60.0, 0.02, 200.0  # of the transpose, [1/s], [s]
ARRIVED = 1e-3  # of the norm of the eight errors
AT_REST = 1e-6  # of |J8' e|: nothing moves any more
STARTS = 200  # at random, all angles alike
AROUND = np.arange(-180.0, 180.0, 20.0)  # [deg] that joints 1 and 2 of a map begin apart


@MEASURES.add("basin")
def basin(paper: Paper, request: MeasureRequest) -> MeasureResult:
    """Random starts, a map over two joints, and the rank of J8 J8'."""
    request.nothing_but(paper)
    card = read_card(ROBOT).model_copy(update={"tool": Mount()})
    kinematics = Kinematics(card)
    goal = plan(read(find_paper_drawing(paper.drawing)), card.canvas.pose).pose[0]
    many = ManyKinematics(kinematics)
    rng = np.random.default_rng(0)
    starts = rng.uniform(-np.pi, np.pi, (STARTS, card.joints))
    error, pull = go(many, starts, goal)
    q = np.radians(INITIAL_DEG) + np.zeros((len(AROUND) ** 2, card.joints))
    first, second = np.meshgrid(np.radians(AROUND), np.radians(AROUND))
    q[:, 0], q[:, 1] = q[:, 0] + first.ravel(), q[:, 1] + second.ravel()
    over, _ = go(many, q, goal)
    stuck = error > ARRIVED
    numbers = {
        "transpose": {
            "arrived": spread([float((~stuck).mean())]),
            "left_over": spread([float(error.max())]),
            "rank": spread([float(ranks(many, starts).max())]),
            "at_rest": spread([float((stuck & (pull < AT_REST)).mean())]),
        }
    }
    square = over.reshape(len(AROUND), len(AROUND))
    names = [f"{angle:.0f}" for angle in AROUND]
    given = HeatMap(f"error left after {SECONDS:g} s", "joint 1 from the printed start [deg]",
                    "joint 2 [deg]", names, names, np.log10(np.maximum(square, 1e-12)),
                    square > ARRIVED)  # fmt: skip
    title = "log10 of the error that is left, hatched where it has not arrived"
    ours = f"{ROBOT} without limits, k = {GAIN:g} 1/s, {SECONDS:g} s, {STARTS} random postures"
    return MeasureResult(numbers, ours, shown={"-basin": Map(title, given)})


def go(many: ManyKinematics, postures: Floats, goal: Floats) -> tuple[Floats, Floats]:
    """The errors |x_d - x| (B,) that the transpose law leaves, and its rates |J8' e| (B,) there."""
    q = postures.copy()
    for _ in range(round(SECONDS / STEP)):
        error, pull = law(many, q, goal)
        q += STEP * GAIN * pull
    return np.linalg.norm(error, axis=1), np.linalg.norm(pull, axis=1)


def law(many: ManyKinematics, q: Floats, goal: Floats) -> tuple[Floats, Floats]:
    """The errors e (B, 8) and J8' e (B, n) at postures (B, n), of the sign that is nearer."""
    x, J = many.pose_and_jacobian(q)
    error = difference_error(x, np.broadcast_to(goal, x.shape))
    return error, np.vecmat(np.vecmat(error, pose_map(x)), J)


def ranks(many: ManyKinematics, q: Floats) -> Floats:
    """The ranks (B,) of J8 J8' at postures (B, n)."""
    x, J = many.pose_and_jacobian(q)
    J8 = pose_map(x) @ J
    return np.asarray(np.linalg.matrix_rank(J8 @ J8.mT, tol=1e-10), dtype=np.float64)

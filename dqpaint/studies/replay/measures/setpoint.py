"""Pham's two poses -> our arm's pose at the printed angles, and its step response between them."""

from collections.abc import Mapping

import numpy as np

from dqpaint import dq
from dqpaint.controllers import find_controller
from dqpaint.controllers.base import difference_error, spatial_error
from dqpaint.dq import Floats
from dqpaint.language import read
from dqpaint.metrics import judge, limits_text
from dqpaint.motion import Motion, plan
from dqpaint.plants import PLANTS
from dqpaint.robots.kinematics import Kinematics
from dqpaint.robots.model import Mount, read_card
from dqpaint.simulation import Track, track
from dqpaint.studies.experiment.statistics import Spread, spread
from dqpaint.studies.replay.claims import published
from dqpaint.studies.replay.measure import MEASURES, MeasureRequest, MeasureResult
from dqpaint.studies.replay.papers import Paper, find_paper_drawing
from dqpaint.studies.report.charts import COLOURS, Line, Panel
from dqpaint.studies.report.page import Charts

ROBOT = "viper850"
INITIAL_DEG = (20.0, -110.0, 190.0, 25.0, 45.0, 20.0)
POSE = ("w", "x", "y", "z", "w_dual", "x_dual", "y_dual", "z_dual")
PLACE = ("x_m", "y_m", "z_m")
MORE = ("#7a9a01", "#d98cb3")  # colours, for eight lines
SETTLED = 0.02  # of the step


@MEASURES.add("setpoint")
def setpoint(paper: Paper, request: MeasureRequest) -> MeasureResult:
    """Both poses, and the way between them by each law."""
    request.nothing_but(paper)
    card = read_card(ROBOT).model_copy(
        update={"tool": Mount()}
    )  # the paper's poses are its flange's
    kinematics = Kinematics(card)
    motion = plan(read(find_paper_drawing(paper.drawing)), card.canvas.pose)
    start = np.radians(INITIAL_DEG)
    first, last = kinematics.pose(start), motion.pose[0]
    theirs = published(paper)
    numbers = {
        name: {k: spread([v]) for k, v in pose_numbers(x, theirs[name]).items()}
        for name, x in (("initial pose", first), ("desired pose", last))
    }
    numbers["the way between"] = {
        "turn_deg": spread([float(np.degrees(rotation_angle(first, last)))])
    }
    runs = {}
    for cell in paper.cells:
        if "controller" in cell.settings:
            law = find_controller(cell.settings["controller"])
            gains = law.read_gains(cell.settings["gains"])
            run = track(motion, kinematics, start, PLANTS["ideal"], law, gains)
            runs[cell.name] = run
            if judge(run).is_result:
                numbers[cell.name] = {k: spread([v]) for k, v in response(run).items()}
    lost = {name: judge(run).why or limits_text(run)
            for name, run in runs.items() if run.clamps or not judge(run).is_result}  # fmt: skip
    ours = f"{ROBOT}, plant ideal, from the printed angles, {motion.period * 1e3:g} ms"
    shown = {"-response": response_of(runs, motion), "-path": path_of(runs, motion)}
    return MeasureResult(numbers, ours, lost, shown)


def pose_numbers(x: Floats, printed: Mapping[str, Spread]) -> dict[str, float]:
    """The eight numbers of a pose (8,), with the sign of the printed ones, and its place [m]."""
    x = dq.nearest(x, np.array([printed[name].mean for name in POSE]))
    return dict(zip((*POSE, *PLACE), [*x.tolist(), *dq.translation(x).tolist()], strict=True))


def rotation_angle(x: Floats, y: Floats) -> float:
    """The angle [rad] between the orientations of two poses (8,)."""
    return 2 * float(np.linalg.norm(dq.log(spatial_error(x, y))[:3]))


def response(run: Track) -> dict[str, float]:
    """Times [s] until errors stay within 2 % of the step, what is left at the end, the path."""
    errors = np.abs(difference_error(run.pose, run.motion.pose))
    all_eight = settling(run.motion.t, errors.max(axis=1))
    angle = settling(run.motion.t, angles(run))
    return {
        "settling_s": all_eight,
        "turn_settling_s": angle,
        "unevenness": all_eight / angle,
        "left_over": float(errors[-1].max()),
        "path_y_m": float(run.points[:, 1].max()),
        "end_angle_deg": float(np.degrees(turns(run.pose)[-1])),
    }


def angles(run: Track) -> Floats:
    """The angle (N,) [rad] to the desired orientation."""
    turned = dq.log(spatial_error(run.pose, run.motion.pose))[:, :3]
    return np.asarray(2 * np.linalg.norm(turned, axis=1))


def turns(pose: Floats) -> Floats:
    """The angles (N,) [rad] of poses (N, 8) from the base's axes, as Fig. 7b shows them."""
    return np.asarray(2 * np.arccos(np.clip(np.abs(pose[:, 0]), 0.0, 1.0)))


def settling(t: Floats, error: Floats) -> float:
    """The time [s] from which an error (N,) stays within 2 % of its first value; nan if never."""
    outside = np.flatnonzero(error > SETTLED * error[0])
    after = int(outside[-1]) + 1 if len(outside) else 0
    return float(t[after]) if after < len(t) else float("nan")


def path_of(runs: dict[str, Track], motion: Motion) -> Charts:
    """As Figs. 6 and 7: the path from above and from the side, places and angle over time."""
    drawn = {name: run.points for name, run in runs.items()}
    sides = [
        Panel(f"the path, {seen}", "x [m]", f"{axis} [m]",
              [Line(p[:, 0], p[:, column], name) for name, p in drawn.items()])
        for seen, axis, column in (("from above", "y", 1), ("from the side", "z", 2))
    ]  # fmt: skip
    places = [
        Panel(f"{axis} of the tool", "time [s]", f"{axis} [m]",
              [Line(motion.t, p[:, column], name) for name, p in drawn.items()],
              bound=float(motion.points[-1, column]), limit="desired")
        for column, axis in enumerate("xyz")
    ]  # fmt: skip
    angle = [Line(motion.t, np.degrees(turns(run.pose)), name) for name, run in runs.items()]
    goal = float(np.degrees(turns(motion.pose)[-1]))
    last = Panel("angle of the tool from the base", "time [s]", "angle [deg]", angle,
                 bound=goal, limit="desired")  # fmt: skip
    title = "The path, and place and angle over time, as Figs. 6 and 7"
    return Charts(title, [*sides, *places, last], shared=True)


def response_of(runs: dict[str, Track], motion: Motion) -> Charts:
    """As Figs. 5 and 9: the eight numbers by the first law, and the angle to go by all."""
    name, run = next(iter(runs.items()))
    eight = [
        Line(motion.t, run.pose[:, i], POSE[i].replace("_dual", "'"), [*COLOURS, *MORE][i])
        for i in range(8)
    ]
    to_go = [Line(motion.t, np.degrees(angles(one)), name) for name, one in runs.items()]
    panels = [
        Panel(f"the pose, {name}", "time [s]", "w x y z, and w' x' y' z' [m]", eight),
        Panel("angle to the desired pose", "time [s]", "angle [deg]", to_go),
    ]
    return Charts("The way to the other pose", panels)

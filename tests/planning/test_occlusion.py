"""What a forecast says of shapes and singularities against the run it speaks of."""

from functools import cache

import numpy as np
import pytest

from dqpaint import dq
from dqpaint.controllers import CONTROLLERS
from dqpaint.language import parse
from dqpaint.light.camera.views import parse_views
from dqpaint.light.sources.from_motion import view_camera
from dqpaint.motion import plan
from dqpaint.planning.forecast import forecast
from dqpaint.planning.forecast_report import MOST_OCCLUDED
from dqpaint.planning.occlusion import forecast_occlusion, sampled_rows
from dqpaint.planning.reachability import reachable_start_posture
from dqpaint.plants import PLANTS
from dqpaint.plants.engines.pybullet_client import bullet, joint_indices, quiet
from dqpaint.render.scene_arm import SceneArm
from dqpaint.robots.kinematics.collisions import collision_shapes
from dqpaint.robots.kinematics.differential_ik import CHARACTERISTIC_LENGTH, DAMPING_THRESHOLD
from dqpaint.robots.kinematics.kinematics import Kinematics
from dqpaint.robots.model.card import read_card
from dqpaint.robots.urdf.prepare import urdf_file
from dqpaint.settings.model import make_settings
from dqpaint.simulation.closed_loop import track
from tests.support.forecasts import lifted
from tests.support.installed import needs_pybullet_data

ARMS = ("iiwa", "panda", "xarm6", "meka-a2", "viper850")
SEEDS = (1, 8, 9, 16, 17, 20, 22, 33, 39, 50)  # of drawings that their arms can draw, two each
AROUND = np.array([0, 0.3, 0])  # [m] to either side of the canvas
SINGULAR, APART = 0.004, 3e-3  # [rad/rad], [m]: PyBullet's hulls stand proud by a millimetre each
SHARE = 0.06  # of a line's light: looked at now and then, traced at each step


def wild(seed):
    """Three lines near the base or far out, the tool turned far: shapes come into play."""
    rng = np.random.default_rng([11, seed])
    name = ARMS[seed % len(ARMS)]
    canvas = np.array(read_card(name).canvas.at_m)
    x, y, z = canvas * rng.uniform([0.1, 1, 0.3], [1.1, 1, 1.2]) + AROUND * rng.uniform(-1, 1, 3)

    def turned():
        return f"tool rot({rng.choice(list('xyz'))}, {rng.uniform(-120, 120):.0f} deg)"

    text = f'period 8 ms\nrobot "{name}"\nplace at ({x:.3f}, {y:.3f}, {z:.3f}) m turned '
    text += f"rpy(90 deg, 0 deg, 90 deg)\nstart at (0, 0) mm {turned()}\n"
    for _ in range(3):
        x, y, z = rng.uniform(-90, 90, 3)
        text += f"line to ({x:.0f}, {y:.0f}, {z:.0f}) mm in 4 s profile quintic light white"
        text += f" {turned()}\n" if rng.random() < 0.7 else "\n"
    return name, text


@cache
def drawable(seed):
    """The motion, the arm, and where it begins."""
    name, text = wild(seed)
    arm = Kinematics(read_card(name))
    motion = plan(parse(text, "wild.traj"), arm.card.canvas.pose)
    return motion, arm, reachable_start_posture(motion, arm).posture


@cache
def foreseen(seed):
    """What is forecast of it, line by line."""
    return forecast(*drawable(seed))


def clearances(arm, postures):
    """PyBullet's least distances (N,) of the links that the forecast looks at."""
    geometry = collision_shapes(arm)._shapes
    links_of = [shape.parentJoint for shape in geometry.geometryObjects]
    pairs = {(links_of[p.first], links_of[p.second]) for p in geometry.collisionPairs}
    with quiet():
        client = bullet.connect(bullet.DIRECT)
        with urdf_file(arm.card) as path:
            body = bullet.loadURDF(path, useFixedBase=True, physicsClientId=client)
    links = [-1, *joint_indices(body, client)]
    least = []
    for posture in postures:
        for joint, angle in zip(links[1:], posture, strict=True):
            bullet.resetJointState(body, joint, angle, physicsClientId=client)
        bullet.performCollisionDetection(physicsClientId=client)
        found = [
            point[8]
            for i, j in pairs
            for point in bullet.getClosestPoints(
                body, body, 0.3, links[i], links[j], physicsClientId=client
            )
        ]
        least.append(min(found, default=np.inf))
    bullet.disconnect(client)
    return np.array(least)


def traced(arm, run, eye):
    """Whether the picture's own rays reach the light (N,), 0 to 1, at each row of a run."""
    motion, every = run.motion, np.ones(len(run.motion.t), dtype=bool)
    with urdf_file(arm.card) as path:
        staging = SceneArm(path, run.posture, motion.period, motion.source)
        return staging.visible(motion.t, run.points[:, None], every, eye)[:, 0]


def smallest(arm, posture):
    x, J = arm.pose_and_jacobian(posture)
    at_tool = np.concatenate(
        [J[:3], (J[3:] + np.cross(J[:3].T, dq.translation(x)).T) / CHARACTERISTIC_LENGTH]
    )
    return np.linalg.svd(at_tool)[1][-1]


@pytest.mark.slow
@pytest.mark.parametrize("seed", SEEDS)
def test_ten_random_drawings(seed):
    """Of five arms: singularities, self-collisions and hidden light, line by line."""
    motion, arm, start = drawable(seed)
    law = CONTROLLERS["pff"]
    free = Kinematics(lifted(arm.card))
    run = track(motion, free, start, PLANTS["ideal"], law, law.read_gains({}))
    front = dq.matrix_from_quaternion(motion.front)
    eye = view_camera(motion.points[:-1], front, make_settings(), parse_views("front")[0]).position
    seen = traced(arm, run, eye)
    for one in foreseen(seed):
        rows = np.flatnonzero(motion.source.line[:-1] == one.line.line)
        least = min(smallest(arm, q) for q in run.posture[rows])
        assert one.singular_value == pytest.approx(least, abs=SINGULAR)
        assert (one.singular_value < DAMPING_THRESHOLD) == (least < DAMPING_THRESHOLD) or abs(
            least - DAMPING_THRESHOLD
        ) < SINGULAR
        near = clearances(arm, run.posture[rows[::4]]).min()
        # Coal's hulls collide where the meshes do not: then the forecast says 0, PyBullet less
        assert one.clearance == pytest.approx(near, abs=2 * APART) or (
            one.clearance == 0 and near < APART
        )
        assert one.occluded == pytest.approx(1 - seen[rows].mean(), abs=SHARE)


@pytest.mark.slow
def test_the_wild_drawings_are_not_all_alike():
    """Else the comparison would say little."""
    found = [line for seed in SEEDS for line in foreseen(seed)]
    assert any(line.singular_value < 2 * DAMPING_THRESHOLD for line in found)
    assert any(line.clearance < 0 for line in found)
    assert any(MOST_OCCLUDED < line.occluded < 0.9 for line in found)
    assert len([line for line in found if line.occluded == 0]) > 5


BEHIND = (
    "period 20 ms\nstart at (0, 0) mm\n"
    "line to (40, 0) mm in 1 s light red brush bar 300 mm along x\n"
)


@pytest.fixture(scope="module")
def still():
    arm = Kinematics(read_card("iiwa"))
    motion = plan(parse(BEHIND, "t.traj"), arm.card.canvas.pose)
    return motion, arm, reachable_start_posture(motion, arm).posture


def hidden(still, **choices):
    motion, arm, start = still
    return forecast(motion, arm, start, make_settings(**choices))[0]


def test_the_view_decides(still):
    """Seen from behind, the arm stands before its light; of many views the worst is told."""
    assert hidden(still).occluded == 0
    behind = hidden(still, view="180,0", brush="point")
    assert (behind.occluded, behind.view) == (1.0, "az180-el0")
    both = hidden(still, view="front,180,0", brush="point")
    assert (both.occluded, both.view) == (1.0, "az180-el0")


@needs_pybullet_data
def test_the_brush_decides(still):
    """From behind a long bar shows on both sides of the arm; its middle does not."""
    assert 0.1 < hidden(still, view="180,0").occluded < 0.9


class Eyes:
    """Shapes that note from where they are looked at."""

    def __init__(self):
        self.seen = []

    def occludes(self, postures, points, eye):
        self.seen.append(eye)
        return np.zeros(len(points), dtype=bool)


@pytest.mark.parametrize("choices", [
    {}, {"ghost": True}, {"exposure": "0.7m,iso100,85mm"}, {"width": 200, "height": 900},
    {"view": "30,12,stereo", "brush": "point"},
])  # fmt: skip
def test_it_is_looked_at_from_where_the_picture_is_taken(still, choices):
    from dqpaint.painting.picture import camera_of_view
    from dqpaint.painting.scene import make_scene

    motion, _, start = still
    settings, eyes = make_settings(**choices), Eyes()
    rows = np.arange(len(motion.t))
    forecast_occlusion(eyes, motion, rows, np.tile(start, (len(rows), 1)), settings)
    scene = make_scene(motion, motion.pose, settings)
    wanted = [camera_of_view(scene, settings, shot).position for shot in parse_views(settings.view)]
    assert {tuple(eye) for eye in eyes.seen} == {tuple(eye) for eye in wanted}


def test_every_line_is_looked_at():
    line = np.repeat([1, 2, 3, 2], [500, 1, 600, 2])
    rows = sampled_rows(line, 40)
    assert set(line[rows]) == {1, 2, 3}
    assert len(rows) <= 44
    assert len(np.unique(rows)) == len(rows)


def test_a_dark_drawing_hides_nothing(still):
    motion = plan(parse("light off\nline to (10, 0) mm\n", "t"), still[1].card.canvas.pose)
    rows = np.arange(len(motion.t))
    postures = np.tile(still[2], (len(rows), 1))
    found = forecast_occlusion(collision_shapes(still[1]), motion, rows, postures, make_settings())
    assert found.largest_share(rows) == (None, "")

"""Walls: distances and Jacobians beside differences and DQ Robotics; runs stay out of them."""

import numpy as np
import pytest
from scipy.optimize import minimize
from scipy.spatial import ConvexHull

from dqpaint import dq
from dqpaint.controllers import CONTROLLERS
from dqpaint.language import parse
from dqpaint.motion import plan
from dqpaint.plants import PLANTS
from dqpaint.program import Wall, walls
from dqpaint.robots.kinematics import collision_shapes, make_kinematics
from dqpaint.robots.model import read_card
from dqpaint.robots.walls import Walls, distances
from dqpaint.simulation import track
from tests.support.random_poses import random_poses

ARM = make_kinematics(read_card("iiwa"))
SHAPES = {
    "half space": walls.HalfSpace((0.6, 0.0, 0.8), -0.4),
    "room": walls.Room((-0.9, -0.8, -0.7), (0.8, 0.9, 0.7)),
    "box": walls.Block((0.3, 0.2, -0.1), (0.5, 0.6, 0.4)),
    "sphere": walls.Ball((0.4, 0.3, 0.2), 0.05),
    "capsule": walls.Rod((0.5, 0.2, 0.0), (0.4, 0.5, 0.5), 0.04),
    "cylinder": walls.Pillar((0.5, 0.4, 0.0), (0.0, 0.6, 0.8), 0.04),
    "cone": walls.Cone((0.48, 0.6, 0.64), 1.0),
    "apart": walls.Apart(0.02),
}


def wall(shape, holder="arm", base=False, shift=(0.0, 0.0, 0.0), seconds=0.0):
    return Wall(shape, holder, base, shift, seconds, "", None, None)


@pytest.mark.parametrize("holder", ["arm", "tool", "beam"])
@pytest.mark.parametrize("name", SHAPES)
def test_every_gradient_is_that_of_central_differences(name, holder, rng):
    """From general postures, in a general frame, of a wall that moves; each row by itself."""
    frame = random_poses(rng, 1)[0]
    frame = dq.pose_from(0.2 * rng.normal(size=3), dq.rotation(frame))
    scene = Walls(ARM, (wall(SHAPES[name], holder, shift=(0.1, -0.2, 0.3), seconds=2.0),), frame)
    h, worst = 1e-6, 0.0
    for _ in range(4):
        q, way, t = rng.uniform(-1.5, 1.5, 7), rng.normal(size=7), rng.uniform(0.2, 1.5)
        x, J = ARM.pose_and_jacobian(q)
        rows = scene.rows(q, x, J, t)
        ends = [
            scene.rows(q + s * h * way, *ARM.pose_and_jacobian(q + s * h * way), t + s * h).distance
            for s in (1, -1)
        ]
        found = (ends[0] - ends[1]) / (2 * h)
        worst = max(worst, np.abs(rows.gradient @ way + rows.drift - found).max())
    assert worst < 1e-8, worst


def test_distances_are_those_of_dq_robotics(rng):
    """Values and Jacobians, squared where it has them so: 2 d times ours."""
    dqrobotics = pytest.importorskip("dqrobotics")
    from dqrobotics.robot_modeling import DQ_Kinematics
    from dqrobotics.utils import DQ_Geometry

    q = rng.uniform(-1.2, 1.2, 7)
    x, J = ARM.pose_and_jacobian(q)
    pose = dqrobotics.DQ(list(x))
    J8 = np.concatenate([_half_product(x, J)])
    Jt, Jr = DQ_Kinematics.translation_jacobian(J8, pose), DQ_Kinematics.rotation_jacobian(J8)
    t, c = pose.translation(), rng.normal(size=3)
    axis, n = (v / np.linalg.norm(v) for v in rng.normal(size=(2, 3)))
    p = dq.translation(x)[None]
    point = dqrobotics.DQ([0, *c])
    line = dqrobotics.DQ([0, *axis, 0, *np.cross(c, axis)])
    plane = dqrobotics.DQ([0, *n, 0.3, 0, 0, 0])
    ours = {
        "point": distances.from_point(p, p, c),
        "line": distances.from_line(p, p, c, axis),
        "plane": distances.from_half_space(p, p, n, 0.3),
    }
    theirs = {
        "point": (DQ_Geometry.point_to_point_squared_distance(t, point),
                  DQ_Kinematics.point_to_point_distance_jacobian(Jt, t, point)),
        "line": (DQ_Geometry.point_to_line_squared_distance(t, line),
                 DQ_Kinematics.point_to_line_distance_jacobian(Jt, t, line)),
        "plane": (DQ_Geometry.point_to_plane_distance(t, plane),
                  DQ_Kinematics.point_to_plane_distance_jacobian(Jt, t, plane)),
    }  # fmt: skip
    for name, (value, jacobian) in theirs.items():
        d = ours[name].distance[0]
        mine = distances.twist_rows(ours[name])[0] @ J
        known, factor = (d, 1.0) if name == "plane" else (d * d, 2 * d)
        assert known == pytest.approx(value, abs=1e-10), name
        np.testing.assert_allclose(factor * mine, np.ravel(jacobian), atol=1e-8, err_msg=name)
    # the tool's own line against a point and a line of the world
    z = dq.matrix_from_quaternion(dq.rotation(x))[:, 2]
    k = dqrobotics.DQ([0, 0, 0, 1])
    J_line, tool_line = DQ_Kinematics.line_jacobian(J8, pose, k), _line_of(dqrobotics, x, z)
    far = np.array([[-50.0], [50.0]]) * z + p  # a segment so long that it is the line
    one = distances.from_point(far[:1], far[1:], c)
    theirs_row = np.ravel(DQ_Kinematics.line_to_point_distance_jacobian(J_line, tool_line, point))
    np.testing.assert_allclose(
        2 * one.distance[0] * distances.twist_rows(one)[0] @ J, theirs_row, atol=1e-8
    )
    other = distances.from_line(far[:1], far[1:], c, axis)
    theirs_row = np.ravel(DQ_Kinematics.line_to_line_distance_jacobian(J_line, tool_line, line))
    np.testing.assert_allclose(
        2 * other.distance[0] * distances.twist_rows(other)[0] @ J, theirs_row, atol=1e-8
    )
    inside, row = distances.cone_row(z, axis, 1.0)
    theirs_row = np.ravel(DQ_Kinematics.line_to_line_angle_jacobian(
        J_line, tool_line, dqrobotics.DQ([0, *axis])))  # fmt: skip
    np.testing.assert_allclose(-row @ J, theirs_row, atol=1e-8)  # of |l - l_w|^2
    assert inside == pytest.approx(2 * (z @ axis - np.cos(1.0)))
    assert np.abs(Jr).max() > 0


def _half_product(x, J):
    from dqpaint.robots.kinematics import pose_map

    return pose_map(x) @ J


def _line_of(dqrobotics, x, z):
    return dqrobotics.DQ([0, *z, 0, *np.cross(dq.translation(x), z)])


@pytest.mark.slow
def test_nearest_points_are_the_least_of_all(rng):
    """Beside scipy, over the segment and over the shape."""
    a, b = rng.normal(size=(2, 30, 3))
    low, high = np.array([-0.5, -0.3, -0.2]), np.array([0.4, 0.3, 0.6])
    first, last = rng.normal(size=(2, 3))
    hull = ConvexHull(rng.normal(size=(12, 3)) * 0.3)
    found = {
        "box": distances.from_box(a, b, low, high),
        "segment": distances.from_segments(a, b, first, last)[0],
        "hull": distances.from_hull(a, b, hull),
    }
    for i in range(30):
        u = b[i] - a[i]
        box = minimize(lambda s, i=i, u=u: _outside(a[i] + s[0] * u, low, high), [0.5],
                       bounds=[(0, 1)], tol=1e-12)  # fmt: skip
        grid = min(_outside(a[i] + s * u, low, high) for s in np.linspace(0, 1, 2001))
        truth = min(float(box.fun), grid)
        if truth > 1e-9:
            assert found["box"].distance[i] == pytest.approx(np.sqrt(truth), abs=1e-5)
            assert found["box"].distance[i] <= np.sqrt(truth) + 1e-9
        else:
            assert found["box"].distance[i] <= 1e-9
        pair = min(
            np.linalg.norm(a[i] + s * u - first - t * (last - first))
            for s in np.linspace(0, 1, 101) for t in np.linspace(0, 1, 101)
        )  # fmt: skip
        assert pair - 2e-2 < found["segment"].distance[i] <= pair + 1e-9
        signed = min(
            (hull.equations[:, :3] @ (a[i] + s * u) + hull.equations[:, 3]).max()
            for s in np.linspace(0, 1, 5001)
        )
        if signed < -1e-3:  # it goes through: as deep as its deepest point
            assert found["hull"].distance[i] == pytest.approx(signed, abs=5e-3)
        elif signed > 1e-3:
            assert found["hull"].distance[i] >= signed - 2e-4


def _outside(p, low, high):
    return float(((p - np.clip(p, low, high)) ** 2).sum())


def test_a_box_as_a_hull_is_the_box(rng):
    low, high = np.array([-0.5, -0.3, -0.2]), np.array([0.4, 0.3, 0.6])
    corners = np.array([[x, y, z] for x in (low[0], high[0]) for y in (low[1], high[1])
                        for z in (low[2], high[2])])  # fmt: skip
    a, b = 0.8 * rng.normal(size=(2, 60, 3))
    box, hull = distances.from_box(a, b, low, high), distances.from_hull(a, b, ConvexHull(corners))
    np.testing.assert_allclose(hull.distance, box.distance, atol=1e-5)
    assert (box.distance < -0.01).any()
    assert (box.distance > 0.01).any()


@pytest.mark.parametrize("robot", ["iiwa", "viper850", "panda"])
def test_capsules_hold_all_of_their_links(robot, rng):
    """Of meshes, cylinders, boxes and balls: no point of a shape is outside."""
    import coal

    arm = make_kinematics(read_card(robot))
    shapes = collision_shapes(arm)
    by_joint = {one.joint: one for one in shapes.capsules()}
    for shape in shapes._shapes.geometryObjects:
        one = by_joint[shape.parentJoint]
        way = one.end - one.start
        ball = coal.Capsule(one.radius + 1e-6, float(np.linalg.norm(way)))
        points = _surface(shape.geometry, rng) @ shape.placement.rotation.T
        points = points + shape.placement.translation
        part = np.clip((points - one.start) @ way / max(way @ way, 1e-12), 0, 1)
        off = np.linalg.norm(points - one.start - part[:, None] * way, axis=1)
        assert off.max() <= one.radius + 1e-6, (one.name, off.max(), one.radius, ball.radius)
        assert off.max() > 0.5 * one.radius or len(by_joint) < len(shapes._shapes.geometryObjects)


def _surface(solid, rng):
    import coal

    way = rng.normal(size=(400, 3))
    way /= np.linalg.norm(way, axis=1)[:, None]
    if isinstance(solid, coal.Cylinder):
        turn = rng.uniform(0, 2 * np.pi, 200)
        ring = solid.radius * np.stack([np.cos(turn), np.sin(turn)], 1)
        return np.column_stack([ring, solid.halfLength * rng.choice([-1, 1], 200)])
    if isinstance(solid, coal.Sphere):
        return solid.radius * way
    if isinstance(solid, coal.Box):
        return solid.halfSide * np.sign(way)
    if isinstance(solid, coal.Capsule):
        return np.array([[0, 0, s * (solid.halfLength + solid.radius)] for s in (1, -1)])
    return np.array(solid.points())


HEAD = "period 8 ms\nstart at (0, 0) mm\n"
BOXED = "line to (60, 60) mm to (60, -60) mm to (-60, -60) mm to (-60, 60) mm speed 80 mm/s\n"


def run(text, plant="ideal", resolver="qp", law="hinf", arm=ARM):
    motion = plan(parse(HEAD + text), arm.card.canvas.pose)
    chosen = CONTROLLERS[law]
    how = (PLANTS[plant], chosen, chosen.read_gains({}))
    return track(motion, arm, arm.card.home, *how, resolver=resolver)


def test_a_wall_is_approached_as_the_theory_has_it():
    """Asked to go straight through, the distance decays by 1 - eta T a step; above 1 it passes."""
    text = "wall above x = 40 mm for tool\nstep to (80, 0) mm\nhold 0.5 s\n"
    for eta in (12.5, 62.5):
        d = run(text, resolver=f"qp,eta={eta}").walls.distance[:, 0]
        near = (d < 0.02) & (d > 1e-4)
        ratio = d[1:][near[:-1]] / d[:-1][near[:-1]]
        np.testing.assert_allclose(ratio[1:], 1 - eta * 0.008, atol=0.02)
        assert d.min() > -1e-6
    assert run(text, resolver="qp,eta=125").walls.distance.min() > -1e-6
    passed = run(text, resolver="qp,eta=187.5,force=yes").walls.distance[:, 0]
    assert passed.min() < -1e-5


def test_without_the_program_it_goes_through_and_is_told():
    text = "wall above x = 40 mm for tool\n" + BOXED
    through = run(text, resolver="filter").walls
    assert through.distance.min() == pytest.approx(-0.02, abs=1e-3)
    assert not through.active.any()
    held = run(text).walls
    assert held.distance.min() > -1e-6
    assert held.active.any()
    assert held.lost.max() > 0.01


def test_where_nothing_is_near_it_is_the_same_run():
    free = run(BOXED, resolver="filter")
    held = run("wall below y = -300 mm for tool\n" + BOXED)
    np.testing.assert_allclose(held.posture, free.posture, atol=1e-9)


def test_an_arm_that_begins_inside_comes_out():
    text = "wall above x = -20 mm for tool\nhold 1 s\n"
    d = run(text).walls.distance[:, 0]
    assert d[0] == pytest.approx(-0.02, abs=1e-3)
    assert d[-1] > -1e-6
    assert (np.diff(d) > -1e-7).all()


def test_a_wall_that_moves_pushes_the_light_before_it():
    text = "wall below x = -30 mm for tool by (80, 0) mm in 2 s\nhold 2.5 s\n"
    found = run(text)
    assert found.walls.distance.min() > -1e-6
    x = (found.points - found.points[0]) @ dq.matrix_from_quaternion(
        dq.rotation(found.motion.canvas)
    )[:, 0]
    assert x[-1] == pytest.approx(0.05, abs=1e-3)


def test_a_cone_holds_the_tool():
    text = "face viewer within 15 deg\nline to (60, 0) mm tool rpy(0 deg, 40 deg, 0 deg) in 2 s\n"
    d = run(text).walls.distance[:, 0]
    assert -1e-5 < d.min() < 1e-3
    assert run(text, resolver="filter").walls.distance.min() < np.radians(-20)


def random_scene(rng, kind):
    """A drawing of a few random lines and a wall that some of them go through."""
    points = rng.uniform(-80, 80, (4, 3)) * [1, 1, 0.5]
    lines = " ".join(f"to ({x:.1f}, {y:.1f}, {z:.1f}) mm" for x, y, z in points)
    u = rng.uniform(0.2, 0.5)
    c = u * points[0] + (1 - u) * points[1]  # on the second line
    at = f"({c[0]:.1f}, {c[1]:.1f}, {c[2]:.1f}) mm"
    wall = {
        "plane": f"wall above x = {max(20.0, u * points[:, 0].max()):.1f} mm for tool",
        "sphere": f"keep away from sphere at {at} radius 15 mm for tool",
        "box": "keep away from box "
        f"({c[0] - 12:.1f}, {c[1] - 15:.1f}, {c[2] - 20:.1f}) mm to "
        f"({c[0] + 14:.1f}, {c[1] + 11:.1f}, {c[2] + 16:.1f}) mm for tool",
        "elbow": "wall below x = -180 mm",
        "links": "keep links apart 33 mm",
    }[kind]
    return f"{wall}\nline {lines} speed 80 mm/s\n"


@pytest.mark.slow
@pytest.mark.parametrize("plant", ["ideal", "stiff"])
@pytest.mark.parametrize("kind", ["plane", "sphere", "box", "elbow", "links"])
def test_random_drawings_stay_out_of_walls(kind, plant):
    """Two random drawings each: ten with each plant; the bound is 1 um, 0.1 mm on `stiff`."""
    for seed in range(2):
        rng = np.random.default_rng([seed, 7])
        text = random_scene(rng, kind)
        eta = 12.5 if seed else 125.0
        d = run(text, plant, f"qp,eta={eta}").walls.distance
        assert d[0].min() > 0
        assert d.min() > (-1e-6 if plant == "ideal" else -1e-4), (kind, seed, d.min())

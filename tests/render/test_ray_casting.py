"""Rays against the twins of plain shapes, whose answers are known in closed form."""

import numpy as np
import pytest

from dqpaint import dq
from dqpaint.light.camera.camera import View, frame_points
from dqpaint.render.arm_shapes import Arm
from dqpaint.render.geometry_buffer import measure_surfaces
from dqpaint.render.ray_casting import RayCaster
from dqpaint.robots.model.card import read_card
from dqpaint.robots.urdf.prepare import urdf_file
from tests.support.urdf_shapes import BALL, BOX, urdf

pytestmark = pytest.mark.slow
EDGE = 0.003  # [m] nearer to an outline the answer may be either


def cast(twins, posture, start, end):
    """Whether rays (R, 3) are blocked in a posture."""
    return twins.blocked(posture[None], start[None], end[None])[0]


def through_ball(start, end, centre, radius):
    """How far (R,) inside the ball the nearest point of each way is [m]."""
    way = end - start
    t = np.clip(((centre - start) * way).sum(1) / (way * way).sum(1), 0, 1)
    return radius - np.linalg.norm(start + t[:, None] * way - centre, axis=1)


def through_box(start, end, half):
    """Whether each way meets the box of half sides about the origin: slabs."""
    way = end - start
    a, b = (-half - start) / way, (half - start) / way
    enter, leave = np.minimum(a, b).max(axis=1), np.maximum(a, b).min(axis=1)
    return (enter <= leave) & (leave >= 0) & (enter <= 1)


def many_rays(rng, n, around):
    return around + rng.normal(size=(n, 3)), around + 0.1 * rng.normal(size=(n, 3))


def test_a_ball_on_a_link_blocks_what_goes_through_it(rng, tmp_path):
    arm = Arm(urdf(tmp_path, base="", first="", second=BALL))
    twins = RayCaster(arm)
    for posture in rng.uniform(-1, 1, (4, 2)):
        centre = dq.translation(dq.mul(arm.frames(posture[None])[0, 2], arm.shapes[0].frame))
        start, end = many_rays(rng, 2000, centre)
        deep = through_ball(start, end, centre, 0.06)
        clear = np.abs(deep) > EDGE
        clear &= np.linalg.norm(end - centre, axis=1) > 0.06  # none ends inside
        hit = cast(twins, posture, start, end)
        assert clear.sum() > 500
        assert 0.05 < hit[clear].mean() < 0.95
        np.testing.assert_array_equal(hit[clear], deep[clear] > 0)


def test_a_base_whose_weight_is_elsewhere_blocks_where_it_is_drawn(rng, tmp_path):
    arm = Arm(urdf(tmp_path, base=BOX, first="", second=""))
    twins = RayCaster(arm)
    turn = np.array([np.cos(0.2), 0, 0, np.sin(0.2)])
    start, near = many_rays(rng, 4000, [0, 0, 0.1])
    end = 3 * near - 2 * start  # well outside
    own = [dq.rotate(turn * [1, -1, -1, -1], p - [0, 0, 0.1]) for p in (start, end)]
    half = np.array([0.1, 0.05, 0.15])
    sure = through_box(*own, half + EDGE) == through_box(*own, half - EDGE)
    outside = (np.abs(own[0]) > half + EDGE).any(axis=1)
    hit = cast(twins, np.zeros(2), start, end)
    assert 0.005 < hit[sure & outside].mean() < 0.9
    np.testing.assert_array_equal(hit[sure & outside], through_box(*own, half)[sure & outside])


@pytest.mark.parametrize("name", ["iiwa", "ur5"])
def test_rays_and_the_depth_buffer_agree(name, rng):
    """Of 4,000 places round the arm those hide from rays that lie deeper than what is drawn.

    The UR5's meshes are Collada, whose twins are made of their triangles.
    """
    card = read_card(name)
    if card.missing:
        pytest.skip(f"{name} needs {card.origin}")
    wrong = total = 0
    with urdf_file(card) as path:
        arm = Arm(path)
        twins = RayCaster(arm)
        for view in (View(30, 15), View(-70, 40)):
            place = rng.uniform([-0.4, -0.4, 0], [0.8, 0.4, 1.2], (2000, 3))
            camera = frame_points(place, np.eye(3)[[1, 2, 0]].T, view, (640, 360), 0.9)
            posture = card.home + 0.3 * rng.normal(size=card.joints)
            arm.set_posture(posture)
            found = measure_surfaces(arm, camera)
            pixels, depth = camera.project(place)
            x, y = np.rint(pixels).astype(int).T - np.array([[found.box.left], [found.box.top]])
            height, width = found.sure.shape
            inside = (x >= 0) & (x < width) & (y >= 0) & (y < height)
            drawn = np.full(found.sure.shape, np.inf)
            drawn[found.sure] = found.depth
            hidden = np.zeros(len(place), bool)
            hidden[inside] = drawn[y[inside], x[inside]] < depth[inside]
            hit = cast(twins, posture, place, np.broadcast_to(camera.position, place.shape))
            wrong, total = wrong + (hit != hidden).sum(), total + len(place)
            assert 0.02 < hit.mean() < 0.95
    assert wrong < 0.006 * total  # outlines


def test_rays_of_many_postures_are_those_of_each(rng, tmp_path):
    twins = RayCaster(Arm(urdf(tmp_path)))
    start, end = (ends.reshape(100, 33, 3) for ends in many_rays(rng, 3300, [0, 0, 0.3]))
    postures = rng.uniform(-1, 1, (100, 2))
    whole = twins.blocked(postures, start, end)
    each = [cast(twins, *each) for each in zip(postures, start, end, strict=True)]
    assert 0.05 < whole.mean() < 0.95
    np.testing.assert_array_equal(whole, each)


COLLADA = """<?xml version="1.0"?>
<COLLADA xmlns="http://www.collada.org/2005/11/COLLADASchema" version="1.4.1">
<asset><unit meter="1" name="meter"/><up_axis>Z_UP</up_axis></asset>
<library_geometries><geometry id="g"><mesh>
<source id="p"><float_array id="a" count="12">{corners}</float_array><technique_common>
<accessor source="#a" count="4" stride="3"><param name="X" type="float"/>
<param name="Y" type="float"/><param name="Z" type="float"/></accessor></technique_common></source>
<vertices id="v"><input semantic="POSITION" source="#p"/></vertices>
<triangles count="4"><input semantic="VERTEX" source="#v" offset="0"/>
<p>0 2 1 0 1 3 1 2 3 2 0 3</p></triangles></mesh></geometry></library_geometries>
<library_visual_scenes><visual_scene id="s"><node><instance_geometry url="#g"/></node>
</visual_scene></library_visual_scenes><scene><instance_visual_scene url="#s"/></scene></COLLADA>
"""
CORNERS = np.array([[0.02, -0.05, 0.0], [0.12, 0.0, 0.02], [0.0, 0.1, 0.01], [0.03, 0.02, 0.15]])


def test_a_collada_mesh_blocks_where_its_triangles_are(rng, tmp_path):
    """A tetrahedron, scaled: a way meets it where it crosses one of its four faces."""
    text = COLLADA.format(corners=" ".join(str(x) for x in CORNERS.ravel()))
    (tmp_path / "a.dae").write_text(text)
    mesh = '<visual><geometry><mesh filename="a.dae" scale="2 1.5 1"/></geometry></visual>'
    arm = Arm(urdf(tmp_path, base="", first="", second=mesh))
    twins = RayCaster(arm)
    assert not twins.unread
    frame_of = dq.mul(arm.frames(np.array([[0.4, -0.7]]))[0, 2], arm.shapes[0].frame)
    corners = dq.rotate(dq.rotation(frame_of), CORNERS * [2, 1.5, 1])
    corners = corners + dq.translation(frame_of)
    start, end = many_rays(rng, 3000, corners.mean(axis=0))
    end = 2 * end - start
    met = np.zeros(len(start), dtype=bool)
    for a, b, c in corners[[(0, 2, 1), (0, 1, 3), (1, 2, 3), (2, 0, 3)]]:
        edges = np.stack(np.broadcast_arrays(b - a, c - a, start - end), axis=2)
        u, v, t = np.linalg.solve(edges, (start - a)[..., None])[..., 0].T
        met |= (u >= 0) & (v >= 0) & (u + v <= 1) & (t >= 0) & (t <= 1)
    hit = cast(twins, np.array([0.4, -0.7]), start, end)
    assert 0.02 < met.mean() < 0.9
    assert (hit != met).mean() < 0.003  # rays in an edge

"""Walls of a drawing -> visual bodies beside the arm, for pictures that show it.

Obstacles are shown where they are at the end of the run, when the arm is flashed; a plane as a thin
sheet, an endless cylinder as a long one. What would hide the picture is not shown: the sides of a
room, and a plane before or behind the drawing. Light shines through walls.
"""

from typing import Any

import numpy as np

from dqpaint import dq
from dqpaint.dq import Floats
from dqpaint.program import Wall, walls
from dqpaint.render.arm_shapes import WHITE
from dqpaint.robots.bullet import bullet

SHEET, THIN = 0.3, 0.001  # [m] width of a sheet that stands for a plane, and how thick it is
MOST_FACING = 0.5  # |cosine| to the viewer's direction, above which a sheet is not shown
LONG = 2.0  # [m] of a cylinder without ends


def add_walls(client: int, given: tuple[Wall, ...], frame: Floats, middle: Floats) -> None:
    """Add the walls of a drawing to a world of PyBullet.

    Args:
        client: the world.
        given: the walls.
        frame: pose (8,) of the drawing in the base frame.
        middle: of the drawing (3,) [m], in the base frame: a sheet lies beneath it.
    """
    for wall in given:
        place = dq.IDENTITY if wall.base else frame
        back = dq.rotation(dq.conj(place))  # to the wall's frame
        local = dq.rotate(back, middle - dq.translation(place))
        viewer = dq.rotate(back, dq.rotate(dq.rotation(frame), np.array([0.0, 0.0, 1.0])))
        shape = _shape(wall.shape, local, viewer)
        if shape is None:
            continue
        how, at, turn = shape
        end = dq.mul(place, dq.pose_from(np.array(at) + np.array(wall.shift), turn))
        w, x, y, z = dq.rotation(end).tolist()
        visual = bullet.createVisualShape(**how, rgbaColor=WHITE, physicsClientId=client)
        bullet.createMultiBody(
            0, -1, visual, dq.translation(end).tolist(), [x, y, z, w], physicsClientId=client
        )


Body = tuple[dict[str, Any], Floats, Floats]
UPRIGHT = np.array([1.0, 0.0, 0.0, 0.0])


def _shape(shape: walls.WallShape, middle: Floats, viewer: Floats) -> Body | None:
    """PyBullet's arguments of a shape, its position (3,) and orientation (4,) in its own frame."""
    match shape:
        case walls.HalfSpace(normal, offset):
            n = np.array(normal)
            if abs(n @ viewer) > MOST_FACING:
                return None
            foot = middle + (offset - THIN - n @ middle) * n
            half = [0.5 * SHEET, 0.5 * SHEET, THIN]
            return _of(bullet.GEOM_BOX, halfExtents=half), foot, _from_z(n)
        case walls.Block(low, high):
            ends = np.array([low, high])
            half = (0.5 * (ends[1] - ends[0])).tolist()
            return _of(bullet.GEOM_BOX, halfExtents=half), ends.mean(axis=0), UPRIGHT
        case walls.Ball(centre, radius):
            return _of(bullet.GEOM_SPHERE, radius=radius), np.array(centre), UPRIGHT
        case walls.Rod(first, last, radius):
            way = np.subtract(last, first)
            long = float(np.linalg.norm(way))
            turn = _from_z(way / long) if long else UPRIGHT
            how = _of(bullet.GEOM_CAPSULE, radius=radius, length=long)
            return how, 0.5 * np.add(first, last), turn
        case walls.Pillar(point, axis, radius):
            how = _of(bullet.GEOM_CYLINDER, radius=radius, length=LONG)
            return how, np.array(point), _from_z(np.array(axis))
        case walls.Hull(file, at, scale):
            how = _of(bullet.GEOM_MESH, fileName=str(file), meshScale=[scale] * 3)
            return how, np.array(at), UPRIGHT
    return None


def _of(kind: int, **size: Any) -> dict[str, Any]:
    return {"shapeType": kind, **size}


def _from_z(axis: Floats) -> Floats:
    """The shortest turn (4,) from z to a unit vector."""
    if axis[2] < -1 + 1e-9:
        return np.array([0.0, 1.0, 0.0, 0.0])
    turn = np.append(1.0 + axis[2], np.cross([0.0, 0.0, 1.0], axis))
    return np.asarray(turn / np.linalg.norm(turn))

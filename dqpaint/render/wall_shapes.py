"""Walls of a drawing -> visual bodies beside the arm, for pictures that show it.

Obstacles are shown where they are at the end of the run, when the arm is flashed; a plane as a thin
sheet, an endless cylinder as a long one. What would hide the picture is not shown: the sides of a
room, and a plane before or behind the drawing. Light shines through walls.
"""

from collections.abc import Iterator

import numpy as np

from dqpaint import dq
from dqpaint.dq import Floats
from dqpaint.program import Wall, walls
from dqpaint.render.meshes import Triangles, box_mesh, read_mesh_file, round_mesh

SHEET, THIN = 0.3, 0.001  # [m] width of a sheet that stands for a plane, and how thick it is
MOST_FACING = 0.5  # |cosine| to the viewer's direction, above which a sheet is not shown
LONG = 2.0  # [m] of a cylinder without ends


Body = tuple[Triangles, Floats, Floats]
UPRIGHT = np.array([1.0, 0.0, 0.0, 0.0])


def wall_surfaces(
    given: tuple[Wall, ...], frame: Floats, middle: Floats
) -> Iterator[tuple[Floats, Triangles]]:
    """The pose (8,) in the base frame and the surface of each wall that is shown.

    Args:
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
        if shape is not None:
            surface, at, turn = shape
            pose = dq.pose_from(np.array(at) + np.array(wall.shift), turn)
            yield dq.mul(place, pose), surface


def _shape(shape: walls.WallShape, middle: Floats, viewer: Floats) -> Body | None:
    """The surface of a shape, its position (3,) and orientation (4,) in its own frame."""
    match shape:
        case walls.HalfSpace(normal, offset):
            n = np.array(normal)
            if abs(n @ viewer) > MOST_FACING:
                return None
            foot = middle + (offset - THIN - n @ middle) * n
            return box_mesh((SHEET, SHEET, 2 * THIN)), foot, _from_z(n)
        case walls.Block(low, high):
            ends = np.array([low, high])
            return box_mesh(ends[1] - ends[0]), ends.mean(axis=0), UPRIGHT
        case walls.Ball(centre, radius):
            return round_mesh("sphere", radius), np.array(centre), UPRIGHT
        case walls.Rod(first, last, radius):
            way = np.subtract(last, first)
            long = float(np.linalg.norm(way))
            turn = _from_z(way / long) if long else UPRIGHT
            how = round_mesh("capsule", radius, long)
            return how, 0.5 * np.add(first, last), turn
        case walls.Pillar(point, axis, radius):
            how = round_mesh("cylinder", radius, LONG)
            return how, np.array(point), _from_z(np.array(axis))
        case walls.Hull(file, at, scale):
            how = read_mesh_file(str(file), [scale] * 3)
            return how, np.array(at), UPRIGHT
    return None


def _from_z(axis: Floats) -> Floats:
    """The shortest turn (4,) from z to a unit vector."""
    if axis[2] < -1 + 1e-9:
        return np.array([0.0, 1.0, 0.0, 0.0])
    turn = np.append(1.0 + axis[2], np.cross([0.0, 0.0, 1.0], axis))
    return np.asarray(turn / np.linalg.norm(turn))

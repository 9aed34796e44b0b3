"""An arm and a camera -> position, normal and link for each pixel.

PyBullet's software renderer is used for measurements, not for a picture. Painted white and lit
from one side only, with neither ambient light nor gloss, a surface is as bright as its normal
leans to that side; four sides of the camera give two components of the normal, and that it faces
the camera gives the third. It needs no display, and its pictures are the same on every run.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any, NamedTuple

import cv2
import numpy as np
from numpy.typing import NDArray

from dqpaint.dq import Floats
from dqpaint.light.camera import Camera
from dqpaint.render.arm_shapes import Arm
from dqpaint.robots.bullet import bullet

NEAR_PLANE, FAR_PLANE = 0.02, 50.0
"""Nothing nearer or farther than this is visible [m]."""
SEARCH_COLUMNS = 240
"""Columns of the coarse picture in which the arm is located."""
SEARCH_MARGIN = 2
"""Columns of that picture by which the location can be wrong."""
CREASE_START, CREASE_FULL = float(np.cos(np.radians(14.0))), float(np.cos(np.radians(28.0)))
"""Cosines of the angle between smooth and flat normals at which an edge begins to count, and counts
in full."""
SUBPIXEL_SHIFTS = ((-0.125, -0.375), (0.125, 0.375), (0.375, -0.125), (-0.375, 0.125))
"""Shifts of the four renderings within a pixel, right and down of its centre: a rotated square, for
smooth outlines [px]."""
NORMAL_BLUR = (5, 5)
"""Pixels over which a quick rendering averages normals, to hide facets."""
LINK_BITS = 24
"""In the segmentation, the body number is below these bits, the link number plus one above."""

Numbers = NDArray[np.float32]


class Box(NamedTuple):
    """A region of a picture: columns left to right - 1, rows top to bottom - 1."""

    left: int
    top: int
    right: int
    bottom: int

    def crop(self, image: NDArray[Any]) -> NDArray[Any]:
        """This region of a picture (H, W, ...), as a writable view."""
        return image[self.top : self.bottom, self.left : self.right]


@dataclass(frozen=True, eq=False)
class Surfaces:
    """The P visible points of an arm's surface.

    Attributes:
        box: the region of the picture that was rendered.
        cover: (h, w) share of each pixel that the arm covers, in quarters.
        sure: (h, w) which pixels show one link all over; P of them are True, in rows.
        depth: (P,) along the camera's axis [m].
        position: (P, 3) base frame [m].
        normal: (P, 3) unit, towards the outside.
        link: (P,) numbers of links; -1 is the base.
    """

    box: Box
    cover: Numbers
    sure: NDArray[np.bool_]
    depth: Numbers
    position: Numbers
    normal: Numbers
    link: NDArray[np.int64]


def measure_surfaces(arm: Arm, camera: Camera) -> Surfaces | None:
    """The visible surfaces of a white arm; None if it is not in the picture.

    Args:
        arm: in its posture.
        camera: that of the picture.
    """
    box = _find_arm(arm, camera)
    if box is None:
        return None
    right, up, _ = camera.rotation
    lights = (right, -right, up, -up)
    sides = [
        _render_box(arm, camera, box, 1.0, tuple(light), shift)
        for light, shift in zip(lights, SUBPIXEL_SHIFTS, strict=True)
    ]
    link = sides[0].segment
    hits = np.stack([side.segment >= 0 for side in sides])
    sure = np.asarray(hits.all(axis=0))
    for side in sides[1:]:
        sure &= side.segment == link
    if not sure.any():
        return None
    bright = [side.white[..., 0][sure].astype(np.float32) / np.float32(255.0) for side in sides]
    across, above = bright[0] - bright[1], bright[2] - bright[3]
    lean = np.sqrt(np.maximum(across**2 + above**2, 1.0))
    across, above = across / lean, above / lean
    smooth = np.stack([across, above, np.sqrt(np.maximum(1.0 - across**2 - above**2, 0.0))], axis=1)
    depth = _depth(np.mean([side.depth for side in sides], axis=0, dtype=np.float32))
    normal = _creased(smooth, _facet_normals(camera, box, depth)[sure])
    return Surfaces(
        box,
        hits.mean(axis=0, dtype=np.float32),
        sure,
        depth[sure],
        _positions(camera, box, sure, depth[sure]),
        _rotated(normal, camera.rotation.astype(np.float32)),
        (link[sure].astype(np.int64) >> LINK_BITS) - 1,
    )


def quick_surfaces(arm: Arm, camera: Camera, shift: tuple[float, float]) -> Surfaces | None:
    """As `measure_surfaces`, from one rendering instead of four, with hard outlines.

    Args:
        arm: in its posture.
        camera: that of the picture.
        shift: where in a pixel to look, right and down of its middle [px].
    """
    whole = Box(0, 0, camera.width, camera.height)
    side = _render_box(arm, camera, whole, 1.0, (0.0, 0.0, 1.0), shift)
    seen = side.segment >= 0
    if not seen.any():
        return None
    rows, columns = np.flatnonzero(seen.any(axis=1)), np.flatnonzero(seen.any(axis=0))
    box = Box(int(columns[0]), int(rows[0]), int(columns[-1]) + 1, int(rows[-1]) + 1)
    sure, depth = box.crop(seen), _depth(box.crop(side.depth))
    flat = np.where(sure[..., None], _facet_normals(camera, box, depth), np.float32(0.0))
    normal = np.asarray(cv2.blur(flat, NORMAL_BLUR, borderType=cv2.BORDER_CONSTANT), np.float32)[
        sure
    ]
    normal /= np.maximum(np.sqrt((normal * normal).sum(axis=1, keepdims=True)), np.float32(1e-6))
    return Surfaces(
        box,
        sure.astype(np.float32),
        sure,
        depth[sure],
        _positions(camera, box, sure, depth[sure]),
        _rotated(normal, camera.rotation.astype(np.float32)),
        (box.crop(side.segment)[sure].astype(np.int64) >> LINK_BITS) - 1,
    )


def _facet_normals(camera: Camera, box: Box, depth: Numbers) -> Numbers:
    """Normals (h, w, 3) of the facets in camera axes, from their depth.

    A plane's inverse depth is linear in the picture, 1/Z = a + b x + c y with x right and y down
    over the focal length, and its normal is (-b, c, a) up to its length. Of the slopes to either
    side the gentler counts, as the other may reach over an edge.
    """
    inverse = 1.0 / depth
    by_row, by_column = (
        _smaller_difference(inverse, axis) * np.float32(camera.focal) for axis in (0, 1)
    )
    y, x = np.mgrid[box.top : box.bottom, box.left : box.right].astype(np.float32)
    x -= np.float32(camera.centre[0])
    y -= np.float32(camera.centre[1])
    x /= np.float32(camera.focal)
    y /= np.float32(camera.focal)
    normal = np.stack([-by_column, by_row, inverse - x * by_column - y * by_row], axis=2)
    normal /= np.sqrt((normal * normal).sum(axis=2, keepdims=True))
    return normal


def _smaller_difference(values: Numbers, axis: int) -> Numbers:
    """The smaller of the differences to the pixels on either side."""
    step = np.diff(values, axis=axis)
    edge = [(0, 0), (0, 0)]
    edge[axis] = (1, 1)
    wide = np.pad(step, edge, mode="edge")
    count = values.shape[axis]
    before, after = np.take(wide, range(count), axis), np.take(wide, range(1, count + 1), axis)
    return np.where(np.abs(before) < np.abs(after), before, after)


def _creased(smooth: Numbers, flat: Numbers) -> Numbers:
    """Normals (P, 3): smooth, but flat at sharp edges.

    Files that give one normal a corner make machined faces look as if they had melted.
    """
    cosine = np.clip((smooth * flat).sum(axis=1), -1.0, 1.0)
    share = np.clip((CREASE_START - cosine) / (CREASE_START - CREASE_FULL), 0.0, 1.0)[:, None]
    mixed = smooth + (flat - smooth) * share
    mixed /= np.maximum(np.sqrt((mixed * mixed).sum(axis=1, keepdims=True)), 1e-6)
    return np.asarray(mixed, np.float32)


def _rotated(vectors: Numbers, rotation: Numbers) -> Numbers:
    """Vectors (P, 3) of the camera's axes, in the base frame; summed in a fixed order."""
    x, y, z = vectors.T
    columns = [x * a + y * b + z * c for a, b, c in rotation.T]
    return np.stack(columns, axis=1).astype(np.float32)


def _positions(camera: Camera, box: Box, seen: NDArray[np.bool_], depth: Numbers) -> Numbers:
    rows, columns = np.nonzero(seen)
    across = (box.left + columns - camera.centre[0]) / camera.focal * depth
    above = -(box.top + rows - camera.centre[1]) / camera.focal * depth
    offset = _rotated(
        np.stack([across, above, -depth], axis=1).astype(np.float32),
        camera.rotation.astype(np.float32),
    )
    return offset + camera.position.astype(np.float32)


class _LitImage(NamedTuple):
    white: NDArray[np.uint8]
    depth: Numbers
    segment: NDArray[np.int32]


def _render_box(
    arm: Arm,
    camera: Camera,
    box: Box,
    scale: float,
    light: Sequence[float],
    shift: tuple[float, float] = (0.0, 0.0),
) -> _LitImage:
    """Render a region of the picture, lit from one direction, with shifted pixel centres."""
    width = max(1, round((box.right - box.left) * scale))
    height = max(1, round((box.bottom - box.top) * scale))
    lens = projection_matrix(camera, box)
    # this renderer looks along a pixel's lower left corner
    lens[:2, 2] += (1.0 + 2.0 * shift[0]) / width, (1.0 - 2.0 * shift[1]) / height
    found: Any = bullet.getCameraImage(
        width,
        height,
        viewMatrix=view_matrix(camera).T.ravel().tolist(),
        projectionMatrix=lens.T.ravel().tolist(),
        lightDirection=light,
        lightColor=[1.0, 1.0, 1.0],
        lightAmbientCoeff=0.0,
        lightDiffuseCoeff=1.0,
        lightSpecularCoeff=0.0,
        shadow=0,
        renderer=bullet.ER_TINY_RENDERER,
        flags=bullet.ER_SEGMENTATION_MASK_OBJECT_AND_LINKINDEX,
        physicsClientId=arm.client,
    )
    _, _, colour, depth, segment = found
    shape = (height, width)
    return _LitImage(
        np.reshape(np.asarray(colour, np.uint8), (*shape, 4)),
        np.reshape(np.asarray(depth, np.float32), shape),
        np.reshape(np.asarray(segment, np.int32), shape),
    )


def _find_arm(arm: Arm, camera: Camera) -> Box | None:
    """The region of the picture that contains the arm."""
    whole = Box(0, 0, camera.width, camera.height)
    scale = min(1.0, SEARCH_COLUMNS / camera.width)
    seen = _render_box(arm, camera, whole, scale, (0.0, 0.0, 1.0)).segment >= 0
    if not seen.any():
        return None
    height, width = seen.shape
    rows, columns = np.flatnonzero(seen.any(axis=1)), np.flatnonzero(seen.any(axis=0))
    across, down = camera.width / width, camera.height / height
    return Box(
        max(0, int((columns[0] - SEARCH_MARGIN) * across)),
        max(0, int((rows[0] - SEARCH_MARGIN) * down)),
        min(camera.width, int((columns[-1] + 1 + SEARCH_MARGIN) * across) + 1),
        min(camera.height, int((rows[-1] + 1 + SEARCH_MARGIN) * down) + 1),
    )


def view_matrix(camera: Camera) -> Floats:
    """The matrix (4, 4) from the base frame to camera axes, as in OpenGL."""
    matrix = np.eye(4)
    matrix[:3, :3] = camera.rotation
    matrix[:3, 3] = -camera.rotation @ camera.position
    return matrix


def projection_matrix(camera: Camera, box: Box) -> Floats:
    """OpenGL's projection matrix (4, 4) for a region of the camera's picture.

    A pixel's middle is at an integer, so that the box begins half a pixel before its first:
    x' = 2 (x + 1/2 - left) / (right - left) - 1, and y' is that of the rows, upwards.
    """
    width, height = box.right - box.left, box.bottom - box.top
    matrix = np.zeros((4, 4))
    matrix[0, 0] = 2.0 * camera.focal / width
    matrix[0, 2] = 1.0 - 2.0 * (camera.centre[0] + 0.5 - box.left) / width
    matrix[1, 1] = 2.0 * camera.focal / height
    matrix[1, 2] = 2.0 * (camera.centre[1] + 0.5 - box.top) / height - 1.0
    matrix[2, 2] = -(FAR_PLANE + NEAR_PLANE) / (FAR_PLANE - NEAR_PLANE)
    matrix[2, 3] = -2.0 * FAR_PLANE * NEAR_PLANE / (FAR_PLANE - NEAR_PLANE)
    matrix[3, 2] = -1.0
    return matrix


def _depth(value: Numbers) -> Numbers:
    """Depth-buffer values, 0 near to 1 far, in metres."""
    near, far = np.float32(NEAR_PLANE), np.float32(FAR_PLANE)
    return np.asarray(far * near / (far - (far - near) * value), np.float32)

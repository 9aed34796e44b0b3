"""An arm and a camera -> position, normal and link for each pixel."""

from dataclasses import dataclass, replace
from typing import Any, NamedTuple

import cv2
import numpy as np
from numpy.typing import NDArray

from dqpaint.dq import Floats
from dqpaint.light.camera import Camera
from dqpaint.render.arm_shapes import Arm
from dqpaint.render.meshes import unit
from dqpaint.render.raster import Raster, rasterise, slopes

CREASE_START, CREASE_FULL = float(np.cos(np.radians(14.0))), float(np.cos(np.radians(28.0)))
"""Cosines of the angle between smooth and flat normals at which an edge begins to count, and counts
in full."""
SUBPIXEL_SHIFTS = ((-0.125, -0.375), (0.125, 0.375), (0.375, -0.125), (-0.375, 0.125))
"""Shifts of the four samples within a pixel, right and down of its centre: a rotated square, for
smooth outlines [px]."""

NORMAL_BLUR = (5, 5)
"""Pixels over which a quick measurement averages normals: a veil has no fine lines."""
NEIGHBOURS = np.ones((3, 3), np.uint8)

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


class _Projected:
    """The triangles of an arm as a camera sees them.

    A normal divided by its depth is linear in the picture, as one over the depth is.

    Attributes:
        link: (T,) numbers of their links.
        pixels: corners (T, 3, 2).
        depth: of the corners (T, 3) [m].
        facets: unit normals (T, 3) towards the camera, whichever way a triangle goes round.
        normals: (T, 3, 3) a, b, c of normal / depth = a + b x + c y.
    """

    def __init__(self, arm: Arm, camera: Camera) -> None:
        surface, self.link = arm.surface()
        pixels, depth = camera.project(surface.corners.reshape(-1, 3))
        self.pixels, self.depth = pixels.reshape(-1, 3, 2), depth.reshape(-1, 3)
        one, other, third = surface.corners.swapaxes(0, 1)
        facets = unit(np.cross(other - one, third - one))
        self.facets = facets * _sign(np.einsum("ti,ti->t", facets, camera.position - one))
        sides = _sign(np.einsum("tci,ti->tc", surface.normals, self.facets))
        x, y = self.pixels[..., 0], self.pixels[..., 1]
        with np.errstate(divide="ignore", invalid="ignore"):  # lines, which no pixel shows
            self.normals = slopes(x, y, sides * surface.normals / self.depth[..., None])

    def sample(
        self, box: Box, shift: tuple[float, float], only: NDArray[np.int64] | None = None
    ) -> Raster:
        """What a sample in each pixel of a region shows.

        Args:
            box: the region.
            shift: of the samples, right and down of the middles of pixels.
            only: the numbers of the triangles that are looked at; None are all.
        """
        corner = np.array([box.left + shift[0], box.top + shift[1]])
        size = box.right - box.left, box.bottom - box.top
        if only is None:
            return rasterise(self.pixels - corner, self.depth, *size)
        found = rasterise(self.pixels[only] - corner, self.depth[only], *size)
        return Raster(np.append(only, -1)[found.triangle], found.nearness)

    def meeting(self, mask: NDArray[np.bool_], box: Box) -> NDArray[np.int64]:
        """The numbers of triangles that may cover a sample of the pixels of a mask (h, w)."""
        height, width = mask.shape
        total = cv2.integral(mask.astype(np.uint8))
        corner = [box.left, box.top]
        low, high = self.pixels.min(axis=1) - corner, self.pixels.max(axis=1) - corner
        some = np.flatnonzero(np.isfinite(low).all(axis=1))
        left, top = np.clip(np.floor(low[some]), 0, (width, height)).astype(np.int64).T
        right, bottom = np.clip(np.ceil(high[some]) + 1, 0, (width, height)).astype(np.int64).T
        count = total[bottom, right] - total[top, right] - total[bottom, left] + total[top, left]
        return np.asarray(some[count > 0])


def measure_surfaces(arm: Arm, camera: Camera) -> Surfaces | None:
    """The visible surfaces of an arm; None if it is not in the picture.

    Args:
        arm: in its posture.
        camera: that of the picture.
    """
    seen = _Projected(arm, camera)
    box = _find_arm(seen, camera)
    if box is None:
        return None
    middle = seen.sample(box, (0.0, 0.0))
    link = _links(seen, middle)
    border = cv2.dilate(link, NEIGHBOURS) != cv2.erode(link, NEIGHBOURS)
    cover, sure = (link >= 0).astype(np.float32), link >= 0
    if border.any():  # elsewhere all samples of a pixel show what its middle does
        only = seen.meeting(border, box)
        sides = [_links(seen, seen.sample(box, shift, only)) for shift in SUBPIXEL_SHIFTS]
        found = np.stack([side[border] for side in sides])
        cover[border] = (found >= 0).mean(axis=0)
        sure[border] &= (found == link[border]).all(axis=0)
    return _measure(seen, camera, box, middle, sure, cover, (0.0, 0.0))


def quick_surfaces(arm: Arm, camera: Camera, shift: tuple[float, float]) -> Surfaces | None:
    """As `measure_surfaces`, from one sample a pixel, with hard outlines.

    Args:
        arm: in its posture.
        camera: that of the picture.
        shift: where in a pixel to look, right and down of its middle [px].
    """
    seen = _Projected(arm, camera)
    box = _find_arm(seen, camera)
    if box is None:
        return None
    found = seen.sample(box, shift)
    sure = found.triangle >= 0
    surfaces = _measure(seen, camera, box, found, sure, sure.astype(np.float32), shift)
    if surfaces is None:
        return None
    image = np.zeros((*sure.shape, 3), np.float32)
    image[sure] = surfaces.normal
    soft = np.asarray(cv2.blur(image, NORMAL_BLUR, borderType=cv2.BORDER_CONSTANT), np.float64)
    return replace(surfaces, normal=np.asarray(unit(soft[sure]), np.float32))


def _find_arm(seen: _Projected, camera: Camera) -> Box | None:
    """The region of the picture that contains the arm, with a pixel around it."""
    pixels = seen.pixels[np.isfinite(seen.pixels).all(axis=(1, 2))].reshape(-1, 2)
    if not len(pixels):
        return None
    most = camera.width, camera.height
    low = np.clip(np.floor(pixels.min(axis=0)) - 1, 0, most).astype(np.int64)
    high = np.clip(np.ceil(pixels.max(axis=0)) + 2, 0, most).astype(np.int64)
    if (low >= high).any():
        return None
    return Box(int(low[0]), int(low[1]), int(high[0]), int(high[1]))


def _links(seen: _Projected, found: Raster) -> NDArray[np.int16]:
    """The link (h, w) that each sample shows, the base's number being 0; -1 for none."""
    return np.append(seen.link + 1, -1).astype(np.int16)[found.triangle]


def _measure(
    seen: _Projected,
    camera: Camera,
    box: Box,
    found: Raster,
    sure: NDArray[np.bool_],
    cover: Numbers,
    shift: tuple[float, float],
) -> Surfaces | None:
    if not sure.any():
        return None
    triangle = found.triangle[sure]
    depth = 1.0 / found.nearness[sure]
    rows, columns = np.nonzero(sure)
    x: Floats = np.asarray(columns + (box.left + shift[0]), np.float64)
    y: Floats = np.asarray(rows + (box.top + shift[1]), np.float64)
    a, b, c = (seen.normals[:, i][triangle] for i in range(3))
    smooth = unit(a + b * x[:, None] + c * y[:, None])
    normal = _creased(smooth, seen.facets[triangle]).astype(np.float32)
    return Surfaces(
        box, cover, sure, depth.astype(np.float32),
        _positions(camera, x, y, depth).astype(np.float32), _without_specks(normal, sure),
        seen.link[triangle],
    )  # fmt: skip


def _without_specks(normals: Numbers, sure: NDArray[np.bool_]) -> Numbers:
    """Normals (P, 3) of an arm's pixels without single ones that differ from all around them.

    They come of facets that are thinner than a pixel, along seams of meshes.
    """
    image = np.zeros((*sure.shape, 3), np.float32)
    image[sure] = normals
    middle = np.asarray(cv2.medianBlur(image, 3), np.float32)
    inside = cv2.erode(sure.astype(np.uint8), NEIGHBOURS, borderValue=0)[sure] > 0
    found = np.where(inside[:, None], middle[sure], normals)
    return np.asarray(unit(found), np.float32)


def _sign(numbers: Floats) -> Floats:
    """-1 or 1 (..., 1)."""
    return np.where(numbers < 0.0, -1.0, 1.0)[..., None]


def _creased(smooth: Floats, flat: Floats) -> Floats:
    """Normals (P, 3): smooth, but flat at sharp edges.

    Files that give one normal a corner make machined faces look as if they had melted.
    """
    cosine = np.clip(np.einsum("pi,pi->p", smooth, flat), -1.0, 1.0)
    share = np.clip((CREASE_START - cosine) / (CREASE_START - CREASE_FULL), 0.0, 1.0)[:, None]
    return unit(smooth + (flat - smooth) * share)


def _positions(camera: Camera, x: Floats, y: Floats, depth: Floats) -> Floats:
    """Places (P, 3) in the base frame, at pixels (P,) and depths (P,)."""
    across = (x - camera.centre[0]) / camera.focal * depth
    above = -(y - camera.centre[1]) / camera.focal * depth
    right, up, back = camera.rotation
    columns = [
        across * right[i] + above * up[i] - depth * back[i] + camera.position[i] for i in range(3)
    ]
    return np.stack(columns, axis=1)

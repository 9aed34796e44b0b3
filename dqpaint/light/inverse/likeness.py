"""A photograph as the camera would see it, and how like it a developed picture is."""

from __future__ import annotations

from dataclasses import dataclass
from typing import cast

import cv2
import numpy as np

from dqpaint.light.arrays import Floats
from dqpaint.light.images.image_difference import structural_similarity
from dqpaint.light.inverse.exposing import Box


@dataclass(frozen=True)
class Likeness:
    """How like two pictures are.

    Attributes:
        ssim: mean structural similarity of their greys, at most 1; Wang et al. 2004.
        rms: root of the mean square difference of sRGB values from 0 to 1.
    """

    ssim: float
    rms: float


def likeness(picture: Floats, photo: Floats) -> Likeness:
    """How like a picture is to a photo, both (H, W, 3) sRGB from 0 to 1."""
    one, other = (np.rint(255.0 * np.clip(p, 0.0, 1.0)).astype(np.uint8) for p in (picture, photo))
    rms = float(np.sqrt(np.mean((picture.astype(np.float64) - photo) ** 2)))
    return Likeness(float(structural_similarity(one, other).mean()), rms)


def seen_through(photo: Floats, corners: Floats, box: Box) -> Floats:
    """A photo (h, w, 3) as a camera sees it whose corners lie at pixels (4, 2), in a box (H, W, 3).

    Args:
        photo: sRGB from 0 to 1.
        corners: lower left, lower right, upper right, upper left, in the picture [px].
        box: the part of the picture; black where the photo is not.
    """
    high, wide = photo.shape[:2]
    sides = np.linalg.norm(np.diff(corners, axis=0), axis=1)
    scale = min(1.0, float(max(sides[0] / wide, sides[1] / high)))
    if scale < 1.0:  # a warp alone would skip pixels
        size = max(1, round(wide * scale)), max(1, round(high * scale))
        photo = cast(Floats, cv2.resize(photo, size, interpolation=cv2.INTER_AREA))
        high, wide = photo.shape[:2]
    own = np.array([[0, high], [wide, high], [wide, 0], [0, 0]], np.float32) - np.float32(0.5)
    there = (corners - np.array([box.left, box.top])).astype(np.float32)
    to = cv2.getPerspectiveTransform(own, there)
    seen = cv2.warpPerspective(
        photo.astype(np.float32), to, (box.width, box.height), flags=cv2.INTER_LINEAR,
        borderMode=cv2.BORDER_REPLICATE,
    )  # fmt: skip
    inside = cv2.warpPerspective(
        np.ones((high, wide), np.float32), to, (box.width, box.height), flags=cv2.INTER_NEAREST
    )
    near = cv2.dilate(inside, np.ones((3, 3), np.uint8))
    return np.asarray(np.clip(seen, 0.0, 1.0) * near[..., None])

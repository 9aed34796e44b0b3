"""A moving arm -> its light during the whole exposure: a veil where it moved.

This is the look of a photograph with a little light in the room. The arm is rendered once for each
moment. The light that its lamp emits during the moment illuminates it, and so does the room's light
for the moment's duration; for the same time it hides the floor. So an arm at rest is clearly
visible, a moving arm is faint, and the lit wrist leaves a haze along the strokes.
"""

from __future__ import annotations

from collections.abc import Callable
from itertools import pairwise

import cv2
import numpy as np
from numpy.typing import NDArray

from dqpaint.dq import Floats
from dqpaint.light import Image
from dqpaint.light.camera import Camera
from dqpaint.render.arm_shapes import Arm
from dqpaint.render.geometry_buffer import quick_surfaces
from dqpaint.render.still import Lights, gather_glow, light_surfaces, render_floor, to_picture_size

MOST_MOMENTS = 48
"""Largest number of moments at which the arm is rendered."""
BLUR_SIDE = 512
"""Pixels of the longer side of one rendering; the veil is soft."""
LAMPS_PER_MOMENT = 4
"""Number of lamps for the light of one moment."""
TIME_SHARE = 0.25
"""Share of the moments distributed over time; the others are distributed over the motion."""
JITTER_STEP = (0.7548776662466927, 0.5698402909980532)
"""Multiples of these are distributed evenly over a pixel, for smooth outlines (Roberts 2018)."""


def blurred_arm(
    arm: Arm,
    postures: Floats,
    camera: Camera,
    shine: Callable[[slice], Lights],
    exposure: float,
    falloff: bool = False,
) -> Image:
    """Linear light (H, W, 3) of arm and floor, to be added before development.

    Args:
        arm: that moved.
        postures: (N, n) at instants a period apart [rad].
        camera: that of the picture.
        shine: of some steps between these instants, of each lamp its points (M, 3) [m] and the
            energy (M-1, 3) between them [lamp s].
        exposure: of the picture: factor from its own unit [lamp s / px^2] to saturation.
        falloff: whether that unit is divided by the distance squared [lamp s / (m px)^2].
    """
    scale = min(1.0, BLUR_SIDE / max(camera.width, camera.height))
    coarse = camera.scaled(scale)
    whole = gather_glow(shine(slice(None)))
    veil = np.zeros((coarse.height, coarse.width, 4), np.float32)  # light, and what is hidden
    edges = moments(postures)
    for i, (first, last) in enumerate(pairwise(edges.tolist())):
        arm.set_posture(postures[(first + last) // 2])
        across, down = ((i * step) % 1.0 - 0.5 for step in JITTER_STEP)
        surfaces = quick_surfaces(arm, coarse, (across, down))
        if surfaces is None:
            continue
        share = (last - first) / edges[-1]
        light = whole.part(shine(slice(first, last)), LAMPS_PER_MOMENT)
        layer = np.full((len(surfaces.position), 4), share, np.float32)
        layer[:, :3] = light_surfaces(arm, surfaces, coarse, light, share)
        surfaces.box.crop(veil)[surfaces.sure] += layer
    ground = render_floor(camera, whole, exposure, falloff)
    size = (round(coarse.width / scale), round(coarse.height / scale))
    over = cv2.resize(veil, size, interpolation=cv2.INTER_LINEAR)
    over = np.asarray(over[: camera.height, : camera.width], np.float32)
    ground *= 1.0 - over[..., 3:]
    ground += over[..., :3]
    return to_picture_size(ground, camera, exposure)


def moments(postures: Floats) -> NDArray[np.int64]:
    """Rows (K+1,) of postures (N, n) at which moments begin and end.

    The arm moves about equally far in each, and there are moments where it is at rest, too.
    """
    steps = max(len(postures) - 1, 1)
    moved = np.abs(np.diff(postures, axis=0)).sum(axis=1)
    total = float(moved.sum())
    weight = np.full(steps, 1.0 / steps)
    if total > 0.0:
        weight = TIME_SHARE * weight + (1.0 - TIME_SHARE) * moved / total
    gone = np.cumsum(weight)
    inner = np.searchsorted(gone, np.arange(1, MOST_MOMENTS) / MOST_MOMENTS * gone[-1]) + 1
    return np.unique(np.concatenate([[0], inner, [steps]]))

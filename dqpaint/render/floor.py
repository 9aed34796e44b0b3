"""Lamps and a camera -> light of the floor under the arm: dark, polished, lit by the painting."""

import cv2
import numpy as np

from dqpaint.light import Image
from dqpaint.light.camera import Camera
from dqpaint.light.sources import inverse_square
from dqpaint.render.lamps import Lamps
from dqpaint.render.shading import fresnel, points_seen_from, shade_by_lamps

ALBEDO = 0.55
"""Albedo of the floor's diffuse light. A real dark floor has a tenth of it, but the arm's position
should be visible."""
MIRROR_SHARE = 1.0
"""Share of the mirror image that a lacquered mirror would show."""
FLOOR_SCALE = 4
"""Pixels of the picture per pixel of the floor; its light is soft."""
MIRROR_BLUR = 0.012
"""Blur of the mirror image, as a share of the picture's height."""
VERTICAL_BLUR_RATIO = 3.0
"""Vertical blur over horizontal blur, as on wet streets."""
FARTHEST_FLOOR = 12.0
"""Farthest visible floor [m]."""
UP = np.array([0.0, 0.0, 1.0], np.float32)


def floor_light(
    camera: Camera,
    lamps: Lamps,
    path: Lamps,
    gain: float,
    exposure: float,
    falloff: bool = False,
) -> Image | None:
    """Light (H, W, 3) that a floor at z = 0 sends to the camera; None if it is not visible.

    It is also None where a lamp was below it: there can be no floor then.

    Args:
        camera: that of the picture.
        lamps: few, that shine on the floor.
        path: many, whose images it mirrors.
        gain: factor from what lamps send [lamp s / m^2] to saturation.
        exposure: factor from the film [lamp s / px^2] to saturation.
        falloff: whether the film's unit is divided by the distance squared [lamp s / (m px)^2].
    """
    if camera.position[2] <= 0.0 or lamps.position[:, 2].min(initial=np.inf) <= 0.0:
        return None
    height, width = -(-camera.height // FLOOR_SCALE), -(-camera.width // FLOOR_SCALE)
    x = ((np.arange(width) + 0.5) * FLOOR_SCALE - 0.5 - camera.centre[0]) / camera.focal
    y = ((np.arange(height) + 0.5) * FLOOR_SCALE - 0.5 - camera.centre[1]) / camera.focal
    right, up, back = camera.rotation
    ray = right * x[None, :, None] - up * y[:, None, None] - back
    down = np.minimum(ray[..., 2], -1e-9)
    reach = -camera.position[2] / down
    seen = reach < FARTHEST_FLOOR
    if not seen.any():
        return None
    place = (camera.position + reach[seen][:, None] * ray[seen]).astype(np.float32)
    points = points_seen_from(camera.position, place, np.broadcast_to(UP, place.shape))
    dull, _ = shade_by_lamps(points, lamps, 1)
    light = np.zeros((height, width, 3), np.float32)
    light[seen] = np.float32(ALBEDO * gain) * dull
    image = _mirror_image(camera, path, (height, width), falloff)
    light[seen] += (
        np.float32(MIRROR_SHARE * exposure) * fresnel(points.cosine_to_eye)[:, None] * image[seen]
    )
    whole = (width * FLOOR_SCALE, height * FLOOR_SCALE)
    shown = cv2.resize(light, whole, interpolation=cv2.INTER_LINEAR)
    return np.asarray(shown[: camera.height, : camera.width], np.float32)


def _mirror_image(
    camera: Camera, path: Lamps, shape: tuple[int, int], falloff: bool = False
) -> Image:
    """The blurred mirror image (h, w, 3) of the lamps in the floor, in the film's unit."""
    below = path.position * [1.0, 1.0, -1.0]
    pixels, _ = camera.project(below)
    energy = path.energy * inverse_square(below, camera)[:, None] if falloff else path.energy
    image = np.zeros((*shape, 3), np.float32)
    near = (pixels + 0.5) / FLOOR_SCALE - 0.5
    height, width = shape
    inside = (near > -0.5).all(axis=1) & (near[:, 0] < width - 0.5) & (near[:, 1] < height - 0.5)
    x, y = np.rint(near[inside]).astype(np.int64).T
    np.add.at(image, (y, x), energy[inside].astype(np.float32) / np.float32(FLOOR_SCALE**2))
    blur = MIRROR_BLUR * height
    return np.asarray(
        cv2.GaussianBlur(image, (0, 0), blur, sigmaY=VERTICAL_BLUR_RATIO * blur), np.float32
    )

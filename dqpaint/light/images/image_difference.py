"""Two pictures of one scene -> measures of their difference that show small faults on black.

The mean of a picture that is mostly black is no measure: a visible hole leaves the mean structural
similarity at 0.9999. So it is the largest difference, the sum of all, and the *least* similarity.
"""

from __future__ import annotations

from dataclasses import dataclass

import cv2
import numpy as np

from dqpaint.core import picture_size
from dqpaint.errors import DqpaintError
from dqpaint.light.arrays import Image, Picture

LARGEST_SIDE = 8448  # px of a picture that is read
SSIM_WINDOW, SSIM_SIGMA = 11, 1.5
C1, C2 = (0.01 * 255) ** 2, (0.03 * 255) ** 2
TIFF = [cv2.IMWRITE_TIFF_COMPRESSION, 8]  # deflate, which loses nothing


@dataclass(frozen=True)
class Difference:
    """Difference between a reference and a new picture of the same size.

    Attributes:
        film_max: largest difference of the linear light, by the reference's largest value.
        film_l1: sum of all differences, by the sum of the reference.
        energy: difference of the sums, by the sum of the reference.
        u8_max: largest difference of the developed pictures, of 255.
        ssim_min: the least structural similarity of any 11x11 window of their greys.
    """

    film_max: float
    film_l1: float
    energy: float
    u8_max: int
    ssim_min: float


def measure_difference(
    light: Image, new_light: Image, shown: Picture, new_shown: Picture
) -> Difference:
    """Measure the difference of two pictures, linear (H, W, 3) and developed (H, W, 3)."""
    before, after = light.astype(np.float64), new_light.astype(np.float64)
    gap = np.abs(after - before)
    most, whole = max(float(before.max()), 1e-300), max(float(before.sum()), 1e-300)
    steps = np.abs(shown.astype(np.int16) - new_shown.astype(np.int16))
    return Difference(
        float(gap.max()) / most,
        float(gap.sum()) / whole,
        abs(float(after.sum()) - float(before.sum())) / whole,
        int(steps.max()),
        float(structural_similarity(shown, new_shown).min()),
    )


def structural_similarity(one: Picture, other: Picture) -> Image:
    """The map (H, W) of structural similarity of the grey pictures.

    Wang et al., Image quality assessment: from error visibility to structural similarity, IEEE
    Trans. Image Processing 13, 2004.
    """
    a, b = (cv2.cvtColor(p, cv2.COLOR_RGB2GRAY).astype(np.float64) for p in (one, other))

    def mean(values: np.ndarray) -> np.ndarray:
        return cv2.GaussianBlur(values, (SSIM_WINDOW, SSIM_WINDOW), SSIM_SIGMA)

    m, n = mean(a), mean(b)
    va, vb, vab = mean(a * a) - m * m, mean(b * b) - n * n, mean(a * b) - m * n
    over = (2 * m * n + C1) * (2 * vab + C2)
    return np.asarray(over / ((m * m + n * n + C1) * (va + vb + C2)))


def difference_picture(light: Image, new_light: Image) -> tuple[Picture, float]:
    """The linear difference (H, W, 3) as a picture scaled to white, and the scale factor.

    Linear, because lines are overexposed in a developed picture, which hides differences.
    """
    gap = np.abs(new_light.astype(np.float64) - light.astype(np.float64))
    most = float(gap.max())
    if most == 0.0:
        return np.zeros(light.shape, np.uint8), 1.0
    shown = 255 * (gap / most) ** (1 / 2.2)
    return shown.astype(np.uint8), max(float(light.max()), 1e-300) / most


def encode_planes(planes: Image) -> bytes:
    """Encode film planes (3, H, W) as a float TIFF, without loss."""
    image = np.ascontiguousarray(np.moveaxis(planes, 0, -1)[..., ::-1], dtype=np.float32)
    done, data = cv2.imencode(".tiff", image, TIFF)
    if not done:
        raise DqpaintError("the film could not be encoded as TIFF")
    return bytes(data.tobytes())


def decode_planes(data: bytes) -> Image:
    """Decode planes (3, H, W) that `encode_planes` wrote.

    Raises:
        ValueError: it is something else.
    """
    return np.ascontiguousarray(np.moveaxis(_decoded(data, np.float32), -1, 0))


def decode_picture(data: bytes) -> Picture:
    """Decode an 8-bit picture (H, W, 3) from a PNG file.

    Raises:
        ValueError: it is something else.
    """
    return _decoded(data, np.uint8)


def _decoded(data: bytes, kind: type) -> np.ndarray:
    """Decode an image (H, W, 3), RGB."""
    size = picture_size(data)
    if size is None or max(size.width, size.height) > LARGEST_SIDE:
        raise ValueError("it is no picture, or one that is too large")
    try:
        found = cv2.imdecode(np.frombuffer(data, np.uint8), cv2.IMREAD_UNCHANGED)
    except cv2.error:
        found = None
    if found is None or found.ndim != 3 or found.shape[2] != 3 or found.dtype != kind:
        raise ValueError("the picture does not have three channels")
    return np.asarray(found[..., ::-1])

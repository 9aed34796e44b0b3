"""An image file -> columns of tints for a row of LEDs; a pattern if there is no file."""

from typing import cast

import numpy as np
from numpy.typing import NDArray

from dqpaint.core import LARGEST_IMAGE, picture_size, read_regular
from dqpaint.core.arrays import Floats
from dqpaint.errors import DqpaintError
from dqpaint.program import colours as named

MOST_COLUMNS = 2000
"""Largest number of columns of an image."""
MOST_PIXELS = 25_000_000
"""Largest image: in linear light it takes 24 bytes a pixel."""


def columns(path: str, leds: int) -> Floats:
    """An image file in linear light, (R, leds, 3): its columns in order, from its foot up."""
    import cv2

    image = _decoded(path)
    levels = np.arange(256) / 255.0
    linear = np.where(levels <= 0.04045, levels / 12.92, ((levels + 0.055) / 1.055) ** 2.4)
    size = (min(image.shape[1], MOST_COLUMNS), leds)
    sized = cv2.resize(cv2.LUT(image[::-1], linear), size, interpolation=cv2.INTER_AREA)
    return np.clip(cast(Floats, sized[..., ::-1]), 0.0, 1.0).transpose(1, 0, 2)


def _decoded(path: str) -> NDArray[np.uint8]:
    """The picture (H, W, 3), blue first, that a file holds; refused before it is decoded."""
    import cv2

    name = f"image '{path[:60]}'"
    try:
        data = read_regular(path, LARGEST_IMAGE)
    except OSError as problem:
        raise DqpaintError(f"{name} cannot be read: {problem.strerror}") from None
    size = picture_size(data)
    if size is None:
        raise DqpaintError(f"{name} is not a picture that can be read; use PNG or JPEG")
    if size.width * size.height > MOST_PIXELS:
        raise DqpaintError(
            f"{name} has {size.width} x {size.height} pixels; at most "
            f"{MOST_PIXELS // 10**6} million are read: make it smaller"
        )
    try:
        image = cv2.imdecode(np.frombuffer(data, np.uint8), cv2.IMREAD_COLOR)
    except cv2.error:
        image = None
    if image is None or image.shape[0] * image.shape[1] != size.width * size.height:
        raise DqpaintError(f"{name} is no sound {size.kind} file; use PNG or JPEG")
    return cast(NDArray[np.uint8], image)


def striped_image(leds: int) -> Floats:
    """A woven pattern (110, leds, 3): bands along the path, hues across it."""
    row, u = np.arange(110)[:, None], (np.arange(leds) + 0.5)[None, :] / leds
    level = np.where(row % 2 == 0, 1.0, 0.12)
    hue = 0.13 + 0.42 * (0.5 + 0.5 * np.cos(2.0 * np.pi * (u + 0.25 * np.sin(row / 17.0))))
    flat = [named.from_hsv(float(h), 0.9, 1.0) for h in np.broadcast_to(hue, (110, leds)).ravel()]
    return np.array(flat).reshape(110, leds, 3) * level[..., None]

"""An image file -> columns of tints for a row of LEDs; a pattern if there is no file."""

from pathlib import Path
from typing import cast

import numpy as np

from dqpaint.core.arrays import Floats
from dqpaint.errors import DqpaintError
from dqpaint.program import colours as named

MOST_COLUMNS = 2000
"""Largest number of columns of an image."""


def columns(path: str, leds: int) -> Floats:
    """An image file in linear light, (R, leds, 3): its columns in order, from its foot up."""
    import cv2

    try:
        data = np.frombuffer(Path(path).read_bytes(), np.uint8)
    except (OSError, ValueError) as problem:
        reason = problem.strerror if isinstance(problem, OSError) else str(problem)
        raise DqpaintError(f"image '{path[:60]}' cannot be read: {reason}") from None
    image = cv2.imdecode(data, cv2.IMREAD_COLOR) if len(data) else None
    if image is None:
        raise DqpaintError(
            f"image '{path[:60]}' is not a picture that can be read; use PNG or JPEG"
        )
    encoded = np.asarray(image[::-1, :, ::-1], dtype=np.float64) / 255.0
    linear = np.where(encoded <= 0.04045, encoded / 12.92, ((encoded + 0.055) / 1.055) ** 2.4)
    size = (min(image.shape[1], MOST_COLUMNS), leds)
    sized = cv2.resize(linear, size, interpolation=cv2.INTER_AREA)
    return np.clip(cast(Floats, sized), 0.0, 1.0).transpose(1, 0, 2)


def striped_image(leds: int) -> Floats:
    """A woven pattern (110, leds, 3): bands along the path, hues across it."""
    row, u = np.arange(110)[:, None], (np.arange(leds) + 0.5)[None, :] / leds
    level = np.where(row % 2 == 0, 1.0, 0.12)
    hue = 0.13 + 0.42 * (0.5 + 0.5 * np.cos(2.0 * np.pi * (u + 0.25 * np.sin(row / 17.0))))
    flat = [named.from_hsv(float(h), 0.9, 1.0) for h in np.broadcast_to(hue, (110, leds)).ravel()]
    return np.array(flat).reshape(110, leds, 3) * level[..., None]

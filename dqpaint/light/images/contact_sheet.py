"""Several pictures -> one: a contact sheet with labels, or an overlay.

sheet     side by side, each above its caption
overlay   the light of each in a colour of its own, added up: what all drew alike is white
"""

from __future__ import annotations

import colorsys
import math
from collections.abc import Mapping, Sequence
from itertools import combinations

import cv2
import numpy as np

from dqpaint.errors import DqpaintError
from dqpaint.light.arrays import Image, Picture
from dqpaint.light.images.legend import look_colours, text_length, write_text

BACKGROUND = 22
"""Grey of the sheet, so that the edges of the pictures are visible."""
MOST_KEY = 26  # px
FIRST_HUE = 30.0
"""First hue: orange, so that two pictures are orange and azure [deg]."""
LEAST_TEXT = 11
CAPTION, KEY = 30, 60
"""Parts of the width of a picture, and of a whole sheet, that text is high."""
LIT_LEVEL = 40
"""Least brightness of a lit pixel, of 255; the halo of a line is dimmer."""
CROP_MARGIN, LEAST_CROP = 0.08, 0.3
"""Margin around the lit part, relative to it; and the least share of a picture that is shown."""
PNG = [cv2.IMWRITE_PNG_STRATEGY, cv2.IMWRITE_PNG_STRATEGY_RLE]

Colour = tuple[float, float, float]


HUE_SETS: dict[int, list[Colour]] = {
    4: [(1, 0, 0.1), (0.1, 1, 1), (0.1, 0.1, 1), (0.9, 1, 0)],
    5: [(1, 1, 0), (0.3, 0, 1), (0.3, 0.45, 1), (1, 0, 0.05), (0, 1, 0.55)],
    6: [(0.75, 0, 1), (0.25, 0.65, 1), (0.6, 1, 0), (0, 1, 0.6), (1, 0.75, 0.25), (1, 0.05, 0.5)],
}
"""Colours found by a search; people with red, green or blue colour blindness can distinguish them,
too."""


def hues(count: int) -> list[Colour]:
    """Colours that add up to nearly grey, as linear RGB; for large counts, hues in a circle."""
    return HUE_SETS.get(count) or [
        colorsys.hsv_to_rgb((FIRST_HUE / 360 + i / count) % 1.0, 1, 1) for i in range(count)
    ]


def overlay(
    lights: Sequence[Image], exposure: float, colours: Sequence[Colour] | None = None
) -> Image:
    """Linear light (H, W, 3) of several pictures, each in its own colour, as a key shows them.

    What a photograph burns out has the colour of its picture, and no more where it is brighter: so
    a line, and where lines lie over each other the sum of their colours, is as in the key
    (`mixed_colours`), and colour is not lost in light. To be developed at `LEGEND_EXPOSURE`.

    Args:
        lights: linear light of each (H, W, 3); their own colours give way to the brightest channel.
        exposure: with which 1 is burnt out.
        colours: of the pictures; None are `hues`.
    """
    total = np.zeros_like(lights[0])
    for light, colour in zip(lights, colours or hues(len(lights)), strict=True):
        share = np.minimum(light.max(axis=2) * np.float32(exposure), 1)
        total += share[..., None] * np.asarray(colour, dtype=np.float32)
    return total


def mixed_colours(named: Mapping[str, Colour]) -> list[tuple[str, Colour]]:
    """The colours of an overlay: of each picture, of two of three alike, and of all.

    Of more than three the colours that some have in common are too many to be told apart.
    """

    def together(names: Sequence[str]) -> Colour:
        red, green, blue = np.sum([named[name] for name in names], axis=0).tolist()
        return red, green, blue

    names = list(named)
    found = list(named.items())
    if len(names) == 3:
        found += [(f"{a} and {b} alike", together((a, b))) for a, b in combinations(names, 2)]
    if len(names) > 1:
        some = "; other tones: some alike" if len(names) > 3 else ""
        found.append((f"{'both' if len(names) == 2 else 'all'} alike{some}", together(names)))
    return found


def sheet(
    pictures: Sequence[Picture], captions: Sequence[str], columns: int | None = None
) -> Picture:
    """A contact sheet: pictures of one size, each above its caption.

    Args:
        pictures: (H, W, 3) each.
        captions: one each, of one line or several; what is too long is cut.
        columns: how many per row; None makes the sheet about square in pictures.
    """
    height, width = pictures[0].shape[:2]
    columns = columns or (3 if len(pictures) == 3 else math.ceil(math.sqrt(len(pictures))))
    rows = math.ceil(len(pictures) / columns)
    size = max(LEAST_TEXT, round(width / CAPTION))
    line, gap = round(1.5 * size), max(2, size // 3)
    foot = line * max(caption.count("\n") + 1 for caption in captions) + size
    shape = (gap + rows * (foot + height), columns * (width + gap) + gap, 3)
    whole = np.full(shape, BACKGROUND, dtype=np.uint8)
    for i, (picture, caption) in enumerate(zip(pictures, captions, strict=True)):
        top, left = gap + (i // columns) * (foot + height), gap + (i % columns) * (width + gap)
        whole[top : top + height, left : left + width] = picture
        for k, text in enumerate(caption.split("\n")):
            baseline = top + height + line * (k + 1)
            write_text(whole, _truncated(text, width - size, size), left + gap, baseline, size)
    return whole


def lit_window(pictures: Sequence[Picture]) -> tuple[slice, slice]:
    """Rows and columns of the region where any of the pictures is lit, with a margin."""
    lit = np.max([picture.max(axis=2) for picture in pictures], axis=0) >= LIT_LEVEL
    found = []
    for axis in (1, 0):
        size = lit.shape[1 - axis]
        at = np.flatnonzero(lit.any(axis=axis))
        low, high = (int(at[0]), int(at[-1]) + 1) if at.size else (0, size)
        margin = max(
            round(CROP_MARGIN * (high - low)), (round(LEAST_CROP * size) - (high - low)) // 2
        )
        found.append(slice(max(0, low - margin), min(size, high + margin)))
    return found[0], found[1]


def with_key(picture: Picture, named: Sequence[tuple[str, Colour]], look: str) -> Picture:
    """A picture with lines of text below it that name the colours."""
    width = picture.shape[1]
    size = max(LEAST_TEXT, min(round(width / KEY), MOST_KEY))
    places, x, line = [], size, 0
    for name, _ in named:
        length = round(4.2 * size) + text_length(name, size)
        if x > size and x + length > width:
            x, line = size, line + 1
        places.append((x, 2 * size * line + size))
        x += length
    strip = np.full((2 * size * (line + 1) + size, width, 3), BACKGROUND, dtype=np.uint8)
    drawn = look_colours([colour for _, colour in named], look)
    for (name, _), ink, (left, top) in zip(named, drawn, places, strict=True):
        strip[top : top + size, left : left + 2 * size] = ink
        name = _truncated(name, width - left - round(2.6 * size), size)
        write_text(strip, name, left + round(2.6 * size), top + size, size)
    return np.concatenate([picture, strip])


def message_picture(text: str, height: int, width: int) -> Picture:
    """A dark picture with the reason why there is no picture."""
    blank = np.zeros((height, width, 3), dtype=np.uint8)
    size = max(LEAST_TEXT, round(height / 28))
    words, lines = text.split(), [""]
    for word in words:
        longer = f"{lines[-1]} {word}".strip()
        if lines[-1] and text_length(longer, size) > width - 2 * size:
            lines.append(word)
        else:
            lines[-1] = longer
    for i, line in enumerate(lines[: max(1, height // (2 * size) - 1)]):
        write_text(blank, _truncated(line, width - size, size), size, (2 * i + 2) * size, size)
    return blank


def encode_png(picture: Picture) -> bytes:
    """Encode a picture (H, W, 3) as PNG."""
    done, data = cv2.imencode(".png", np.ascontiguousarray(picture[..., ::-1]), PNG)
    if not done:
        raise DqpaintError("the picture could not be encoded as PNG")
    return bytes(data.tobytes())


def decode_png(data: bytes) -> Picture:
    """Decode a PNG file to a picture (H, W, 3)."""
    return np.ascontiguousarray(cv2.imdecode(np.frombuffer(data, np.uint8), cv2.IMREAD_COLOR_RGB))


def _truncated(text: str, width: int, size: int) -> str:
    if text_length(text, size) <= width:
        return text
    while text and text_length(text + "...", size) > width:
        text = text[:-1]
    return text + "..."

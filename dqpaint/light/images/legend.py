"""A picture and the meaning of its colours -> the picture with a legend, bottom left."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import cv2
import numpy as np

from dqpaint.light.arrays import Floats, Image, Picture
from dqpaint.light.film.looks import LOOKS

REFERENCE_HEIGHT = 720
"""Rows of the picture for which the sizes below are given."""
MARGIN, WIDTH, THICK, TEXT, GAP = 28, 300, 12, 21, 10
"""Sizes of the legend [px at that height]."""
LEAST_TEXT = 10
"""Least height of text [px]."""
LEGEND_EXPOSURE = 0.8
"""Exposure of the legend's strip and of the strokes of a picture with a legend."""
TEXT_COLOUR = (208, 208, 212)
MOST_LABELS = 12


@dataclass(frozen=True)
class Legend:
    """The meaning of the colours of a picture.

    Attributes:
        title: What is shown, with its unit.
        labels: At the ends of a strip of amounts, or one for each colour.
        colours: Linear RGB (C, 3): the strip, or one for each label.
        amounts: Whether it is a strip.
    """

    title: str
    labels: tuple[str, ...]
    colours: tuple[tuple[float, float, float], ...]
    amounts: bool


def with_legend(picture: Picture, legend: Legend, look: str) -> Picture:
    """A copy of a picture with a legend; a picture that is too small is returned unchanged."""
    scale = picture.shape[0] / REFERENCE_HEIGHT
    size = max(LEAST_TEXT, round(TEXT * scale))
    margin, gap, thick = (max(3, round(v * scale)) for v in (MARGIN, GAP, THICK))
    width = max(round(WIDTH * scale), 12 * size)
    rows = (
        1
        if legend.amounts
        else len(legend.labels[:MOST_LABELS]) + (len(legend.labels) > MOST_LABELS)
    )
    height = size + gap + (thick + gap + size if legend.amounts else rows * (size + gap))
    if width + 2 * margin > picture.shape[1] or height + 2 * margin > picture.shape[0]:
        return picture
    shown = picture.copy()
    top = picture.shape[0] - margin - height
    write_text(shown, legend.title, margin, top + size, size)
    below = top + size + gap
    if legend.amounts:
        along = np.linspace(0, len(legend.colours) - 1, width).round().astype(int)
        strip = look_colours(np.array(legend.colours)[along], look)
        shown[below : below + thick, margin : margin + width] = strip
        baseline = below + thick + gap + size - round(0.25 * size)
        write_text(shown, legend.labels[0], margin, baseline, size)
        right = margin + width - text_length(legend.labels[-1], size)
        write_text(shown, legend.labels[-1], right, baseline, size)
        return shown
    drawn = look_colours(legend.colours, look)
    for i, label in enumerate(legend.labels[:MOST_LABELS]):
        line = below + i * (size + gap)
        middle = line + size // 2 + 1
        shown[middle - thick // 2 : middle + (thick + 1) // 2, margin : margin + 3 * size] = drawn[
            i
        ]
        write_text(shown, label, margin + 4 * size, line + size, size)
    if len(legend.labels) > MOST_LABELS:
        line = below + MOST_LABELS * (size + gap)
        write_text(shown, f"and {len(legend.labels) - MOST_LABELS} more", margin, line + size, size)
    return shown


def with_notes(picture: Picture, notes: Sequence[str]) -> Picture:
    """A copy of a picture with lines of text, bottom right; unchanged where they do not fit."""
    scale = picture.shape[0] / REFERENCE_HEIGHT
    size = max(LEAST_TEXT, round(TEXT * scale))
    margin, gap = (max(3, round(v * scale)) for v in (MARGIN, GAP))
    width = max((text_length(note, size) for note in notes), default=0)
    if not notes or 2 * (width + margin) > picture.shape[1]:  # the left half is the legend's
        return picture
    shown = picture.copy()
    for i, note in enumerate(reversed(notes)):
        baseline = picture.shape[0] - margin - i * (size + gap) - round(0.25 * size)
        left = picture.shape[1] - margin - text_length(note, size)
        write_text(shown, note, left, baseline, size)
    return shown


def look_colours(colours: Floats | Sequence[tuple[float, float, float]], look: str) -> Picture:
    """The 8-bit sRGB (C, 3) of lines with linear RGB colours (C, 3) in a look."""
    image: Image = np.ascontiguousarray(np.array(colours)[None] * LEGEND_EXPOSURE, dtype=np.float32)
    return np.asarray(LOOKS[look](image, 1.0, 0.0)[0])


def write_text(picture: Picture, text: str, x: int, baseline: int, size: int) -> None:
    """Write text into a picture, in place."""
    if hasattr(cv2, "FontFace"):
        face = cv2.FontFace("sans")
        cv2.putText(picture, text, (x, baseline), TEXT_COLOUR, face, size, 400)
        return
    # an older OpenCV has but plotter's letters: drawn large and made small they are even
    fine, height = 4, picture.shape[0]
    patch = np.zeros((fine * 2 * size, fine * (text_length(text, size) + 2), 3), np.uint8)
    place, scale = (fine, fine * round(1.5 * size)), fine * size / 30.0
    cv2.putText(patch, text, place, cv2.FONT_HERSHEY_SIMPLEX, scale, TEXT_COLOUR, fine, cv2.LINE_AA)
    small = cv2.resize(patch, None, fx=1 / fine, fy=1 / fine, interpolation=cv2.INTER_AREA)
    top = min(max(baseline - round(1.5 * size), 0), height - small.shape[0])
    region = picture[top : top + small.shape[0], x : x + small.shape[1]]
    np.maximum(region, small[: region.shape[0], : region.shape[1]], out=region)


def text_length(text: str, size: int) -> int:
    """Length of a text [px]."""
    if hasattr(cv2, "FontFace"):
        box = cv2.getTextSize((10_000, 1_000), text, (0, 0), cv2.FontFace("sans"), size, 400)
        return int(box[2])
    return int(cv2.getTextSize(text, cv2.FONT_HERSHEY_SIMPLEX, size / 30.0, 1)[0][0])

"""Lines of text -> strokes of a pen, in the unit of the font.

The fonts are data beside this module: single-stroke letters digitised by Dr. A. V. Hershey at the
U.S. National Bureau of Standards; `fonts/README.md` says where they come from.
"""

import json
import unicodedata
from collections.abc import Iterator
from functools import cache, lru_cache
from pathlib import Path
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from dqpaint.language.imports.glyph import Glyph
from dqpaint.program import Floats, PiecewiseCurve, piecewise

FONTS = Path(__file__).parent / "fonts"
PLAINEST = "futural"
LINE_PITCH = 1.6  # from a baseline to the next, in heights of a capital
LONGEST = 1000  # letters of one text

# What is round although it is written with few points: a point is a corner if the pen turns there
# by more than the font says; by SHARP between two lines longer than SHORT, in font units; or by
# twice as much beside a line longer than LONG.
SHARP, SHORT, LONG = np.radians(30.0), 5.0, 8.0
STIFF = 2.2  # a stem stays straight where a bow so many times shorter begins

# Signs that are drawn as their plain ones.
_PLAIN = {"’": "'", "‘": "'", "“": '"', "”": '"', "–": "-", "—": "-", "−": "-", "\u00a0": " "}
# How letters are written where they are missing.
_WRITTEN = {
    **{"ä": "ae", "ö": "oe", "ü": "ue", "Ä": "Ae", "Ö": "Oe", "Ü": "Ue", "ß": "ss", "ẞ": "SS"},
    **{"æ": "ae", "Æ": "Ae", "ø": "oe", "Ø": "Oe", "å": "aa", "Å": "Aa", "œ": "oe", "Œ": "Oe"},
    **{"ł": "l", "Ł": "L", "đ": "d", "Đ": "D", "ð": "d", "þ": "th", "ı": "i", "ς": "σ"},
    **{"…": "...", "„": '"', "«": "<<", "»": ">>", "×": "x", "€": "EUR", "£": "GBP"},
}


class Font(NamedTuple):
    """A font: the height of its capitals, its largest angle [rad] within a bow, its letters."""

    name: str
    about: str
    cap: float
    sharpest: float
    glyphs: dict[str, Glyph]

    def has(self, letter: str) -> bool:
        """Whether the font has a letter."""
        return _PLAIN.get(letter, letter) in self.glyphs or self.composed(letter) is not None

    def glyph(self, letter: str) -> Glyph:
        """The glyph of a letter of the font, or of one made of its letters."""
        known = self.glyphs.get(_PLAIN.get(letter, letter)) or self.composed(letter)
        assert known is not None, letter
        return known

    def composed(self, letter: str) -> Glyph | None:
        """A letter that is made of others of the font; None if it is not."""
        if letter.isascii():
            return None
        from dqpaint.language.imports import composed_letters

        return composed_letters.compose(letter, self.glyphs, self.name)


def font_names() -> list[str]:
    """The names of all fonts."""
    return sorted(path.stem for path in FONTS.glob("*.json"))


@cache
def read_font(name: str) -> Font:
    """A font by its name, one of `font_names()`."""
    data = json.loads((FONTS / f"{name}.json").read_text("utf-8"))
    glyphs = {
        letter: Glyph(width, tuple(np.array(s, dtype=np.float64).reshape(-1, 2) for s in strokes))
        for letter, (width, strokes) in data["glyphs"].items()
    }
    return Font(data["name"], data["about"], data["cap"], np.radians(data["round"]), glyphs)


class Lettering(NamedTuple):
    """The strokes of a text, whose first baseline begins at the origin.

    Attributes:
        strokes: in the order of writing, in font units.
        width: of the longest line, as it is inked.
    """

    strokes: list[PiecewiseCurve]
    width: float


@lru_cache(maxsize=64)  # as in a `repeat`
def lay_out(lines: tuple[str, ...], name: str, align: str) -> Lettering:
    """The strokes of lines one below the other; each begins, ends or is centred at x = 0."""
    font = read_font(name)
    strokes: list[PiecewiseCurve] = []
    longest = 0.0
    for number, line in enumerate(lines):
        placed, left, right = _line(line, font)
        edge = {"left": left, "right": right, "centre": 0.5 * (left + right)}[align]
        shift = np.array([-edge, -number * LINE_PITCH * font.cap, 0.0])
        strokes += [piecewise.transform(stroke, np.eye(3), shift) for stroke in placed]
        longest = max(longest, right - left)
    return Lettering(strokes, longest)


def _line(line: str, font: Font) -> tuple[list[PiecewiseCurve], float, float]:
    """The strokes of a line, and the range of its ink; surrounding blanks count as ink."""
    pen, inked = 0.0, []
    blank = [0.0, 0.0]  # before the first letter, after the last
    for letter in line:
        glyph = font.glyph(letter)
        inked += [points + np.array([pen, 0.0]) for points in glyph.strokes]
        blank[bool(inked)] = 0.0 if glyph.strokes else blank[bool(inked)] + glyph.width
        pen += glyph.width
    if not inked:
        return [], 0.0, 0.0
    strokes = [_stroke(points, font.sharpest) for points in _continued(inked)]
    left, right = (float(corner[0]) for corner in piecewise.bounding_box(strokes))
    return strokes, left - blank[0], right + blank[1]


def _continued(strokes: list[Floats]) -> list[Floats]:
    """Joins a stroke to the one before if it begins at its end and does not reverse there."""
    out: list[Floats] = []
    for points in strokes:
        before = out[-1] if out else None
        if before is not None and (before[-1] == points[0]).all():
            turn = np.dot(before[-1] - before[-2], points[1] - points[0])
            if turn > 0.0:
                out[-1] = np.concatenate([before, points[1:]])
                continue
        out.append(points)
    return out


def _stroke(points: Floats, sharpest: float) -> PiecewiseCurve:
    """A polyline of a letter, with its round parts smoothed."""
    flat = np.concatenate([points, np.zeros((len(points), 1))], axis=1)
    new = np.concatenate([[True], np.any(np.diff(flat, axis=0) != 0.0, axis=1)])
    flat = flat[new]
    return piecewise.smooth_curve(flat, _corners(flat, sharpest), STIFF)


def _corners(points: Floats, sharpest: float) -> NDArray[np.bool_]:
    """Which points of a polyline are true corners."""
    size = np.linalg.norm(np.diff(points, axis=0), axis=1)
    shorter = np.minimum(np.roll(size, 1), size)
    longer = np.maximum(np.roll(size, 1), size)
    shorter, longer = (np.append(side, side[0]) for side in (shorter, longer))
    turn = piecewise.turn_angles(points)
    corner = (turn > SHARP) & (shorter > SHORT) | (turn > 2.0 * SHARP) & (longer > LONG)
    return np.asarray(corner | (turn > sharpest))


# What a font lacks.


def missing(lines: tuple[str, ...], font: Font) -> Iterator[tuple[int, int]]:
    """Line and position of each letter that a font does not have."""
    for number, line in enumerate(lines):
        for place, letter in enumerate(line):
            if not font.has(letter):
                yield number, place


def with_substitutes(line: str, font: Font) -> str:
    """A line with substitutes for letters a font lacks; empty if it lacks those too."""
    out = "".join(letter if font.has(letter) else _substitute(letter) for letter in line)
    return out if all(font.has(letter) for letter in out) else ""


def _substitute(letter: str) -> str:
    if letter in _WRITTEN:
        return _WRITTEN[letter]
    apart = unicodedata.normalize("NFKD", letter)
    return "".join(part for part in apart if not unicodedata.combining(part))


def fonts_with(letter: str) -> list[str]:
    """The fonts that have a letter."""
    return [name for name in font_names() if read_font(name).has(letter)]

"""Letters of a font -> letters it lacks: with accents, joined, barred, raised; signs of Latin-1.

All sizes are in units of the font, whose capitals are 21 high; marks have their own origin.
"""

import unicodedata
from collections.abc import Callable, Mapping

import numpy as np

from dqpaint.language.imports.glyph import Glyph
from dqpaint.program import Floats

Glyphs = Mapping[str, Glyph]
Strokes = tuple[Floats, ...]

CAP = 21.0
LEAST_ROOM = 2.0  # what a mark may stand out beyond its letter
GAP = 2.5  # between a letter and the mark above it
LEANING = {"cursive": 0.0, "scripts": 0.35, "timesi": 0.27}  # to the right, for each unit upwards


def _pen(*lines: str) -> Strokes:
    """Strokes from `x,y x,y ...`."""
    points = ([tuple(map(float, p.split(","))) for p in line.split()] for line in lines)
    return tuple(np.array(line) for line in points)


def _moved(strokes: Strokes, x: float, y: float = 0.0, scale: float = 1.0) -> Strokes:
    return tuple(scale * points + np.array([x, y]) for points in strokes)


_RING = tuple(
    [np.stack([2.0 * np.cos(a), 2.0 + 2.0 * np.sin(a)], 1) for a in [np.linspace(0, 2 * np.pi, 13)]]
)
# Marks over a letter: their middle is at x = 0, their lowest point at y = 0.
_ABOVE = {
    "\u0300": _pen("-3,4 1,0"),
    "\u0301": _pen("-1,0 3,4"),
    "\u0302": _pen("-4,0 0,4 4,0"),
    "\u0303": _pen("-5,0 -4,2 -2.5,2.8 -1,2.2 1,1 2.5,0.4 4,1.2 5,3"),
    "\u0304": _pen("-4,1 4,1"),
    "\u0306": _pen("-4,3.5 -3,1.3 -1,0 1,0 3,1.3 4,3.5"),
    "\u030a": _RING,
    "\u030b": _pen("-3,0 0,4", "2,0 5,4"),
    "\u030c": _pen("-4,4 0,0 4,4"),
}
_DOTS = {"\u0307": (0.0,), "\u0308": (-3.0, 3.0)}  # above: where the font's full stop stands
# Marks under a letter: from x = 0 at its foot.
_CEDILLA, _OGONEK, _COMMA = "\u0327", "\u0328", "\u0326"
_BELOW = {
    _CEDILLA: _pen("0,0 -0.5,-2 1.5,-2.6 2.2,-4 1,-5.6 -1,-6 -2.5,-5.5"),
    _OGONEK: _pen("0,0 -1.5,-1.5 -2.2,-3.5 -1.2,-5.2 0.5,-5.5 1.5,-5"),
    _COMMA: _pen("1,-3 1,-4.5 0,-6 -1,-7"),
}
_COMMA_LETTERS = "GKkLlNnRr"  # whose cedilla of Unicode is a comma in print
_APOSTROPHE_LETTERS = "dLlt"  # whose caron is an apostrophe at their right


def compose(letter: str, glyphs: Glyphs, name: str) -> Glyph | None:
    """A letter made of those of a font; None if it can't be made."""
    made = _OWN.get(letter)
    if made is not None:
        return Glyph(*made)
    if letter in _MADE_OF:
        needed, make = _MADE_OF[letter]
        return make(glyphs) if all(part in glyphs for part in needed) else None
    apart = unicodedata.normalize("NFD", letter)
    base, marks = apart[0], apart[1:]
    if not marks or base not in glyphs or "." not in glyphs:
        return None
    glyph = glyphs[base]
    for mark in marks:
        added = _marked(base, glyph, mark, glyphs, LEANING.get(name, 0.0))
        if added is None:
            return None
        glyph = added
    return _spaced(glyph)


def _marked(base: str, glyph: Glyph, mark: str, glyphs: Glyphs, leaning: float) -> Glyph | None:
    """A letter with one more mark."""
    strokes = glyph.strokes
    if base in _APOSTROPHE_LETTERS and mark == "\u030c":
        at = float(_box(strokes)[1][0]) + 2.0
        if base == "L":
            top = np.concatenate(strokes)
            at = float(top[top[:, 1] > 0.7 * CAP][:, 0].max()) + 3.0
        return Glyph(glyph.width + 3.0, (*strokes, *_moved(_pen("1,21 1,19 0,16"), at)))
    if mark in _BELOW:
        low, high = _box(strokes)
        if base == "g" and mark == _CEDILLA:  # turned, above
            turned = tuple(-points for points in _BELOW[_COMMA])
            at = 0.5 * (low[0] + high[0])
            return Glyph(glyph.width, (*strokes, *_moved(turned, at, high[1])))
        if mark == _CEDILLA and base in _COMMA_LETTERS:
            mark = _COMMA
        at = _right_foot(strokes) if mark == _OGONEK else 0.5 * (low[0] + high[0])
        return Glyph(glyph.width, (*strokes, *_moved(_BELOW[mark], at)))
    if base in "ij":
        strokes = _undotted(base, glyphs)
    low, high = _box(strokes)
    x = 0.5 * (low[0] + high[0]) + leaning * (0.5 * (high[1] - low[1]) + GAP)
    y = high[1] + GAP
    if mark in _ABOVE:
        return Glyph(glyph.width, (*strokes, *_moved(_ABOVE[mark], x, y)))
    if mark in _DOTS:
        dots = (_dot(glyphs, x + away, y) for away in _DOTS[mark])
        return Glyph(glyph.width, (*strokes, *(stroke for dot in dots for stroke in dot)))
    return None


def _spaced(glyph: Glyph) -> Glyph:
    """A letter as wide at least as its marks, so that those of two letters do not touch."""
    (left, _), (right, _) = _box(glyph.strokes)
    before, after = max(0.0, 1.0 - left), max(0.0, right + 1.0 - glyph.width)
    if max(before, after) > LEAST_ROOM:
        return Glyph(glyph.width + before + after, _moved(glyph.strokes, before))
    return glyph


def _box(strokes: Strokes) -> tuple[Floats, Floats]:
    points = np.concatenate(strokes)
    return points.min(axis=0), points.max(axis=0)


def _right_foot(strokes: Strokes) -> float:
    """The x of the rightmost point that stands on the baseline."""
    points = np.concatenate(strokes)
    return float(points[np.abs(points[:, 1]) <= 1.0][:, 0].max())


def _dot(glyphs: Glyphs, x: float, y: float) -> Strokes:
    """The full stop of a font, its middle at x and its lowest point at y."""
    low, high = _box(glyphs["."].strokes)
    return _moved(glyphs["."].strokes, x - 0.5 * (low[0] + high[0]), y - low[1])


def _small(glyphs: Glyphs) -> float:
    """The height of small letters."""
    return float(_box(glyphs["x" if "x" in glyphs else "χ"].strokes)[1][1])


def _undotted(letter: str, glyphs: Glyphs) -> Strokes:
    top = _small(glyphs) + 0.5
    return tuple(points for points in glyphs[letter].strokes if points[:, 1].min() <= top)


# Letters made of others.

_Make = Callable[[Glyphs], Glyph]
_More = Callable[[Floats, Floats, Glyphs], Strokes]


def _with(
    letter: str, more: Callable[[Floats, Floats, Glyphs], Strokes], wider: float = 0
) -> _Make:
    """A letter with strokes that depend on its lowest and highest coordinates."""

    def make(glyphs: Glyphs) -> Glyph:
        glyph = glyphs[letter]
        return Glyph(glyph.width + wider, (*glyph.strokes, *more(*_box(glyph.strokes), glyphs)))

    return make


def _line(x0: float, y0: float, x1: float, y1: float) -> Floats:
    return np.array([[x0, y0], [x1, y1]])


def _side_by_side(first: str, second: str, overlap: float | None = None) -> _Make:
    """Two letters; ligatures `overlap` by so much of their ink."""

    def make(glyphs: Glyphs) -> Glyph:
        a, b = glyphs[first], glyphs[second]
        at = a.width
        if overlap is not None:
            at = float(_box(a.strokes)[1][0] - _box(b.strokes)[0][0]) - overlap
        return Glyph(at + b.width, (*a.strokes, *_moved(b.strokes, at)))

    return make


def _stem(glyphs: Glyphs, letter: str) -> float:
    """The x of a letter's descender."""
    points = np.concatenate(glyphs[letter].strokes)
    return float(points[points[:, 1] <= points[:, 1].min() + 1.0][:, 0].mean())


def _hooked(letter: str) -> _Make:
    """A letter whose right leg ends in a hook, as ŋ."""

    def more(low: Floats, high: Floats, glyphs: Glyphs) -> Strokes:
        points = np.concatenate(glyphs[letter].strokes)
        right = points[points[:, 1] <= 1.0][:, 0].max()
        return _moved(_pen("0,0 0,-3 -1,-6 -3,-7 -5,-6"), float(right))

    return _with(letter, more)


def _thorn(glyphs: Glyphs) -> Glyph:
    glyph, at = glyphs["p"], _stem(glyphs, "p")
    return Glyph(glyph.width, (*glyph.strokes, _line(at, _small(glyphs) - 1, at, CAP)))


def _eth(glyphs: Glyphs) -> Glyph:
    glyph = glyphs["o"]
    (left, _), (right, top) = _box(glyph.strokes)
    x = 0.5 * (left + right)
    bow = _pen("0,0 -0.5,3 -2,6 -4,8.5 -7,11")
    bar = _line(x - 3, top + 2.5, x + 3, top + 6)
    return Glyph(glyph.width, (*glyph.strokes, *_moved(bow, right, 0.5 * top), bar))


def _scaled(letter: str, scale: float, y: float, under: bool = False) -> _Make:
    """A letter made smaller and raised."""

    def make(glyphs: Glyphs) -> Glyph:
        glyph = glyphs[letter]
        strokes = _moved(glyph.strokes, 0.0, y, scale)
        if under:
            (left, low), (right, _) = _box(strokes)
            strokes = (*strokes, _line(left, low - 2.5, right, low - 2.5))
        return Glyph(scale * glyph.width, strokes)

    return make


def _fraction(above: str, below: str) -> _Make:
    def make(glyphs: Glyphs) -> Glyph:
        first, last = glyphs[above], glyphs[below]
        at = 0.55 * first.width
        slash = _line(at - 3.0, 0.0, at + 7.0, CAP)
        strokes = (*_moved(first.strokes, 0.0, 9.5, 0.55), slash)
        strokes = (*strokes, *_moved(last.strokes, at + 3.0, 0.0, 0.55))
        return Glyph(at + 3.0 + 0.55 * last.width, strokes)

    return make


def _turned(letter: str) -> _Make:
    """A sign turned by half a turn, so that it begins below the baseline."""

    def make(glyphs: Glyphs) -> Glyph:
        glyph = glyphs[letter]
        low, high = _box(glyph.strokes)
        strokes = tuple(low + high - points for points in glyph.strokes)
        return Glyph(glyph.width, _moved(strokes, 0.0, _small(glyphs) - CAP))

    return make


def _circled(letter: str) -> _Make:
    def make(glyphs: Glyphs) -> Glyph:
        angle = np.linspace(0.0, 2.0 * np.pi, 25)
        ring = np.stack([13.0 + 10.5 * np.cos(angle), 10.5 + 10.5 * np.sin(angle)], axis=1)
        glyph = glyphs[letter]
        low, high = _box(glyph.strokes)
        x, y = np.array([13.0, 10.5]) - 0.25 * (low + high)
        return Glyph(26.0, (ring, *_moved(glyph.strokes, x, y, 0.5)))

    return make


def _undotted_i(glyphs: Glyphs) -> Glyph:
    return Glyph(glyphs["i"].width, _undotted("i", glyphs))


def _middle_dot(glyphs: Glyphs) -> Glyph:
    return Glyph(glyphs["."].width, _dot(glyphs, 0.5 * glyphs["."].width, 9.0))


def _alone(mark: str) -> _Make:
    """A mark above no letter."""

    def make(glyphs: Glyphs) -> Glyph:
        if mark in _DOTS:
            return Glyph(14.0, (*_dot(glyphs, 4.0, 17.0), *_dot(glyphs, 10.0, 17.0)))
        return Glyph(14.0, _moved(_ABOVE[mark], 7.0, 17.0))

    return make


def _bar(y: float, left: float, right: float, from_right: bool = False) -> _More:
    """A bar at a height, from `left` to `right` of one side of the letter."""

    def more(low: Floats, high: Floats, glyphs: Glyphs) -> Strokes:
        x = float(high[0] if from_right else low[0])
        return (_line(x + left, y, x + right, y),)

    return more


_MADE_OF: dict[str, tuple[str, _Make]] = {
    **{
        pair: (first + second, _side_by_side(first, second, overlap))
        for pair, first, second, overlap in (
            *(("æ", "a", "e", 1.0), ("Æ", "A", "E", 4.0), ("œ", "o", "e", 1.0)),
            *(("Œ", "O", "E", 2.0), ("ĳ", "i", "j", None), ("Ĳ", "I", "J", None)),
            ("ŉ", "'", "n", None),
        )
    },
    **{
        barred: (letter, _with(letter, lambda low, high, _: (_line(*(low - 1.5), *(high + 1.5)),)))
        for barred, letter in (("ø", "o"), ("Ø", "O"))
    },
    "đ": ("d", _with("d", _bar(17.5, -6.0, 2.0, from_right=True))),
    **{
        letter: (
            "D",
            _with("D", lambda a, b, _: (_line(a[0] - 2, 10.5, 0.5 * (a[0] + b[0]), 10.5),)),
        )
        for letter in "ÐĐ"
    },
    "ħ": ("h", _with("h", _bar(17.5, -2.5, 6.0))),
    "Ħ": ("H", _with("H", lambda a, b, _: (_line(a[0] - 2, 16, b[0] + 2, 16),))),
    "ŧ": ("t", _with("t", lambda a, b, _: (_line(a[0], 7, b[0], 7),))),
    "Ŧ": ("T", _with("T", lambda a, b, _: (_line(a[0] + 3, 10, b[0] - 3, 10),))),
    "ł": (
        "l",
        _with(
            "l", lambda a, b, _: (_line(*(0.5 * (a + b) - (4, 2.5)), *(0.5 * (a + b) + (4, 2.5))),)
        ),
    ),
    "Ł": ("L", _with("L", lambda a, b, _: (_line(a[0] - 2, 8, 0.5 * (a[0] + b[0]) + 1, 14),))),
    "ŀ": ("l.", _with("l", lambda a, b, glyphs: _dot(glyphs, float(b[0]) + 3, 9.0), 4.0)),
    "Ŀ": ("L.", _with("L", lambda a, b, glyphs: _dot(glyphs, float(b[0]) - 3, 9.0))),
    "ŋ": ("n", _hooked("n")),
    "Ŋ": ("N", _hooked("N")),
    "þ": ("px", _thorn),
    "ð": ("o", _eth),
    "ı": ("ix", _undotted_i),
    "ĸ": ("k", _scaled("k", 2.0 / 3.0, 0.0)),
    "¡": ("!x", _turned("!")),
    "¿": ("?x", _turned("?")),
    "¢": (
        "c",
        _with(
            "c", lambda a, b, _: (_line(0.5 * (a[0] + b[0]), -3, 0.5 * (a[0] + b[0]), b[1] + 3),)
        ),
    ),
    "¥": (
        "Y",
        _with(
            "Y",
            lambda a, b, _: (_line(a[0] + 3, 8, b[0] - 3, 8), _line(a[0] + 3, 4.5, b[0] - 3, 4.5)),
        ),
    ),
    "©": ("C", _circled("C")),
    "®": ("R", _circled("R")),
    "ª": ("a", _scaled("a", 0.6, 12.0, under=True)),
    "º": ("o", _scaled("o", 0.6, 12.0, under=True)),
    **{
        raised: (digit, _scaled(digit, 0.55, 9.5))
        for raised, digit in zip("¹²³", "123", strict=True)
    },
    **{
        sign: (above + below, _fraction(above, below))
        for sign, above, below in (("¼", "1", "4"), ("½", "1", "2"), ("¾", "3", "4"))
    },
    "µ": ("u", _with("u", lambda a, b, _: (_line(a[0], b[1] - 2, a[0], -7),))),
    "·": (".", _middle_dot),
    "¨": (".", _alone("\u0308")),
    "¯": (".", _alone("\u0304")),
    "´": (".", _alone("\u0301")),
    "÷": (
        ".",
        lambda glyphs: Glyph(
            26.0, (_line(4, 9, 22, 9), *_dot(glyphs, 13, 14), *_dot(glyphs, 13, 2))
        ),
    ),
}

# What has a form of its own: width and strokes.
_OWN: dict[str, tuple[float, Strokes]] = {
    "ß": (
        18.0,
        _pen(
            "4,0 4,16 5,19 7,21 10,21 12,19 12,16 11,14 8,12", "8,12 11,11 13,9 14,6 13,3 11,1 8,0"
        ),
    ),
    "Þ": (21.0, _pen("4,21 4,0", "4,16 11,16 14,15 16,13 16,9 14,7 11,6 4,6")),
    "ſ": (11.0, _pen("4,0 4,17 5,20 7,21 9,21")),
    "£": (20.0, _pen("15,17 14,20 12,21 10,21 8,20 7,18 7,13 8,9 8,5 7,2 4,0 16,0", "4,11 12,11")),
    "¤": (
        20.0,
        (*_moved(_RING, 10, 6, 2.0), *_pen("4,4 7,7", "16,4 13,7", "4,16 7,13", "16,16 13,13")),
    ),
    "¦": (8.0, _pen("4,25 4,12", "4,6 4,-7")),
    "§": (
        16.0,
        _pen(
            "13,19 12,20.5 10,21 7,21 5,20 4,18 5,16 11,12 13,10 13,8 12,6 10,5",
            "6,15 4,13 4,11 5,9 11,5 12,3 11,1 9,0 6,0 4,1 3,3",
        ),
    ),
    "«": (20.0, _pen("10,13 4,8 10,3", "16,13 10,8 16,3")),
    "»": (20.0, _pen("4,13 10,8 4,3", "10,13 16,8 10,3")),
    "¬": (24.0, _pen("4,11 20,11 20,6")),
    "°": (12.0, _moved(_RING, 6, 17)),
    "±": (26.0, _pen("13,19 13,5", "6,12 20,12", "6,1 20,1")),
    "¶": (19.0, _pen("10,21 10,-4", "15,21 15,-4", "15,21 8,21 5,20 3,17 3,14 5,11 8,10 10,10")),
    "¸": (10.0, _moved(_BELOW[_CEDILLA], 5)),
    "×": (22.0, _pen("4,16 18,2", "4,2 18,16")),
    "ς": (17.0, _pen("15,11 14,13 12,14 9,14 6,12 4,9 4,6 5,4 8,2 12,0 13,-2 12,-5 9,-6")),
}

"""SVG attributes -> numbers, lengths, paths, transforms and paints.

Each is read by SVG's own grammar. What can't be read is an error that says which part of it.
"""

import colorsys
import math
import re
from collections.abc import Callable, Mapping
from typing import NamedTuple

from dqpaint.program import colours

LARGEST = 1e9  # [px]
LEAST_RADIUS = 1e-9
MOST_TRANSFORMS = 1_000  # of one attribute
INCH = 96.0  # [px] as CSS has it
_UNITS = {"": 1.0, "px": 1.0, "in": INCH, "pc": INCH / 6, "pt": INCH / 72, "q": INCH / 101.6}
_UNITS |= {"cm": INCH / 2.54, "mm": INCH / 25.4}
_ANGLES = {"": 1.0, "deg": 1.0, "grad": 0.9, "turn": 360.0, "rad": math.degrees(1.0)}

_N = r"[-+]?(?:\d+\.?\d*|\.\d+)(?:[eE][-+]?\d+)?"
_GAP = r"(?>\s*,?\s*)"
NUMBER = re.compile(_N, re.ASCII)
_LENGTH = re.compile(rf"({_N})([a-zA-Z]*|%)", re.ASCII)
_LIST = re.compile(rf"\s*(?:(?>{_N}){_GAP})*+", re.ASCII)
_PARTS = 3 * [f"((?>{_N}))"] + 2 * ["([01])"] + 2 * [f"((?>{_N}))"]  # flags need no gap
_ARC = re.compile(_GAP.join(_PARTS) + _GAP, re.ASCII)
_ARCS = re.compile(rf"\s*(?:{_ARC.pattern})*+", re.ASCII)
Commands = list[tuple[str, list[float]]]  # the letters of a path, with their numbers
COUNTS = {"m": 2, "l": 2, "h": 1, "v": 1, "c": 6, "s": 4, "q": 4, "t": 2, "a": 7}
_COMMAND = re.compile(r"([MmZzLlHhVvCcSsQqTtAa])([^MmZzLlHhVvCcSsQqTtAa]*)")
_FUNCTION = re.compile(r"[\s,]*([a-zA-Z]+)\s*\(([^()]*)\)")
_COLOUR = re.compile(r"(rgb|hsl)a?\(([^()]*)\)", re.IGNORECASE)
_URL = re.compile(r"url\(\s*[\"']?#?([^\"')]*)[\"']?\s*\)\s*(.*)", re.DOTALL)


Matrix = tuple[float, float, float, float, float, float]  # a to f, as SVG has them
IDENTITY: Matrix = (1.0, 0.0, 0.0, 1.0, 0.0, 0.0)
Paint = bytes | None  # red, green, blue and alpha; None for no paint
CURRENT = b""  # the value of `color`
BLACK = b"\0\0\0\xff"


class Length(NamedTuple):
    """Pixels, or a percentage of a reference length."""

    pixels: float = 0.0
    percent: float = 0.0


class SvgError(Exception):
    """Why a drawing can't be drawn, and a fix."""

    def __init__(self, message: str, help: str = "") -> None:
        super().__init__(message)
        self.message, self.help = message, help


class UnreadableError(Exception):
    """Why an attribute can't be read."""


def shown(text: str) -> str:
    """A text from a file, quoted for a message."""
    text = " ".join(text.split())
    return f"'{text[:24]}…'" if len(text) > 25 else f"'{text}'"


def number(text: str) -> float:
    """A number without a unit."""
    if not NUMBER.fullmatch(text.strip()):
        raise UnreadableError(f"{shown(text)} is no number")
    return _bounded(float(text), text)


def _bounded(value: float, text: str) -> float:
    if not abs(value) <= LARGEST:
        raise UnreadableError(f"{shown(text)} is far too large")
    return value


def length(text: str) -> Length:
    """A length in pixels, or a percentage of a reference length."""
    match = _LENGTH.fullmatch(text.strip())
    if not match:
        raise UnreadableError(f"{shown(text)} is no length")
    if match[2] == "%":
        return Length(percent=number(match[1]))
    if match[2].lower() not in _UNITS:
        raise UnreadableError(f"the unit of {shown(text)} is none of px, mm, cm, in, pt, pc, %")
    return Length(_bounded(float(match[1]) * _UNITS[match[2].lower()], text))


def size(text: str) -> Length:
    """A length that is not negative."""
    made = length(text)
    if min(made) < 0.0:
        raise UnreadableError(f"{shown(text)} is negative")
    return made


def size_or_auto(text: str) -> Length | None:
    """A length that is not negative; None for `auto`, which equals a missing attribute."""
    return None if text.strip() == "auto" else size(text)


def numbers(text: str, what: str = "a number", after: str = "") -> list[float]:
    """Numbers separated by blanks or commas; `after` is the text that follows."""
    match = _LIST.match(text)
    end = match.end() if match else 0
    if end < len(text) or text.rstrip().endswith(","):
        strange = (text[end:] + after).lstrip()[:60].split(" ")[0] or ","
        raise UnreadableError(f"{shown(strange)} stands where {what} is expected")
    found = NUMBER.findall(text)
    values = list(map(float, found))
    if values and not max(map(abs, values)) <= LARGEST:
        for value, written in zip(values, found, strict=True):
            _bounded(value, written)
    return values


def points(text: str) -> Commands:
    """The corners of a polygon, as commands of a path."""
    found = numbers(text)
    if len(found) % 2:
        raise UnreadableError(f"it has {len(found)} numbers, and points have two each")
    return [("M", found)] if found else []


def view_box(text: str) -> list[float]:
    """Four numbers; the last two are sizes."""
    found = numbers(text)
    if len(found) != 4:
        raise UnreadableError(f"it has {len(found)} numbers instead of 4")
    if min(found[2:]) < 0.0:
        raise UnreadableError(f"its size is negative: {shown(text)}")
    return found


def path(text: str) -> Commands:
    """The commands of a path and their numbers."""
    text = text.strip()
    if not text or text == "none":
        return []
    if text[0] not in "Mm":
        raise UnreadableError(f"it begins with {shown(text[:1])}, not with M")
    parts = _COMMAND.finditer(text)
    return [(part[1], _segment(part[1], part[2], text, part.end())) for part in parts]


def _segment(command: str, text: str, whole: str, end: int) -> list[float]:
    """The numbers of one command of a path."""
    if command in "Zz":
        if text.strip():
            raise UnreadableError(f"{shown(text)} follows its {command}, which takes no numbers")
        return []
    after = whole[end : end + 40]
    if command in "Aa":
        return _arcs(command, text, after)
    found = numbers(text, f"a number of its {command}", after)
    if not found or len(found) % COUNTS[command.lower()]:
        raise _wrong_count(command, text, len(found))
    return found


def _arcs(command: str, text: str, after: str) -> list[float]:
    match = _ARCS.match(text)
    end = match.end() if match else 0
    if end < len(text) or not text.strip() or text.rstrip().endswith(","):
        numbers(text, f"a number of its {command}", after)  # says so, if something is none
        raise _wrong_count(command, text, len(NUMBER.findall(text)))
    made = []
    for arc in _ARC.findall(text):
        rx, ry, *others = (_bounded(float(one), one) for one in arc)
        for size, one in ((rx, arc[0]), (ry, arc[1])):
            if 0.0 < abs(size) < LEAST_RADIUS:
                raise UnreadableError(f"the radius {shown(one)} of its {command} is far too small")
        made += [rx, ry, *others]
    return made


def _wrong_count(command: str, text: str, count: int) -> UnreadableError:
    needed = COUNTS[command.lower()]
    if command in "Aa" and count % needed == 0 and count:
        return UnreadableError(f"the flags of '{command}{shown(text)[1:]} are not 0 or 1")
    times = f"numbers by {needed}" if needed > 1 else "a number"
    return UnreadableError(f"its {command} needs {times}, and has {count}: {shown(command + text)}")


def transform(text: str) -> Matrix:
    """A product of rotations, translations and scalings, by their names in SVG and CSS."""
    if text.strip() == "none":
        return IDENTITY
    made, count, at = IDENTITY, 0, 0
    while match := _FUNCTION.match(text, at):
        if count == MOST_TRANSFORMS:
            raise UnreadableError(f"more than {MOST_TRANSFORMS:,} transforms one after the other")
        made = times(made, _function(match[1], match[2]))
        count, at = count + 1, match.end()
    if text[at:].strip():
        raise UnreadableError(f"{shown(text[at:])} is no transform")
    return made


def times(outer: Matrix, inner: Matrix) -> Matrix:
    """The product of an outer and an inner transform."""
    a, b, c, d, e, f = outer
    g, h, i, j, k, m = inner
    return (
        *(a * g + c * h, b * g + d * h, a * i + c * j, b * i + d * j),
        *(a * k + c * m + e, b * k + d * m + f),
    )


def _function(name: str, text: str) -> Matrix:
    if name not in _FUNCTIONS:
        raise UnreadableError(f"'{name[:24]}' is none of {', '.join(_FUNCTIONS)}")
    counts, first, other, made = _FUNCTIONS[name]
    given = [
        one for one in re.split(r"[\s,]+", re.sub(r"(?<=[^eE\s,(])(?=[-+])", " ", text)) if one
    ]
    if len(given) not in counts:
        wanted = " or ".join(map(str, counts))
        raise UnreadableError(f"{name} needs {wanted} numbers, and has {len(given)}")
    return made(first(given[0]), *map(other, given[1:]))


def _pixels(text: str) -> float:
    made = length(text)
    if text.endswith("%"):
        raise UnreadableError(f"{shown(text)} of what is not known")
    return made.pixels


def _degrees(text: str) -> float:
    match = _LENGTH.fullmatch(text)
    if not match or match[2] not in _ANGLES:
        raise UnreadableError(f"{shown(text)} is no angle")
    return _bounded(float(match[1]) * _ANGLES[match[2]], text)


def _radians(text: str) -> float:
    return math.tau * _degrees(text) / 360.0


def _turned(angle: float, x: float = 0.0, y: float = 0.0) -> Matrix:
    """A rotation about a point."""
    c, s = math.cos(angle), math.sin(angle)
    return c, s, -s, c, s * y - c * x + x, -s * x - c * y + y


_FUNCTIONS: Mapping[
    str,  # how many numbers; how the first and the others are read; what is made of them
    tuple[tuple[int, ...], Callable[[str], float], Callable[[str], float], Callable[..., Matrix]],
] = {
    "matrix": ((6,), number, number, lambda *six: six),
    "translate": ((1, 2), _pixels, _pixels, lambda x, y=0.0: (1.0, 0.0, 0.0, 1.0, x, y)),
    "translateX": ((1,), _pixels, _pixels, lambda x: (1.0, 0.0, 0.0, 1.0, x, 0.0)),
    "translateY": ((1,), _pixels, _pixels, lambda y: (1.0, 0.0, 0.0, 1.0, 0.0, y)),
    "scale": (
        (1, 2),
        number,
        number,
        lambda x, y=None: (x, 0.0, 0.0, x if y is None else y, 0.0, 0.0),
    ),
    "scaleX": ((1,), number, number, lambda x: (x, 0.0, 0.0, 1.0, 0.0, 0.0)),
    "scaleY": ((1,), number, number, lambda y: (1.0, 0.0, 0.0, y, 0.0, 0.0)),
    "rotate": ((1, 3), _radians, _pixels, _turned),
    "skewX": ((1,), _radians, _pixels, lambda a: (1.0, 0.0, math.tan(a), 1.0, 0.0, 0.0)),
    "skewY": ((1,), _radians, _pixels, lambda a: (1.0, math.tan(a), 0.0, 1.0, 0.0, 0.0)),
}


def opacity(text: str) -> float:
    """0 to 1, or a percentage; clipped to that range as in SVG."""
    text = text.strip()
    value = number(text[:-1]) / 100.0 if text.endswith("%") else number(text)
    return min(1.0, max(0.0, value))


def reference(text: str) -> tuple[str, str] | None:
    """The id of `url(#id)` and the fallback after it; None for another paint."""
    match = _URL.fullmatch(text.strip())
    return (match[1], match[2]) if match else None


def paint(text: str) -> Paint:
    """A colour, `none` or CURRENT."""
    word = text.strip().lower()
    if word in ("none", "transparent"):
        return None
    if word == "currentcolor":
        return CURRENT
    if match := re.fullmatch(r"#([0-9a-f]{3,4}|[0-9a-f]{6}|[0-9a-f]{8})", word):
        digits = match[1] if len(match[1]) > 4 else "".join(2 * one for one in match[1])
        return bytes.fromhex(f"{digits:f<8}")
    if word in colours.DIGITS:
        return bytes.fromhex(f"{colours.DIGITS[word]}ff")
    if match := _COLOUR.fullmatch(word):
        return _mixed(match[1], match[2], text)
    raise UnreadableError(f"{shown(text)} is no colour")


def _mixed(kind: str, text: str, whole: str) -> bytes:
    """The values of rgb(...) or hsl(...), separated by commas or blanks."""
    given = [one for one in re.split(r"[\s,/]+", text) if one]
    if len(given) not in (3, 4):
        raise UnreadableError(f"{shown(whole)} is no colour")
    alpha = opacity(given[3]) if len(given) == 4 else 1.0
    if kind == "hsl":
        share = [number(one.rstrip("%")) / 100.0 for one in given[1:3]]
        s, light = (min(1.0, max(0.0, one)) for one in share)
        channels = colorsys.hls_to_rgb(_degrees(given[0]) / 360.0 % 1.0, light, s)
    else:
        scales = [100.0 if one.endswith("%") else 255.0 for one in given[:3]]
        r, g, b = (number(o.rstrip("%")) / s for o, s in zip(given[:3], scales, strict=True))
        channels = (r, g, b)
    return bytes(round(255 * min(1.0, max(0.0, one))) for one in (*channels, alpha))


def mean(paints: list[Paint]) -> bytes:
    """The mean of the values of colours; other paints are ignored."""
    known = [one for one in paints if one]
    if not known:
        return BLACK
    return bytes(round(sum(channel) / len(known)) for channel in zip(*known, strict=True))

"""What stands in the attributes of an SVG drawing: numbers, lengths, paths, transforms, paints.

Each is read by SVG's own grammar and written again in its plainest form, so that the library after
it reads what was understood here. What can't be read is an error that says which part of it.
"""

import colorsys
import math
import re

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
_ARCS = re.compile(
    rf"\s*(?:(?>{_N}){_GAP}(?>{_N}){_GAP}(?>{_N}){_GAP}[01]{_GAP}[01]{_GAP}"
    rf"(?>{_N}){_GAP}(?>{_N}){_GAP})*+",
    re.ASCII,
)
_ARC = re.compile(
    rf"({_N}){_GAP}({_N}){_GAP}({_N}){_GAP}([01]){_GAP}([01]){_GAP}({_N}){_GAP}({_N}){_GAP}",
    re.ASCII,
)
Commands = list[tuple[str, list[float]]]  # the letters of a path, with their numbers
COUNTS = {"m": 2, "l": 2, "h": 1, "v": 1, "c": 6, "s": 4, "q": 4, "t": 2, "a": 7}
_COMMAND = re.compile(r"([MmZzLlHhVvCcSsQqTtAa])([^MmZzLlHhVvCcSsQqTtAa]*)")
_FUNCTION = re.compile(r"[\s,]*([a-zA-Z]+)\s*\(([^()]*)\)")
_COUNTS_OF = {  # of a transform's numbers, and whether they are angles or lengths
    "matrix": ((6,), "n"),
    "translate": ((1, 2), "l"),
    "translateX": ((1,), "l"),
    "translateY": ((1,), "l"),
    "scale": ((1, 2), "n"),
    "scaleX": ((1,), "n"),
    "scaleY": ((1,), "n"),
    "rotate": ((1, 3), "a"),
    "skewX": ((1,), "a"),
    "skewY": ((1,), "a"),
}
_COLOUR = re.compile(r"(rgb|hsl)a?\(([^()]*)\)", re.IGNORECASE)
_URL = re.compile(r"url\(\s*[\"']?#?([^\"')]*)[\"']?\s*\)\s*(.*)", re.DOTALL)


class SvgError(Exception):
    """Why a drawing is not drawn, and what would help."""

    def __init__(self, message: str, cure: str = "") -> None:
        super().__init__(message)
        self.message, self.cure = message, cure


class UnreadableError(Exception):
    """Why an attribute can't be read."""


def shown(text: str) -> str:
    """A text from a file as a message quotes it."""
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


def length(text: str) -> str:
    """A length in pixels, or a percentage of what it is measured by."""
    match = _LENGTH.fullmatch(text.strip())
    if not match:
        raise UnreadableError(f"{shown(text)} is no length")
    if match[2] == "%":
        return f"{number(match[1])!r}%"
    if match[2].lower() not in _UNITS:
        raise UnreadableError(f"the unit of {shown(text)} is none of px, mm, cm, in, pt, pc, %")
    return repr(_bounded(float(match[1]) * _UNITS[match[2].lower()], text))


def size(text: str) -> str:
    """A length that is not negative."""
    made = length(text)
    if made.startswith("-") and float(made.rstrip("%")) < 0.0:
        raise UnreadableError(f"{shown(text)} is negative")
    return made


def size_or_auto(text: str) -> str:
    """A length that is not negative; nothing for `auto`, which is as if it were not said."""
    return "" if text.strip() == "auto" else size(text)


def numbers(text: str, what: str = "a number", after: str = "") -> list[float]:
    """Numbers with blanks or commas between them; `after` is what stands behind the text."""
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
    """The corners of a polygon, as the letters of a path."""
    found = numbers(text)
    if len(found) % 2:
        raise UnreadableError(f"it has {len(found)} numbers, and points have two each")
    return [("M", found)] if found else []


def closed(text: str) -> Commands:
    """The corners of a polygon, and back to the first."""
    made = points(text)
    return [*made, ("Z", [])] if made else []


def view_box(text: str) -> str:
    """Four numbers, the last two of them sizes."""
    found = numbers(text)
    if len(found) != 4:
        raise UnreadableError(f"it has {len(found)} numbers instead of 4")
    if min(found[2:]) < 0.0:
        raise UnreadableError(f"its size is negative: {shown(text)}")
    return _joined(found)


def path(text: str) -> Commands:
    """The data of a path."""
    text = text.strip()
    if not text or text == "none":
        return []
    if text[0] not in "Mm":
        raise UnreadableError(f"it begins with {shown(text[:1])}, not with M")
    parts = _COMMAND.finditer(text)
    return [(part[1], _segment(part[1], part[2], text, part.end())) for part in parts]


def _segment(command: str, text: str, whole: str, end: int) -> list[float]:
    """The numbers of one letter of a path, which end at a place of the whole."""
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


def transform(text: str) -> str:
    """Turns, shifts and scales, in degrees and pixels; the names as SVG or CSS have them."""
    if not text.strip() or text.strip() == "none":
        return ""
    made: list[str] = []
    at = 0
    while match := _FUNCTION.match(text, at):
        if len(made) == MOST_TRANSFORMS:
            raise UnreadableError(f"more than {MOST_TRANSFORMS:,} transforms one after the other")
        made.append(_function(match[1], match[2]))
        at = match.end()
    if text[at:].strip():
        raise UnreadableError(f"{shown(text[at:])} is no transform")
    return " ".join(made)


def _function(name: str, text: str) -> str:
    if name not in _COUNTS_OF:
        raise UnreadableError(f"'{name[:24]}' is none of {', '.join(_COUNTS_OF)}")
    counts, kind = _COUNTS_OF[name]
    given = [
        one for one in re.split(r"[\s,]+", re.sub(r"(?<=[^eE\s,(])(?=[-+])", " ", text)) if one
    ]
    if len(given) not in counts:
        wanted = " or ".join(map(str, counts))
        raise UnreadableError(f"{name} needs {wanted} numbers, and has {len(given)}")
    if kind == "n":
        values = [repr(number(one)) for one in given]
    elif kind == "a":
        values = [_degrees(given[0]), *map(_pixels, given[1:])]
    else:
        values = [_pixels(one) for one in given]
    return f"{name}({', '.join(values)})"


def _pixels(text: str) -> str:
    made = length(text)
    if made.endswith("%"):
        raise UnreadableError(f"{shown(text)} of what is not known")
    return made


def _degrees(text: str) -> str:
    match = _LENGTH.fullmatch(text)
    if not match or match[2] not in _ANGLES:
        raise UnreadableError(f"{shown(text)} is no angle")
    return repr(_bounded(float(match[1]) * _ANGLES[match[2]], text))


def opacity(text: str) -> float:
    """0 to 1, or a percentage; what is beyond is cut off, as SVG has it."""
    text = text.strip()
    value = number(text[:-1]) / 100.0 if text.endswith("%") else number(text)
    return min(1.0, max(0.0, value))


def reference(text: str) -> tuple[str, str] | None:
    """The id of `url(#id)` and what stands behind it; None for another paint."""
    match = _URL.fullmatch(text.strip())
    return (match[1], match[2]) if match else None


def paint(text: str) -> str:
    """A colour as #rrggbbaa, `none` or `currentColor`."""
    word = text.strip().lower()
    if word in ("none", "transparent"):
        return "none"
    if word == "currentcolor":
        return "currentColor"
    if word in colours.DIGITS:
        return f"#{colours.DIGITS[word]}ff"
    if match := re.fullmatch(r"#([0-9a-f]{3,4}|[0-9a-f]{6}|[0-9a-f]{8})", word):
        digits = match[1] if len(match[1]) > 4 else "".join(2 * one for one in match[1])
        return f"#{digits:f<8}"
    if match := _COLOUR.fullmatch(word):
        return _mixed(match[1], match[2], text)
    raise UnreadableError(f"{shown(text)} is no colour")


def _mixed(kind: str, text: str, whole: str) -> str:
    """The values of rgb(...) or hsl(...), with commas or blanks between them."""
    given = [one for one in re.split(r"[\s,/]+", text) if one]
    if len(given) not in (3, 4):
        raise UnreadableError(f"{shown(whole)} is no colour")
    alpha = opacity(given[3]) if len(given) == 4 else 1.0
    if kind == "hsl":
        share = [number(one.rstrip("%")) / 100.0 for one in given[1:3]]
        s, light = (min(1.0, max(0.0, one)) for one in share)
        turned = float(_degrees(given[0])) / 360.0 % 1.0
        channels = colorsys.hls_to_rgb(turned, light, s)
    else:
        scales = [100.0 if one.endswith("%") else 255.0 for one in given[:3]]
        r, g, b = (number(o.rstrip("%")) / s for o, s in zip(given[:3], scales, strict=True))
        channels = (r, g, b)
    return "#" + "".join(
        f"{round(255 * min(1.0, max(0.0, one))):02x}" for one in (*channels, alpha)
    )


def mean(paints: list[str]) -> str:
    """The mean of colours #rrggbbaa, of their values; those that are none of them don't count."""
    known = [bytes.fromhex(one[1:]) for one in paints if one.startswith("#")]
    if not known:
        return "#000000ff"
    return "#" + "".join(
        f"{round(sum(channel) / len(known)):02x}" for channel in zip(*known, strict=True)
    )


def _joined(found: list[float]) -> str:
    return " ".join(map(repr, found))

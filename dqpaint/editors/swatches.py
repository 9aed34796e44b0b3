"""Text of a drawing -> the colours that are written in it; a colour -> how it may be written."""

import colorsys
import re
from collections.abc import Iterator

from dqpaint.diagnostics import Span
from dqpaint.editors.symbols import outline
from dqpaint.language.syntax import Token, lines
from dqpaint.program import colours

Encoded = tuple[float, float, float]
"""sRGB, 0 to 1."""
HEX = re.compile(r"#?([0-9a-fA-F]{6}|[0-9a-fA-F]{3})")


def swatches(text: str) -> Iterator[tuple[Span, Encoded]]:
    """The colours that a text writes: names, hex digits in quotes, hsv of numbers."""
    own = {name.text for name in outline(text).names}
    for line in lines(text):
        tokens = line.tokens
        for i, token in enumerate(tokens):
            if token.kind == "name" and token.text in colours.DIGITS and token.text not in own:
                yield token.span, _from_digits(colours.DIGITS[token.text])
            elif token.kind == "text" and _is_colour(tokens, i):
                found = HEX.fullmatch(token.text)
                if found:
                    yield token.span, _from_digits(found[1])
            elif token.text == "hsv" and (made := _hsv(tokens[i + 1 :])):
                yield Span(token.start, made[0]), made[1]


def _is_colour(tokens: list[Token], i: int) -> bool:
    """Whether a text in quotes stands where a colour is wanted."""
    return i > 0 and tokens[i - 1].text in ("light", "to", "=", "(", ",")


def _from_digits(digits: str) -> Encoded:
    if len(digits) == 3:
        digits = "".join(2 * digit for digit in digits)
    red, green, blue = (int(digits[k : k + 2], 16) / 255 for k in (0, 2, 4))
    return red, green, blue


def _hsv(tokens: list[Token]) -> tuple[int, Encoded] | None:
    """The end and the colour of `(HUE deg)` or `(HUE deg, S, V)`, if all are plain numbers."""
    words = [token.text for token in tokens[:8]]
    if words[:1] != ["("] or ")" not in words:
        return None
    close = words.index(")")
    inner = words[1:close]
    if inner[1:2] != ["deg"] or inner[2::2] != [","] * len(inner[2::2]):
        return None
    try:
        values = [float(inner[0]), *map(float, inner[3::2])]
    except ValueError:
        return None
    if len(values) not in (1, 3):
        return None
    saturation, value = values[1:] or (1.0, 1.0)
    if not (0 <= saturation <= 1 and 0 <= value <= 1):
        return None
    return tokens[close].end, colorsys.hsv_to_rgb(values[0] / 360 % 1, saturation, value)


def written(colour: Encoded) -> list[str]:
    """How a colour may be written: a name that is exactly it, hex digits."""
    digits = "".join(f"{round(255 * part):02x}" for part in colour)
    names = [name for name, known in colours.DIGITS.items() if known == digits]
    return [*names[:1], f'"#{digits}"']

"""Python values -> text of the language, by the types in the tables of words.

Numbers are in SI units and get their unit here; a string is text of the language already.
"""

import math
import re
from collections.abc import Iterator, Sequence
from keyword import iskeyword
from numbers import Real
from typing import Any

from dqpaint.language.syntax.lexer import lines
from dqpaint.language.vocabulary.words import PARTS, STATEMENTS

# The unit of a number, or of each number of a point, by what a part takes.
_UNITS = {
    "place": "m",
    "shift": "m",
    "length": "m",
    "blend": "m",
    "corner": "m",
    "angle": "rad",
    "rotation": "rad",
    "time": "s",
    "speed": "m/s",
    "turnspeed": "rad/s",
    "pitch": "m/rad",
    "strobe": "Hz",
    "number": "",
    "count": "",
    "direction": "",
}
_NAME = re.compile(r"[A-Za-z_][A-Za-z0-9_]*", re.ASCII)


class Unwritable(ValueError):  # noqa: N818  becomes a UsageError with its place
    """A value that cannot be written in the .traj language."""


class Quoted(str):
    """A string that is written in quotes; one without is text of the language."""

    __slots__ = ()


def quoted(text: str) -> Quoted:
    """A string in quotes: a file's name, a font, letters.

    Raises:
        Unwritable: it has a quote or a line's end in it.
    """
    if '"' in text or len(text.splitlines()) > 1:
        raise Unwritable(f"a text has neither quotes nor line ends in it: {text[:40]!r}")
    return Quoted(f'"{text}"')


# Of statements with a form of their own; those of the others follow from their examples.
_FORMS = {
    "let": 'let("r", "70 mm")',
    "curve": 'curve("polar(40 mm, t)", "t", 0, "360 deg")',
    "repeat": 'repeat("i", 1, 5), or d.repeat(5)',
    "def": 'define("star", "r")',
}


def example_as_call(word: str, method: str) -> str:
    """A statement's example as a call: `hold("1 s")`, `line(to="(10, 0) mm")`."""
    if word in _FORMS:
        return _FORMS[word]
    known = STATEMENTS[word]
    given: list[str] = []
    rest = known.example[len(word) :].strip()
    parts = "|".join(re.escape(part) for part in known.parts) or "(?!)"
    head, *pieces = re.split(rf"(?:^|\s)({parts})(?=\s|$)", rest)
    if head.strip():
        text = head.strip()
        given.append(_in_quotes(text))
    for part, value in zip(pieces[::2], pieces[1::2], strict=True):
        name, text = f"{part}_" if iskeyword(part) else part, value.strip()
        given.append(f"{name}={_in_quotes(text)}" if text else f"{name}=True")
    return f"{method}({', '.join(given)})"


def _in_quotes(text: str) -> str:
    """A text of the language as a Python string; a quoted one is a string already."""
    return text if text.startswith('"') else f'"{text}"'


def written_part(word: str, name: str, value: Any) -> Iterator[str]:
    """A part of a statement: its word and value; repeated for a list.

    Raises:
        Unwritable: the statement has no such part, or the value no text.
    """
    known = STATEMENTS[word]
    if name not in known.parts:
        parts = f"its parts are: {', '.join(known.parts)}" if known.parts else "it has none"
        raise Unwritable(f"no part named '{name}'; {parts}")
    takes = PARTS[name].takes
    if takes == "flag":
        if value is not True:
            raise Unwritable(f"'{name}' takes no value: {name}=True")
        yield name
        return
    if isinstance(value, str) and PARTS[name].example.startswith(f'{name} "'):
        value = value if value.startswith('"') else quoted(value)
    for one in _each(value) if name in known.many else [value]:
        try:
            yield f"{name} {_written(one, takes)}"
        except Unwritable as problem:
            example = PARTS[name].example.partition(" ")[2]
            word = f"{name}_" if iskeyword(name) else name
            raise Unwritable(
                f"{name}: {problem}; for example: {word}={_in_quotes(example)}"
            ) from None


def written_head(word: str, values: Sequence[Any]) -> Iterator[str]:
    """The text between a statement's word and its parts.

    Raises:
        Unwritable: too many values, or one without a text.
    """
    head = STATEMENTS[word].head
    if not head and values:
        raise Unwritable("it takes no value without a name")
    match head, list(values):
        case ("let", [name, value]):
            yield f"{_text(name)} = {_written(value, 'number')}"
        case ("formula", [formula, name, lower, upper]):
            yield f"{_text(formula)} for {_from_to(name, lower, upper)}"
        case ("repeat", [name, lower, upper]):
            yield _from_to(name, lower, upper)
        case ("def", [name, *names]) if names:
            yield f"{_text(name)}({', '.join(map(_text, names))})"
        case (_, []):
            if head and word != "place":  # `place auto`, or its parts
                raise Unwritable("a value is missing")
        case (_, [value]):
            yield _single(word, head, value)
        case (_, texts) if _begins_with_text(word) and all(isinstance(t, str) for t in texts):
            yield from (quoted(text) for text in texts)
        case _:
            raise Unwritable(f"{len(values)} values are not what it takes")


def _single(word: str, head: str, value: Any) -> str:
    takes = PARTS[head].takes if head in PARTS else "time" if head == "value" else "number"
    is_name = isinstance(value, str) and _NAME.fullmatch(value)
    in_quotes = _begins_with_text(word) or (head == "robot" and not is_name)
    if isinstance(value, str) and in_quotes:
        return value if value.startswith('"') else quoted(value)
    return _written(value, takes)


def _begins_with_text(word: str) -> bool:
    return STATEMENTS[word].example.startswith(f'{word} "')


def _from_to(name: Any, lower: Any, upper: Any) -> str:
    return f"{_text(name)} from {_written(lower, 'number')} to {_written(upper, 'number')}"


def _each(value: Any) -> list[Any]:
    """The values of a part that may be repeated."""
    if isinstance(value, str | Real):
        return [value]
    try:
        values = list(value)
    except TypeError:
        return [value]
    within = Real | str if isinstance(value, tuple) else Real  # ("2*r", 0) is a point
    return [value] if all(isinstance(one, within) for one in values) else values


def _written(value: Any, takes: str) -> str:
    """A value of the type that a part takes."""
    if isinstance(value, Quoted):
        return value
    if isinstance(value, str):
        return quoted(value) if takes == "light" and value.startswith("#") else _text(value)
    if isinstance(value, Real) and not isinstance(value, bool):
        return _with_unit(_number(value), takes)
    try:
        values = list(value)
    except TypeError:
        raise Unwritable(f"{value!r} has no text in the language") from None
    if takes == "light" and len(values) == 2:
        return " to ".join(_written(one, takes) for one in values)
    if takes in ("rotation", "tool") and len(values) == 4:
        return f"quat({', '.join(map(_number, values))})"
    if takes in ("place", "shift", "direction") and len(values) in (2, 3):
        if any(isinstance(one, str) for one in values):
            return f"({', '.join(_written(one, takes) for one in values)})"
        return _with_unit(f"({', '.join(map(_number, values))})", takes)
    raise Unwritable(f"{value!r} is not what is needed here")


def _with_unit(text: str, takes: str) -> str:
    if takes not in _UNITS:
        raise Unwritable(f"{text} alone does not say it")
    return f"{text} {_UNITS[takes]}".rstrip()


def _number(value: Any) -> str:
    """A number with all its digits, so that reading it back is exact."""
    if not isinstance(value, Real) or not math.isfinite(value):
        raise Unwritable(f"{value!r} is not a finite number")
    size = float(value)
    return str(int(size)) if size.is_integer() and abs(size) < 1e15 else repr(size)


def _text(value: Any) -> str:
    """Text of the language on a single line."""
    if not isinstance(value, str):
        raise Unwritable(f"{value!r} is not text of the language")
    found = list(lines(value))
    whole = len(found) == 1 and found[0].tokens[-1].start == len(value.rstrip())
    if not whole or "\n" in value:
        raise Unwritable(f"{value[:40]!r} is not one piece of a line")
    return value

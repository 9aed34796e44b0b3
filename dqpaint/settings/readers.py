"""A setting as text, number or mapping -> the value that `Settings` holds.

The command line gives texts, Python and settings files may give mappings and numbers as well: each
reader takes them all.
"""

import math
import os
import re
from collections.abc import Mapping, Sequence
from typing import Any, NamedTuple

from dqpaint.core import number_or_text, read_choice
from dqpaint.errors import UsageError

DISTURBANCE = "twist=sine,x=0.02,frequency=2"
SEVERAL = re.compile(r",(?=\s*\w+\s*=)")  # between the gains of one text

Gain = float | tuple[float, ...] | tuple[tuple[float, ...], ...] | str
SHAPES = {"square": (1080, 1080), "portrait": (1080, 1350)}  # [px]
# ISO 216 [mm], the short side first.
PAPER_SIZES = {
    "a2": (420, 594), "a3": (297, 420), "a4": (210, 297), "a5": (148, 210), "a6": (105, 148),
}  # fmt: skip
PAPER = "paper"  # in place of gains: those of the law's paper


def read_path(value: object) -> object:
    """The text of a path; anything else as it is."""
    return os.fspath(value) if isinstance(value, os.PathLike) else value


def read_size(value: object) -> tuple[Any, ...]:
    """Width and height [px] from `1280x720`, `square`, `portrait`, `a3@300dpi` or a pair.

    Paper lies on its long side; `a3-portrait@300dpi` stands. Without dpi it is 300.

    Raises:
        UsageError: anything else.
    """
    if isinstance(value, Sequence) and not isinstance(value, str) and len(value) == 2:
        return tuple(value)
    text = value if isinstance(value, str) else ""
    if text in SHAPES:
        return SHAPES[text]
    if found := re.fullmatch(r"([0-9]{1,6})x([0-9]{1,6})", text):
        return int(found[1]), int(found[2])
    papers = "|".join(PAPER_SIZES)
    if found := re.fullmatch(rf"({papers})(-portrait)?(?:@([0-9]{{1,4}})dpi)?", text):
        dots = int(found[3] or 300) / 25.4
        short, long = (round(dots * side) for side in PAPER_SIZES[found[1]])
        return (short, long) if found[2] else (long, short)
    said = value[:40] if isinstance(value, str) else value
    raise UsageError(
        f"size {said!r} is not WIDTHxHEIGHT in pixels, for example 1280x720, and none of square, "
        f"portrait, a3@300dpi, a3-portrait@300dpi (paper: {', '.join(PAPER_SIZES)})"
    )


def read_gains(value: object) -> dict[str, Any]:
    """Gains by their names, from a mapping or from texts like `k=20`, or the text `paper`.

    Raises:
        UsageError: anything else.
    """
    if isinstance(value, Mapping):
        for name, gain in value.items():
            if isinstance(gain, bool):
                raise UsageError(f"gain '{name}' should be a number, not {str(gain).lower()}")
        return {name: _frozen(gain) for name, gain in value.items()}
    return parse_gains(_texts("gain", value, "k=20"))


def _frozen(gain: Any) -> Any:
    """A list or an array as tuples, a number as it is."""
    gain = gain.tolist() if hasattr(gain, "tolist") else gain
    return tuple(map(_frozen, gain)) if isinstance(gain, list | tuple) else gain


def read_disturbances(value: object) -> dict[str, Any]:
    """Disturbances by their names, from a mapping or from texts like `twist=sine,x=0.02`.

    A mapping may have a list of several of one kind.

    Raises:
        UsageError: anything else.
    """
    if not isinstance(value, Mapping):
        return parse_disturbances(_texts("disturb", value, DISTURBANCE))
    found: dict[str, Any] = {}
    for name, several in value.items():
        for values in several if isinstance(several, list | tuple) else [several]:
            if not isinstance(values, Mapping):
                values = parse_disturbances([f"{name}={values}"])[name]
            add_disturbance(found, name, dict(values))
    return found


class Spread(NamedTuple):
    """How far the set-up of a repetition may be off: standard deviations.

    Attributes:
        posture: of each joint of the start posture [rad].
        place: of the drawing along each axis [m].
    """

    posture: float = 0.0
    place: float = 0.0


USUAL_SPREAD = {"posture": 5.0, "place": 20.0}  # [deg, mm]
LARGEST_SPREAD = {"posture": 45.0, "place": 500.0}


def read_spread(text: str | None) -> Spread:
    """What `posture,place` or `posture=5,place=20` (deg, mm) says; nothing of None.

    Raises:
        UsageError: anything else.
    """
    found: dict[str, float] = {}
    for part in text.split(",") if text is not None else ():
        name, sign, size = (word.strip() for word in part.partition("="))
        try:
            value = float(size) if sign else USUAL_SPREAD[name]
            if name in found or not 0 < value <= LARGEST_SPREAD[name]:
                raise ValueError
        except (KeyError, ValueError):
            raise UsageError(
                f"spread '{str(text)[:40]}' is not of posture and place, each once, such as "
                "posture=5,place=20: deg up to 45, mm up to 500"
            ) from None
        found[name] = value
    return Spread(math.radians(found.get("posture", 0.0)), 1e-3 * found.get("place", 0.0))


def check_spread(value: object) -> object:
    """The text, if it can be read.

    Raises:
        UsageError: it cannot.
    """
    read_spread(value if isinstance(value, str) else str(value))
    return value


def _texts(name: str, value: object, example: str) -> list[str]:
    if isinstance(value, str):
        return [value]
    if isinstance(value, Sequence) and all(isinstance(text, str) for text in value):
        return list(value)
    raise UsageError(f"{name} {value!r} gives no names with values, for example {example}")


def parse_gains(texts: Sequence[str]) -> dict[str, float | str]:
    """Gains by their names from texts like `k=20`; other forms than a number the law reads.

    The text `paper` is a gain of that name and value: the law puts its paper's in its place.

    Raises:
        UsageError: anything else, or a gain given twice.
    """
    gains: dict[str, float | str] = {}
    for text in (part for several in texts for part in SEVERAL.split(several)):
        if text.strip() == PAPER:
            gains[PAPER] = PAPER
            continue
        name, sign, value = (part.strip() for part in text.partition("="))
        if not (name and sign and value):
            raise UsageError(
                f"gain '{text}' is not NAME=VALUE, for example k=20, or k=5..20@10% for a ramp"
            )
        if name in gains:
            raise UsageError(f"gain '{name}' is given twice")
        gains[name] = number_or_text(value)
    return gains


def parse_disturbances(texts: Sequence[str]) -> dict[str, dict[str, float | str]]:
    """Disturbances by their names from texts like `twist=sine,x=0.02` or `twist:form=sine,x=0.02`.

    A value without a name has the name "", a second disturbance of a kind the name `twist-2`.

    Raises:
        UsageError: anything else, or a value given twice.
    """
    found: dict[str, dict[str, float | str]] = {}
    for text in texts:
        name, values = read_choice("disturbance", text, DISTURBANCE)
        if not values:
            raise UsageError(f"disturbance '{text}' is not NAME=VALUE, for example {DISTURBANCE}")
        add_disturbance(found, name, values)
    return found


def add_disturbance(found: dict[str, Any], name: str, values: Any) -> None:
    """Add one to others; a second `twist` is `twist-2`."""
    free = name
    while free in found:
        free = f"{name}-{int(free.removeprefix(f'{name}-')) + 1 if free != name else 2}"
    found[free] = values

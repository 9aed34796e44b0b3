"""Texts like `k=5,10,20` -> axes of values, and settings with one value of each.

k=5,10,20                     a gain of the law
k=1..100:log:9                nine values from 1 to 100, each the same factor apart
k=0..10:6                     six, the same step apart
plant=ideal,compliant(frequency=60)   a choice, by the name of its setting
disturb=none,payload(2)+latency(3)    disturbances, several at once with +
disturb.twist.x=0,0.01        a value of a disturbance
gain.seed=...                 a gain whose name is that of a setting
"""

import math
import re
import sys
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from itertools import product
from os import PathLike, fspath
from pathlib import Path
from typing import Any

import numpy as np

from dqpaint.controllers import find_controller
from dqpaint.disturbances import DISTURBANCES, kind_of
from dqpaint.errors import UsageError
from dqpaint.settings import Settings, make_settings, parse_disturbances, parse_gains

MOST_VALUES = 10_000
LAW = re.compile(r"(?P<name>[^()]+?)(\((?P<gains>[^()]*)\))?")
SPAN = re.compile(r"(?P<low>[^:]+?)\.\.(?P<high>[^:]+?)(:(?P<kind>log|lin))?:(?P<count>\d{1,6})")
UNIT = re.compile(r"(1/s\^2|1/s|s\^2|m/s|rad/s|rad|kg|Hz|m|s|N)(?=$|[ ,])")
NONE = "none"  # no disturbance
NOT_VARIED = ("gains", "width", "height", "view", "ev", "look", "overlay", "exposure")


@dataclass(frozen=True)
class Axis:
    """A thing that is varied, and its values as they were written."""

    name: str
    texts: tuple[str, ...]

    @property
    def numbers(self) -> list[float] | None:
        """The values, if all are numbers."""
        try:
            found = [float(text) for text in self.texts]
        except ValueError:
            return None
        return found if all(map(math.isfinite, found)) else None


def parse_axis(text: str) -> Axis:
    """An axis from `NAME=VALUE,VALUE,...` or `NAME=LOW..HIGH[:log]:COUNT`.

    Raises:
        UsageError: anything else.
    """
    name, sign, values = (part.strip() for part in text.partition("="))
    if not (name and sign and values):
        raise UsageError(f"'{text}' is not NAME=VALUES, for example k=5,10,20 or k=1..100:log:9")
    span = SPAN.fullmatch(values)
    texts = _span(text, span) if span else [value.strip() for value in split_outside(values)]
    if "" in texts:
        raise UsageError(f"'{text}': there is an empty value")
    if len(set(texts)) < len(texts):
        raise UsageError(f"'{text}': a value is there twice")
    return Axis(name, tuple(texts))


def _span(text: str, span: re.Match[str]) -> list[str]:
    try:
        low, high = float(span["low"]), float(span["high"])
    except ValueError:
        raise UsageError(f"'{text}': the ends of a range are numbers, as in 1..100:log:9") from None
    count = int(span["count"])
    if not (2 <= count <= MOST_VALUES and math.isfinite(low) and math.isfinite(high)):
        raise UsageError(f"'{text}': a range has two finite ends and 2 to {MOST_VALUES} values")
    if span["kind"] == "log":
        if min(low, high) <= 0:
            raise UsageError(f"'{text}': both ends of a logarithmic range are above 0")
        values = np.geomspace(low, high, count)
    else:
        values = np.linspace(low, high, count)
    for digits in (4, 7, 17):  # as few as tell them apart: they are what is run, and are written
        texts = [f"{value:.{digits}g}" for value in values.tolist()]
        if len(set(texts)) == count:
            break
    return texts


def split_outside(text: str, sign: str = ",") -> list[str]:
    """What commas part, outside of brackets: `p(k=5),hinf`; a diagonal is written `[1,1,4]`."""
    parts, depth = [""], 0
    for letter in text:
        depth += (letter in "([") - (letter in ")]")
        if letter == sign and depth == 0:
            parts.append("")
        else:
            parts[-1] += letter
    return parts


def parse_texts(name: str, values: object) -> list[str]:
    """The alternatives for a setting, from a list or from a text like `hinf,p(k=5),p(k=20)`.

    Args:
        name: of the setting: controller, plant, robot or disturb.
        values: a text, or several; of laws also functions and classes.

    Raises:
        UsageError: anything else, or one that is empty, there twice or not of its form.
    """
    if callable(values):
        values = [values]
    if isinstance(values, str):
        found = [part.strip() for part in split_outside(values)]
        values = _joined(found) if name == "plant" else found
    if not isinstance(values, Sequence):
        raise UsageError(f"{name}s {values!r} is no list of names")
    texts = [law_text(value) if name == "controller" else value for value in values]
    for text in texts:
        if not isinstance(text, str):
            raise UsageError(f"{name} {text!r} is no name")
    if not texts or "" in texts:
        raise UsageError(f"{name}s {', '.join(texts)!r}: at least one is needed, and none is empty")
    if len(set(texts)) < len(texts):
        raise UsageError(f"{name}s {', '.join(texts)!r}: one is there twice")
    for text in texts if name == "controller" else ():
        split_law(text)
    return texts


def _joined(parts: Sequence[str]) -> list[str]:
    """Parts like `compliant:frequency=60`, `damping=1`: a value belongs to the plant before it."""
    found: list[str] = []
    for part in parts:
        if found and ":" in found[-1] and re.match(r"\w+\s*=", part):
            found[-1] += f",{part}"
        else:
            found.append(part)
    return found


def law_text(law: object) -> str:
    """A law as a text that other processes understand: `mylaw.py:PI` of a function or a class.

    Raises:
        UsageError: it is an object, or does not stand by its name at the top of a file.
    """
    if isinstance(law, str | PathLike):
        return fspath(law)
    name, module = getattr(law, "__name__", ""), sys.modules.get(getattr(law, "__module__", ""))
    file = getattr(module, "__file__", None) or ""
    if not (file.endswith(".py") and getattr(module, name or "-", None) is law):
        raise UsageError(
            f"law {str(law)[:60]} cannot go to the processes that carry out the runs: give a "
            "function or a class at the top of a file, not an object, or name it, as in "
            "'mylaw.py:PI'"
        )
    return f"{_near(file)}:{name}"


def _near(file: str) -> str:
    """A path as seen from the current folder, where that is shorter."""
    path = Path(file).resolve()
    here = Path.cwd()
    return str(path.relative_to(here) if path.is_relative_to(here) else path)


def split_law(text: str) -> tuple[str, dict[str, float | str]]:
    """Name and gains of `p(k=5)`; several gains are parted by commas.

    Raises:
        UsageError: anything else.
    """
    found = LAW.fullmatch(text.strip())
    if found is None:
        raise UsageError(f"law '{text}' is not NAME or NAME(GAIN=VALUE,...), for example p(k=20)")
    gains = re.split(r",(?=\s*\w+\s*=)", found["gains"]) if found["gains"] else []
    return found["name"].strip(), parse_gains(gains)


def combinations(axes: Sequence[Axis]) -> list[dict[str, str]]:
    """Every choice of one value an axis; the last axis runs fastest."""
    names = [axis.name for axis in axes]
    return [dict(zip(names, values, strict=True)) for values in product(*(a.texts for a in axes))]


def with_choice(base: Settings, choice: Mapping[str, str]) -> Settings:
    """Settings with a choice of the axes made.

    Raises:
        UsageError: an unknown name, or a value that is none.
    """
    changed: dict[str, Any] = base.model_dump()
    for name, text in choice.items():
        if name == "controller":
            changed["controller"], gains = split_law(text)
            changed["gains"] = {**changed["gains"], **gains}
        elif name == "plant":
            changed["plant"] = _plain(text, ":")
        elif name == "disturb":
            changed["disturb"] = {**changed["disturb"], **_disturbances(text)}
        elif name.startswith("disturb."):
            _disturb(changed, name, text)
        elif name in Settings.model_fields and name not in NOT_VARIED:
            changed[name] = text
        else:
            value = text[1:-1] if text.startswith("[") and text.endswith("]") else text
            changed["gains"] = {
                **changed["gains"], **parse_gains([f"{name.removeprefix('gain.')}={value}"])
            }  # fmt: skip
    return make_settings(**changed)


def _plain(text: str, sign: str) -> str:
    """`compliant(frequency=60)` as other options have it: `compliant:frequency=60`."""
    found = LAW.fullmatch(text.strip())
    return f"{found['name'].strip()}{sign}{found['gains']}" if found and found["gains"] else text


def _disturbances(text: str) -> dict[str, dict[str, float | str]]:
    """`payload(2)+twist(sine,x=0.02)`, or `none`."""
    if text == NONE:
        return {}
    return parse_disturbances([_plain(part, "=") for part in split_outside(text, "+")])


def axis_description(name: str, base: Settings) -> str:
    """What is varied, its unit first: `1/s, the rate at which a small error decays`; or nothing.

    Args:
        name: of an axis.
        base: whose law has the gain.
    """
    if name.startswith("disturb."):
        _, kind, key = name.split(".")
        fields = DISTURBANCES[kind_of(kind)].model_fields
    else:
        key = name.removeprefix("gain.")
        fields = find_controller(base.controller).gains.model_fields
    return (fields[key].description or "") if key in fields else ""


def axis_label(name: str, base: Settings) -> str:
    """The name of an axis with its unit, if it has one: `k [1/s]`."""
    unit = UNIT.match(axis_description(name, base))
    return f"{name} [{unit[0]}]" if unit else name


def _disturb(changed: dict[str, Any], name: str, text: str) -> None:
    parts = name.split(".")
    if len(parts) != 3 or not all(parts):
        raise UsageError(f"'{name}' is not disturb.NAME.VALUE, for example disturb.twist.x")
    _, kind, key = parts
    try:
        value: float | str = float(text)
    except ValueError:
        value = text
    others = {name: v for name, v in changed["disturb"].items() if name != kind}
    values = {**changed["disturb"].get(kind, {}), key: value}
    # 0 of something that has no other value is how one asks for a run without it
    changed["disturb"] = others if values == {key: 0.0} else {**others, kind: values}

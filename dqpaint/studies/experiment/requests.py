"""Arguments of a study, of the command line or of Python -> axes, base settings, workers.

Both take the same: texts with commas, or lists; one value for several, or several for one.
"""

import math
from collections.abc import Mapping, Sequence
from typing import Any

from dqpaint.errors import UsageError
from dqpaint.painting import validate
from dqpaint.settings import DEFAULT_CONTROLLER, Settings, read_choices
from dqpaint.studies.experiment.axes import (
    Axis,
    law_text,
    parse_axis,
    parse_texts,
    split_law,
    with_choice,
)
from dqpaint.studies.runner.engine import Workers

Vary = str | Sequence[str] | Mapping[str, Any]


def read_comparison(
    choices: Mapping[str, Any], several: Mapping[str, Any], **usual: Any
) -> tuple[list[Axis], Settings]:
    """The axes of a comparison, and what all its runs have in common.

    Args:
        choices: settings by their names in Python, with a file of them as `settings`.
        several: alternatives by the names of their settings; None where there are none.
        usual: settings that hold where nothing else is said.

    Raises:
        DqpaintError: a choice or a file is at fault.
    """
    axes, base = _split(choices, several, usual)
    if not any(axis.name == "controller" for axis in axes):
        axes.insert(0, Axis("controller", (base.controller,)))
    return axes, base


def read_sweep(
    vary: Vary, choices: Mapping[str, Any], several: Mapping[str, Any]
) -> tuple[list[Axis], Settings]:
    """The axes of a sweep, and what all its runs have in common; arguments as of `read_comparison`.

    Args:
        vary: axes as texts like "k=5,10", or values by names.
        choices: settings by their names in Python, with a file of them as `settings`.
        several: alternatives by the names of their settings; one alone is no axis.

    Raises:
        DqpaintError: a choice or a file is at fault.
    """
    more, base = _split(choices, several, {})
    alone = {axis.name: axis.texts[0] for axis in more if len(axis.texts) == 1}
    axes = [parse_axis(text) for text in vary_texts(vary)]
    return axes + [axis for axis in more if axis.name not in alone], with_choice(base, alone)


def vary_texts(vary: Vary, span: bool = False) -> list[str]:
    """Axes as texts like `k=5,10`, from texts or from values by names.

    Args:
        vary: what is varied.
        span: whether a pair of numbers are the ends of a range.

    Raises:
        UsageError: anything else.
    """
    if isinstance(vary, str):
        return [vary]
    if not isinstance(vary, Mapping):
        if isinstance(vary, Sequence) and all(isinstance(text, str) for text in vary):
            return list(vary)
        raise UsageError(f"vary {vary!r} is not 'k=5,10,20', a list of these, or {{'k': [5, 10]}}")
    found = []
    for name, values in vary.items():
        if isinstance(values, str):
            found.append(f"{name}={values}")
        elif not isinstance(values, Sequence) and not hasattr(values, "tolist"):
            raise UsageError(f"vary {name!r}: {values!r} is not a list of values")
        else:
            listed = values.tolist() if hasattr(values, "tolist") else list(values)
            if name == "controller":
                listed = [law_text(value) for value in listed]
            between = ".." if span else ","
            found.append(f"{name}={between.join(str(value) for value in listed)}")
    return found


def workers(jobs: int | None, cluster: str | None) -> Workers:
    """How many processes, or a cluster's address.

    Raises:
        UsageError: both.
    """
    if jobs is not None and cluster is not None:
        raise UsageError("--jobs is how many processes here, --cluster asks others: not both")
    return jobs if cluster is None else cluster


def named_law(choices: Mapping[str, Any]) -> dict[str, Any]:
    """Choices with a law that is a function or a class as a text: runs go to other processes.

    Raises:
        UsageError: a law that other processes cannot find.
    """
    law = choices.get("controller")
    return {**choices, "controller": law_text(law)} if callable(law) else dict(choices)


def _split(
    choices: Mapping[str, Any], several: Mapping[str, Any], usual: Mapping[str, Any]
) -> tuple[list[Axis], Settings]:
    """Axes of several values, and the settings that all have in common."""
    given = dict(several)
    said = named_law(choices)
    for name in ("controller", "plant", "robot"):  # several disturbances are one choice
        if isinstance(said.get(name), list | tuple) and given.get(name) is None:
            given[name] = said.pop(name)
    texts = {
        name: parse_texts(name, values) for name, values in given.items() if values is not None
    }
    for name in texts.keys() & said.keys() - {"disturb"}:
        raise UsageError(f"give {name} or {name}s, not both")
    base = validate.settings_of_choices(said, **usual)
    if "controller" in texts:
        file = validate.settings_file(said.get("settings")).choices
        if of_file := file.get("gains"):
            texts["controller"] = [
                _with_gains(law, file.get("controller", DEFAULT_CONTROLLER), of_file)
                for law in texts["controller"]
            ]
        typed = read_choices(said).get("gains", {})
        base = base.model_copy(update={"controller": DEFAULT_CONTROLLER, "gains": typed})
    return [Axis(name, tuple(values)) for name, values in texts.items()], base


def _with_gains(text: str, law: str, gains: Mapping[str, Any]) -> str:
    """A law as it is written, with the gains that a file of settings has for it."""
    name, own = split_law(text)
    if name != law:
        return text
    both = {**gains, **own}.items()
    said = (f"{n}={','.join(map(str, v)) if isinstance(v, tuple) else v}" for n, v in both)
    return f"{name}({','.join(said)})"


def read_span(text: str | None) -> tuple[float, float] | None:
    """The ends of a stretch of time [s], from `0..0.5`; None of None.

    Raises:
        UsageError: anything else.
    """
    if text is None:
        return None
    try:
        low, high = (float(end) for end in text.split(".."))
        if not 0 <= low < high < math.inf:
            raise ValueError
    except ValueError:
        said = "is not A..B in seconds, the earlier first, for example 0..0.5"
        raise UsageError(f"span '{text[:40]}' {said}") from None
    return low, high

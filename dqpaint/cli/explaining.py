"""The name of a registered thing -> its explanation: equation, idea, values, what to try."""

import shutil
import textwrap
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Any

from dqpaint.cli.listing import value_line
from dqpaint.core import Sections, read_sections, tables, unicode_equation, unicode_prose

WIDEST = 100
NEEDED = {
    "law": ("equation", "idea", "error", "stable", "fails", "try"),
    "plant": ("equation", "idea", "fails", "try"),
    "disturbance": ("equation", "idea", "fails", "try"),
    "metric": ("equation", "idea", "try"),
    "profile": ("equation", "idea", "try"),
}
"""What the explanation of each kind has."""


@dataclass(frozen=True)
class Explained:
    """A thing with its explanation.

    Attributes:
        kind: such as `law`.
        name: as it is chosen by.
        sections: of its docstring.
        values: its gains or values, as `dqpaint.cli.listing` has them.
        source: a paper and its equation; empty where there is none.
    """

    kind: str
    name: str
    sections: Sections
    values: tuple[dict[str, Any], ...] = ()
    source: str = ""


def _fields(model: Any) -> tuple[dict[str, Any], ...]:
    fields = model.model_fields.items() if model else ()
    return tuple({"name": n, "default": f.default, "about": f.description} for n, f in fields)


def _law(name: str) -> Explained:
    from dqpaint.controllers import find_controller

    law = find_controller(name)
    paper = ", ".join(f"{gain} = {value}" for gain, value in law.paper.items())
    source = law.source + (f"; --gain paper: {paper} ({law.paper_source})" if paper else "")
    return Explained("law", name, read_sections(law.docstring), _fields(law.gains), source)


def _plant(name: str) -> Explained:
    from dqpaint.plants import PLANTS

    plant: Any = PLANTS[name]
    return Explained("plant", name, read_sections(plant.__doc__), _fields(plant.options))


def _disturbance(name: str) -> Explained:
    from dqpaint.disturbances import DISTURBANCES

    model = DISTURBANCES[name]
    return Explained("disturbance", name, read_sections(model.__doc__), _fields(model))


def _metric(name: str) -> Explained:
    from dqpaint.metrics import METRICS

    one = METRICS[name]
    about = {"idea": f"{one.meaning[:1].upper()}{one.meaning[1:]}."}
    title = f"{one.title} [{one.unit}]" if one.unit else one.title
    equations = tuple(one.equation.splitlines())
    return Explained("metric", name, Sections(title, equations, about, (one.example,)))


def _profile(name: str) -> Explained:
    from dqpaint.motion import PROFILES

    return Explained("profile", name, read_sections(PROFILES[name].__doc__))


def _names() -> dict[str, Mapping[str, Any]]:
    from dqpaint.controllers import CONTROLLERS
    from dqpaint.disturbances import DISTURBANCES
    from dqpaint.metrics import METRICS
    from dqpaint.motion import PROFILES
    from dqpaint.plants import PLANTS

    return {
        "law": CONTROLLERS, "plant": PLANTS, "disturbance": DISTURBANCES, "metric": METRICS,
        "profile": PROFILES,
    }  # fmt: skip


READERS: dict[str, Callable[[str], Explained]] = {
    "law": _law,
    "plant": _plant,
    "disturbance": _disturbance,
    "metric": _metric,
    "profile": _profile,
}


def explained(name: str) -> list[Explained]:
    """The things of a name: one, or several of different kinds; a law may be `FILE.py[:NAME]`."""
    if ".py" in name:
        return [_law(name)]
    return [READERS[kind](name) for kind, known in _names().items() if name in known]


def all_explained(kind: str) -> list[Explained]:
    """Everything of a kind."""
    return [READERS[kind](name) for name in _names()[kind]]


def names() -> list[str]:
    """Every name that can be explained."""
    return [name for known in _names().values() for name in known]


def list_names() -> str:
    """The names by kind, wrapped."""
    rows = [(f"{kind}s", ", ".join(known)) for kind, known in _names().items()]
    return _laid_out(rows)


def format_explained(one: Explained) -> str:
    """An explanation as text for a terminal."""
    sections = one.sections
    summary = sections.summary.rstrip(".")
    rows = [(label, unicode_prose(text)) for label, text in sections.texts.items()]
    heading = "gains" if one.kind == "law" else "values"
    for i, value in enumerate(one.values):
        rows.append(("" if i else heading, value_line(value)))
    rows += [("source", one.source)] if one.source else []
    rows += [("" if i else "try", command) for i, command in enumerate(sections.try_)]
    head = textwrap.wrap(f"{one.name} ({one.kind}): {unicode_prose(summary)}.", _width())
    equations = [f"    {unicode_equation(equation)}" for equation in sections.equations]
    return "\n".join([*head, "", *equations, *([""] if equations else []), _laid_out(rows)])


def _width() -> int:
    return min(WIDEST, shutil.get_terminal_size((WIDEST, 24)).columns)


def _laid_out(rows: list[tuple[str, str]]) -> str:
    """Labels and texts in two columns, the texts wrapped but for commands."""
    label_width = max(len(label) for label, _ in rows) + 4
    lines: list[tuple[str, str]] = []
    for label, text in rows:
        is_command = text.startswith(("dqpaint ", "echo "))
        wrapped = [text] if is_command else textwrap.wrap(text, max(20, _width() - label_width))
        lines += [(label if i == 0 else "", line) for i, line in enumerate(wrapped or [""])]
    return "\n".join(f"  {line}".rstrip() for line in tables.align(lines))

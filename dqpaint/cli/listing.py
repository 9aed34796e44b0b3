"""Registries and cards -> lists of what options can name, and of statements and functions."""

import shutil
from collections.abc import Callable
from typing import TYPE_CHECKING, Any

from dqpaint.cli.terminal import table
from dqpaint.core import Registry, tables
from dqpaint.errors import UnknownNameError

if TYPE_CHECKING:
    from dqpaint.metrics import Column


def _robots() -> list[dict[str, Any]]:
    from dqpaint.robots.loading import find_card, plugin_cards
    from dqpaint.robots.model import DEFAULT_ROBOT, card_names, read_card

    brought = plugin_cards()
    cards = [read_card(name) for name in card_names()]
    cards += [find_card(name) for name in brought]
    return [
        {
            "name": c.name,
            "about": f"{c.title}, {c.joints} joints, motors (plant servo) {c.motors}"
            + (f" (not installed: {c.missing})" if c.missing else ""),
            "missing": c.missing,
            "motors": c.motors,
            "default": c.name == DEFAULT_ROBOT,
            "source": c.source,
            **({"package": brought[c.name][1]} if c.name in brought else {}),
        }
        for c in cards
    ]


def _controllers() -> list[dict[str, Any]]:
    from dqpaint.controllers import CONTROLLERS
    from dqpaint.settings import DEFAULT_CONTROLLER

    return [
        {
            "name": c.name,
            "about": c.summary,
            "default": c.name == DEFAULT_CONTROLLER,
            "source": c.source,
            "gains": [
                {"name": gain, "default": f.default, "about": f.description}
                for gain, f in c.gains.model_fields.items()
            ],
            **_package(CONTROLLERS, name),
        }
        for name, c in CONTROLLERS.items()
    ]


def _plants() -> list[dict[str, Any]]:
    from dqpaint.plants import DEFAULT_PLANTS, PLANTS

    return [
        {
            "name": name,
            "about": _about(plant),
            "default": name == DEFAULT_PLANTS["rates"],
            "takes": plant.takes,
            "values": _values(plant.options) if plant.options else [],
            **_package(PLANTS, name),
        }
        for name, plant in PLANTS.items()
    ]


def _fonts() -> list[dict[str, Any]]:
    from dqpaint.language.imports import lettering

    return [
        {
            "name": name,
            "about": lettering.read_font(name).about,
            "default": name == lettering.PLAINEST,
        }
        for name in lettering.font_names()
    ]


def _disturbances() -> list[dict[str, Any]]:
    from dqpaint.disturbances import DISTURBANCES

    return [
        {
            "name": name,
            "about": _about(model),
            "values": _values(model),
            **_package(DISTURBANCES, name),
        }
        for name, model in DISTURBANCES.items()
    ]


def _about(thing: object) -> str:
    """The first line of a docstring; that of a plugin may be missing."""
    return next(iter((thing.__doc__ or "").splitlines()), "")


def _package(registry: Registry[Any], name: str) -> dict[str, str]:
    """The package that an entry comes from, where it is not built in."""
    package = registry.origin(name)
    return {"package": package} if package else {}


def _values(model: Any) -> list[dict[str, Any]]:
    return [
        {"name": name, "default": f.default, "about": f.description}
        for name, f in model.model_fields.items()
    ]


def _null() -> list[dict[str, Any]]:
    from dqpaint.robots.kinematics import DEFAULT_OBJECTIVE, OBJECTIVES

    return [
        {
            "name": name,
            "about": _about(objective),
            "default": name == DEFAULT_OBJECTIVE,
            "values": [{"name": "gain", "default": objective.default_gain, "about": objective.unit}]
            if objective.default_gain
            else [],
        }
        for name, objective in OBJECTIVES.items()
    ]


def _resolvers() -> list[dict[str, Any]]:
    from dqpaint.robots.resolvers import DEFAULT_RESOLVER, RESOLVERS

    return [
        {
            "name": name,
            "about": _about(resolver),
            "default": name == DEFAULT_RESOLVER,
            "values": _values(resolver.options),
        }
        for name, resolver in RESOLVERS.items()
    ]


def _tasks() -> list[dict[str, Any]]:
    from dqpaint.robots.model import TASKS

    return [
        {"name": name, "about": task.about, "default": name == "pose"}
        for name, task in TASKS.items()
    ]


def _brushes() -> list[dict[str, Any]]:
    from dqpaint.brushes import BRUSHES, describe_fields

    return [
        {
            "name": name,
            "about": _about(kind),
            "choices": describe_fields(kind),
            **_package(BRUSHES, name),
        }
        for name, kind in BRUSHES.items()
    ]


def _columns() -> list[dict[str, Any]]:
    from dqpaint.metrics import METRICS, all_columns

    def about(one: "Column") -> str:
        colour = f" (--colour-by {one.colour_by})" if one.colour_by else ""
        return f"{one.meaning}{colour}{' (in --save motion)' if one.motion_only else ''}"

    return [
        {
            "name": one.headers,
            "about": about(one),
            "unit": one.unit,
            "colour_by": one.colour_by,
            **_package(METRICS, one.name),
        }
        for one in all_columns()
    ]


def _figures() -> list[dict[str, Any]]:
    from dqpaint.metrics import METRICS, all_figures

    return [
        {
            "name": name,
            "about": f"{one.title}: {one.meaning}",
            "unit": one.unit,
            "kind": one.kind,
            **_package(METRICS, name),
        }
        for name, one in all_figures().items()
    ]


def _looks() -> list[dict[str, Any]]:
    from dqpaint.light.film import LOOKS
    from dqpaint.settings import Settings

    usual = Settings.model_fields["look"].default
    return [
        {"name": name, "about": _about(look), "default": name == usual}
        for name, look in LOOKS.items()
    ]


def _formats() -> list[dict[str, Any]]:
    from dqpaint.outputs import WRITERS

    return [
        {
            "name": name,
            "about": one.about,
            "file": f"NAME{one.ending}",
            "needs": [need.words for need in one.needs],
            "export": one.export_name,
            **_package(WRITERS, name),
        }
        for name, one in WRITERS.items()
    ]


def _examples() -> list[dict[str, Any]]:
    from dqpaint.core import example_names, examples_folder

    def about(name: str) -> str:
        first = (examples_folder() / f"{name}.traj").read_text("utf-8").splitlines()[0]
        return first.removeprefix(f"# {name}.traj - ")

    return [{"name": name, "about": about(name)} for name in example_names()]


def _studies() -> list[dict[str, Any]]:
    from dqpaint.studies.declared import STUDIES, Study

    return [
        {
            "name": name,
            "about": _about(study),
            "values": [
                {"name": one.name, "default": one.default, "about": one.option.help}
                for one in study.parameters()
                if one.field not in Study.model_fields
            ],
            **_package(STUDIES, name),
        }
        for name, study in STUDIES.items()
    ]


def _replays() -> list[dict[str, Any]]:
    from dqpaint.studies.replay import papers

    every = [papers.read_paper(name) for name in papers.paper_names()]
    return [{"name": p.name, "about": f"{p.source}: {p.title}", "source": p.source} for p in every]


def _statements() -> list[dict[str, Any]]:
    from dqpaint.language.vocabulary import STATEMENTS

    return [
        {"name": s.word, "about": s.meaning, "example": s.example, "parts": list(s.parts)}
        for s in STATEMENTS.values()
    ]


def _functions() -> list[dict[str, Any]]:
    from dqpaint.editors import vocabulary

    kinds = ("function", "law", "constant", "unit")
    return [
        {"name": e.example, "about": e.meaning} for e in vocabulary.vocabulary() if e.kind in kinds
    ]


LISTS: dict[str, Callable[[], list[dict[str, Any]]]] = {
    "robots": _robots,
    "controllers": _controllers,
    "plants": _plants,
    "disturbances": _disturbances,
    "null": _null,
    "resolvers": _resolvers,
    "tasks": _tasks,
    "brushes": _brushes,
    "looks": _looks,
    "columns": _columns,
    "figures": _figures,
    "fonts": _fonts,
    "formats": _formats,
    "examples": _examples,
    "studies": _studies,
    "replays": _replays,
    "statements": _statements,
    "functions": _functions,
}


def lists(what: str) -> dict[str, list[dict[str, Any]]]:
    """The entries of one list by its name, or of `all`.

    Raises:
        UnknownNameError: no such list.
    """
    if what == "all":
        return {name: make() for name, make in LISTS.items()}
    if what not in LISTS:
        raise UnknownNameError("list", what, list(LISTS))
    return {what: LISTS[what]()}


def faults(what: str) -> list[str]:
    """The errors of the plugins of a list, or of `all`: a sentence each."""
    from dqpaint.brushes import BRUSHES
    from dqpaint.controllers import CONTROLLERS
    from dqpaint.disturbances import DISTURBANCES
    from dqpaint.metrics import METRICS
    from dqpaint.outputs import WRITERS
    from dqpaint.plants import PLANTS
    from dqpaint.robots.loading import CARD_FOLDERS
    from dqpaint.studies.declared import STUDIES

    registries: dict[str, Registry[Any]] = {
        "robots": CARD_FOLDERS, "controllers": CONTROLLERS, "plants": PLANTS,
        "disturbances": DISTURBANCES, "brushes": BRUSHES, "formats": WRITERS,
        "columns": METRICS, "figures": METRICS,
        "studies": STUDIES,
    }  # fmt: skip
    asked = registries if what == "all" else {what} & registries.keys()
    return list(dict.fromkeys(fault for name in asked for fault in registries[name].faults))


def text(found: dict[str, list[dict[str, Any]]]) -> str:
    """Entries as text: a line each, its values and details below."""
    parts = []
    for name, rows in found.items():
        lines: list[tuple[str, str]] = []
        for row in rows:
            usual = " (default)" if row.get("default") else ""
            package = f" (from {row['package']})" if "package" in row else ""
            lines.append((row["name"] + usual, row["about"] + package))
            lines += [("", f"  {choice}") for choice in row.get("choices", [])]
            numbers = [*row.get("gains", []), *row.get("values", [])]
            lines += [("", f"  {value_line(number)}") for number in numbers]
            if "example" in row:
                lines.append(("", f"  {row['example']}"))
            if row.get("parts"):
                lines.append(("", f"  parts: {' '.join(row['parts'])}"))
            if "file" in row:
                lines.append(("", f"  {row['file']}"))
            if row.get("needs"):
                lines.append(("", f"  needs {'; '.join(row['needs'])}"))
            if row.get("export"):
                lines.append(("", f"  dqpaint export --format {row['export']}"))
            if "gains" in row:
                lines.append(("", f"  from {row['source']}"))
        heading = [f"{name}:"] if len(found) > 1 else []
        parts.append("\n".join([*heading, table(lines)]))
    return "\n\n".join(parts)


WORDS_OF_LISTS = {
    "robots": "arms",
    "controllers": "control laws",
    "null": "secondary tasks",
    "columns": "of a run's CSV",
    "figures": "of a run's summary",
    "formats": "of files",
    "examples": "drawings",
    "replays": "of papers",
    "statements": "of the language",
    "functions": "of the language",
}


def overview(found: dict[str, list[dict[str, Any]]]) -> str:
    """A line a list: how many there are and the first names, as many as fit."""
    heads = [
        (name, f"{len(rows)} {WORDS_OF_LISTS[name]}" if name in WORDS_OF_LISTS else str(len(rows)))
        for name, rows in found.items()
    ]
    aligned = tables.align(heads)
    room = min(OVERVIEW, shutil.get_terminal_size().columns) - max(map(len, aligned)) - 4
    lines = []
    for head, rows in zip(aligned, found.values(), strict=True):
        names = sorted((row["name"] for row in rows), key=lambda n: n not in _defaults(rows))
        lines.append(f"  {head:<{max(map(len, aligned))}}  {_fitting(names, room)}")
    return "\n".join(
        [
            *lines,
            "",
            "  dqpaint list NAME      shows one list; dqpaint list all, all",
            "  dqpaint explain NAME   explains a law, plant, disturbance or figure",
        ]
    )


OVERVIEW = 100  # columns


def _defaults(rows: list[dict[str, Any]]) -> list[str]:
    return [row["name"] for row in rows if row.get("default")]


def _fitting(names: list[str], room: int) -> str:
    """The first names with commas, as many as there is room for, and how many more there are."""
    for count in range(len(names), 0, -1):
        more = f" and {len(names) - count} more" if count < len(names) else ""
        said = ", ".join(names[:count]) + more
        if len(said) <= room:
            return said
    return ""


def value_line(value: dict[str, Any]) -> str:
    """A gain, or a value of a disturbance, in words."""
    usual = value["default"]
    if usual is None:
        return f"{value['name']}  {value['about']}"
    shown = f"{usual:g}" if isinstance(usual, float) else usual
    return f"{value['name']} = {shown}  {value['about']}"

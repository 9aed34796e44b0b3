"""What there is to choose from, read off the registries."""

from collections.abc import Callable, Sequence
from typing import Any

from dqpaint.errors import UnknownNameError
from dqpaint.terminal import table


def _robots() -> list[dict[str, Any]]:
    from dqpaint.robots.card import card_names, read_card

    cards = [read_card(name) for name in card_names()]
    return [
        {"name": c.name, "about": f"{c.title}, {c.joints} joints", "source": c.source}
        for c in cards
    ]


def _controllers() -> list[dict[str, Any]]:
    from dqpaint.controllers import CONTROLLERS

    return [
        {"name": c.name, "about": c.summary, "source": c.source, "gains": c.list_gains()}
        for c in CONTROLLERS.values()
    ]


def _plants() -> list[dict[str, Any]]:
    from dqpaint.plants import PLANTS

    return [
        {"name": name, "about": (plant.__doc__ or "").splitlines()[0]}
        for name, plant in PLANTS.items()
    ]


def _examples() -> list[dict[str, Any]]:
    from dqpaint.examples import example_names, examples_folder

    def about(name: str) -> str:
        first = (examples_folder() / f"{name}.traj").read_text("utf-8").splitlines()[0]
        return first.removeprefix(f"# {name}.traj - ")

    return [{"name": name, "about": about(name)} for name in example_names()]


LISTS: dict[str, Callable[[], list[dict[str, Any]]]] = {
    "robots": _robots,
    "controllers": _controllers,
    "plants": _plants,
    "examples": _examples,
}


def entries(what: str) -> list[dict[str, Any]]:
    """The entries of one list.

    Raises:
        UnknownNameError: no such list.
    """
    if what not in LISTS:
        raise UnknownNameError("list", what, list(LISTS))
    return LISTS[what]()


def text(rows: Sequence[dict[str, Any]]) -> str:
    """Entries as a person reads them: a line each, what belongs to it below."""
    lines: list[tuple[str, str]] = []
    for row in rows:
        lines.append((row["name"], row["about"]))
        if "gains" in row:
            lines += [("", f"gains: {row['gains']}"), ("", f"from:  {row['source']}")]
    return table(lines)

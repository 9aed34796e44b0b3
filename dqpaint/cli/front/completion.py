"""What is typed so far -> what may follow, for the Tab key of a shell.

A completer is called by a shell alone, and imports what it lists then: no other start pays for it.
"""

from collections.abc import Callable, Iterable, Sequence
from pathlib import Path
from typing import Any

Completer = Callable[[str], list[str]]
NOT_DRAWINGS_AHEAD = 200  # entries of a folder that are looked at


def drawings(incomplete: str) -> list[str]:
    """Examples, and drawings and folders beneath what is typed."""
    from dqpaint.core import example_names

    folder, _, begun = incomplete.rpartition("/")
    here = Path(folder) if folder else Path("/" if incomplete.startswith("/") else ".")
    try:
        found = sorted(here.iterdir())[:NOT_DRAWINGS_AHEAD]
    except OSError:
        found = []
    lead = incomplete[: len(incomplete) - len(begun)]
    paths = [
        f"{lead}{one.name}{'/' if one.is_dir() else ''}"
        for one in found
        if not one.name.startswith(".") and (one.suffix == ".traj" or one.is_dir())
    ]
    return _begun([*paths, *([] if lead else example_names())], incomplete)


def robots(incomplete: str) -> list[str]:
    """The arms that have a card."""
    from dqpaint.robots.loading import plugin_cards
    from dqpaint.robots.model import card_names

    return _begun([*card_names(), *plugin_cards()], incomplete)


def laws(incomplete: str) -> list[str]:
    """The control laws."""
    from dqpaint.controllers import CONTROLLERS

    return _begun(CONTROLLERS, incomplete)


def plants(incomplete: str) -> list[str]:
    """The plants."""
    from dqpaint.plants import PLANTS

    return _begun(PLANTS, incomplete)


def disturbances(incomplete: str) -> list[str]:
    """The disturbances, each ready for its values."""
    from dqpaint.disturbances import DISTURBANCES

    return _begun([f"{name}=" for name in DISTURBANCES], incomplete)


def brushes(incomplete: str) -> list[str]:
    """The brushes."""
    from dqpaint.brushes import BRUSHES

    return _begun(BRUSHES, incomplete)


def looks(incomplete: str) -> list[str]:
    """The looks."""
    from dqpaint.light.film import LOOKS

    return _begun(LOOKS, incomplete)


def null_space(incomplete: str) -> list[str]:
    """The secondary tasks."""
    from dqpaint.robots.kinematics import OBJECTIVES

    return _begun(OBJECTIVES, incomplete)


def formats(incomplete: str) -> list[str]:
    """The formats of `draw --save`, after the last comma."""
    from dqpaint.outputs import WRITERS

    return _after_commas(list(WRITERS), incomplete)


def lists(incomplete: str) -> list[str]:
    """The lists of `dqpaint list`."""
    from dqpaint.cli.listing import LISTS

    return _begun([*LISTS, "all"], incomplete)


def explained(incomplete: str) -> list[str]:
    """What `dqpaint explain` explains: names, and codes of messages."""
    from dqpaint.cli.explaining import names
    from dqpaint.diagnostics import catalogue

    return _begun([*names(), *catalogue.codes()], incomplete)


def several(completer: Completer) -> Completer:
    """The same, for names with commas between."""

    def complete(incomplete: str) -> list[str]:
        return _after_commas(completer(""), incomplete)

    return complete


def one_of(*names: str) -> Completer:
    """A completer of fixed names."""

    def complete(incomplete: str) -> list[str]:
        return _begun(names, incomplete)

    return complete


OF_SETTINGS: dict[str, Completer] = {
    "controller": laws,
    "controllers": several(laws),
    "robot": robots,
    "robots": several(robots),
    "plant": plants,
    "plants": several(plants),
    "disturb": disturbances,
    "brush": brushes,
    "look": looks,
    "null": null_space,
    "from": one_of("first", "home"),
    "on-limit": one_of("clip", "slow", "stop"),
    "view": one_of("front", "iso", "side", "top", "stereo", "orbit"),
    "place": one_of("auto"),
}


def of_setting(name: str) -> Completer | None:
    """The completer of a setting's option; None where any text may follow."""
    return OF_SETTINGS.get(name)


def _begun(names: Iterable[Any], incomplete: str) -> list[str]:
    return [str(name) for name in names if str(name).startswith(incomplete)]


def _after_commas(names: Sequence[str], incomplete: str) -> list[str]:
    before, comma, begun = incomplete.rpartition(",")
    said = before.split(",")
    return [f"{before}{comma}{name}" for name in _begun(names, begun) if name not in said]

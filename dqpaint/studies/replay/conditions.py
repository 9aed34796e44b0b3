"""Settings of a replay's cells -> under what they ran, in words: arm, plant, start, inverse."""

from collections.abc import Mapping
from typing import Any

from dqpaint.controllers import find_controller
from dqpaint.robots.kinematics import read_null
from dqpaint.robots.loading import find_card
from dqpaint.robots.model import DEFAULT_ROBOT
from dqpaint.settings import SETTINGS, Settings
from dqpaint.studies.replay.papers import Paper

SAID = ("robot", "plant", "start", "null", "resolver", "on_limit", "disturb")
"""Settings that a condition names; a paper states them, or they are assumed."""


def condition(settings: Settings) -> str:
    """Arm, plant, start, null space, pseudo-inverse, limits and disturbances in a line."""
    robot = settings.robot or DEFAULT_ROBOT
    title = robot if "." in robot else f"{find_card(robot).title} ({robot})"
    usual = "torque" if find_controller(settings.controller).drives_torque else "stiff"
    task, gain = read_null(settings.null)
    parts = [
        title,
        f"plant {settings.plant or usual}",
        f"from {settings.start}",
        "no null-space task" if task == "none" else f"null-space task {task}, gain {gain:g}",
        {None: "resolver filter", "none": "plain pseudo-inverse"}.get(
            settings.resolver, f"resolver {settings.resolver}"
        ),
        *([f"on limit {settings.on_limit}"] if settings.on_limit != "clip" else []),
    ]
    for name, values in settings.disturb.items():
        told = ", ".join(f"{key} = {value}" for key, value in values.items())
        parts.append(f"{name} ({told}), invented")
    return ", ".join(parts if settings.disturb else [*parts, "no disturbance"])


def conditions(cells: Mapping[str, Settings], groups: Mapping[str, str]) -> list[str]:
    """A line for each condition under which some cells ran; which cells, if there are several.

    Args:
        cells: their settings, by name.
        groups: the group of a cell, by its name; "" is none.
    """
    found: dict[str, list[str]] = {}
    for name, settings in cells.items():
        found.setdefault(condition(settings), []).append(name)
    if len(found) == 1:
        return list(found)
    return [f"{_together(names, groups)}: {line}" for line, names in found.items()]


def _together(names: list[str], groups: Mapping[str, str]) -> str:
    of = {groups.get(name, "") for name in names}
    if len(of) == 1 and all(of):
        return of.pop()
    return ", ".join(names) if len(names) < 4 else f"{names[0]} and {len(names) - 1} more"


def departures(paper: Paper, chosen: Mapping[str, Any]) -> list[str]:
    """What a person chose instead of what the replay's file says, a phrase each."""
    told = []
    for name in SAID:
        if name in chosen and chosen[name] != paper.settings.get(name):
            usual = paper.settings.get(name)
            instead = f" instead of {usual}" if isinstance(usual, str) else ""
            told.append(f"--{SETTINGS[name].name} {_text(chosen[name])}{instead}")
    return told


def _text(value: Any) -> str:
    return (", ".join(value) or "nothing") if isinstance(value, Mapping) else str(value)

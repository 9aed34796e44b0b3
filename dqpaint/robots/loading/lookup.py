"""A name, a file or a drawing -> the card of its arm."""

from importlib import resources
from os.path import isfile
from pathlib import Path
from typing import Any

from dqpaint.core import Registry
from dqpaint.errors import UnknownNameError, UsageError
from dqpaint.language import Diagnostic, Program, ScriptError
from dqpaint.robots.model.card import DEFAULT_ROBOT, Card, card_names, read_card
from dqpaint.robots.model.tool_mount import parse_tool


def _folder(_name: str, package: Any) -> Path:
    """The folder of a package or module that holds cards."""
    return Path(str(resources.files(package)))


CARD_FOLDERS: Registry[Path] = Registry("folder of robots", "dqpaint.robots", _folder)
"""Folders with cards (`NAME.toml`) that other packages bring."""


def plugin_cards() -> dict[str, tuple[Path, str]]:
    """The arms of other packages: name -> the file of its card, and the package."""
    found = {
        file.stem: (file, CARD_FOLDERS.origin(name) or "")
        for name, folder in CARD_FOLDERS.items()
        for file in sorted(folder.glob("*.toml"))
    }
    return {name: one for name, one in found.items() if name not in card_names()}


def find_card(robot: str) -> Card:
    """The card of an arm, by name or by file: *.toml, *.urdf, or *.urdf:LINK.

    Raises:
        UnknownNameError: no card has that name.
        UsageError: but a file has it.
        DqpaintError: the file is not there, or no arm.
    """
    if robot.endswith((".toml", ".urdf")) or ".urdf:" in robot:
        from dqpaint.robots.loading.load_file import read_file

        return read_file(robot)
    try:
        return read_card(robot)
    except UnknownNameError:
        brought = plugin_cards()
        if robot in brought:
            return find_card(str(brought[robot][0]))
        for file in (f"{robot}.toml", f"{robot}.urdf"):
            if isfile(file):
                raise UsageError(
                    f"no robot named '{robot}'; give the whole name of the file: {file}"
                ) from None
        known = sorted({*card_names(), *brought})
        raise UnknownNameError("robot", robot, known, _makers(known)) from None


def _makers(names: list[str]) -> dict[str, str]:
    """The words of arms' titles, such as their makers, and the first arm that has them."""
    meant: dict[str, str] = {}
    for name in names:
        title = find_card(name).title.replace(",", "")
        for word in title.lower().split():
            meant.setdefault(word, name)
    return meant


def with_tool(card: Card, tool: str | None) -> Card:
    """The same arm with another tool frame, parsed by `parse_tool`.

    A place alone leaves the tool turned as it is on the card.

    Raises:
        UsageError: it is not `X,Y,Z` or `X,Y,Z,ROLL,PITCH,YAW`.
    """
    if tool is None:
        return card
    return card.model_copy(update={"tool": parse_tool(tool, card.tool.rpy_deg)})


def card_for(program: Program, robot: str | None, tool: str | None = None) -> Card:
    """The card of the requested arm, else of the drawing's arm, else of the default arm.

    Args:
        program: the drawing.
        robot: the requested arm.
        tool: the position of its light, if it differs from the card.

    Raises:
        UnknownNameError: no card has the requested name.
        UsageError: the tool is not one.
        ScriptError: no card has the name in the file.
    """
    return with_tool(_card_for(program, robot), tool)


def _card_for(program: Program, robot: str | None) -> Card:
    if robot is not None or program.robot is None:
        return find_card(DEFAULT_ROBOT if robot is None else robot)
    try:
        return find_card(program.robot)
    except UnknownNameError as problem:
        message, _, help = str(problem).partition("; ")
        unknown = Diagnostic("E311", message, program.robot_span, help=help)
        raise ScriptError(program.name, program.text, (unknown,)) from None

"""Which arm a drawing is for."""

from pathlib import Path

from dqpaint.diagnostics import closest, did_you_mean
from dqpaint.errors import UnknownNameError, UsageError
from dqpaint.language import Diagnostic, Program, ScriptError
from dqpaint.robots.model.card import DEFAULT_ROBOT, Card, read_card
from dqpaint.robots.model.tool_mount import parse_tool


def find_card(robot: str) -> Card:
    """The card of an arm by its name, or by a file: *.toml, *.urdf, or *.urdf:LINK.

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
        for file in (f"{robot}.toml", f"{robot}.urdf"):
            if Path(file).is_file():
                raise UsageError(
                    f"no robot named '{robot}'; a file is named whole: {file}"
                ) from None
        raise


def with_tool(card: Card, tool: str | None) -> Card:
    """The same arm with its light elsewhere on the flange, as `tooling.parse_tool` reads it.

    A place alone leaves the tool turned as it is on the card.

    Raises:
        UsageError: it is not `X,Y,Z` or `X,Y,Z,ROLL,PITCH,YAW`.
    """
    if tool is None:
        return card
    return card.model_copy(update={"tool": parse_tool(tool, card.tool.rpy_deg)})


def card_for(program: Program, robot: str | None, tool: str | None = None) -> Card:
    """The card of the arm that was asked for, else of the file's own, else of the default.

    Args:
        program: the drawing.
        robot: the arm that was asked for.
        tool: where its light sits, if not where the card says.

    Raises:
        UnknownNameError: no card has the name that was asked for.
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
        message, _, known = str(problem).partition("; ")
        names = known.removeprefix("known: ").split(", ")
        cure = f"{did_you_mean(closest(program.robot, names))} {known}".strip()
        unknown = Diagnostic("E311", message, program.robot_span, help=cure)
        raise ScriptError(program.name, program.text, (unknown,)) from None

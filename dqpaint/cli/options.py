"""Groups of settings -> options of commands -> the choices that were typed.

`takes` gives a command the options of its groups. They are made when the command is
called, or its help asked for: the list of commands needs none of them.
"""

import inspect
import os
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from dqpaint.cli.front import completion
from dqpaint.cli.front.streams import note

if TYPE_CHECKING:
    from dqpaint.settings import Setting

Choices = dict[str, Any]
"""What was typed of a command's settings, by their names in Python."""

FILES = "Files"
"""The heading of options that say what is read and written."""

Drawing = Annotated[
    str,
    typer.Argument(
        metavar="FILE",
        help="a .traj file, or an example's name",
        autocompletion=completion.drawings,
    ),
]
Out = Annotated[
    str | None,
    typer.Option(
        metavar="PATH",
        help="a folder, or the stem of the files; - writes the one file to standard output "
        "[default: here]",
        rich_help_panel=FILES,
    ),
]
Save = Annotated[
    str,
    typer.Option(
        metavar="A,B,...",
        help="formats to write; see: dqpaint list formats",
        rich_help_panel=FILES,
        autocompletion=completion.formats,
    ),
]

Command = Callable[..., None]

FILE = typer.Option(
    "--settings",
    metavar="FILE",
    help="a TOML of these options, or the JSON of a run; options on the command line win",
    rich_help_panel=FILES,
)

TRUST = typer.Option(
    "--trust",
    help="run the code that --settings names, wherever it lies; see SECURITY.md",
    rich_help_panel=FILES,
)


NO_PROJECT = typer.Option(
    "--no-project",
    help="leave out the defaults of dqpaint.toml or pyproject.toml; so does --settings",
    rich_help_panel=FILES,
)


def takes(
    name: str,
    *,
    file: bool = True,
    unsaid: bool = True,
) -> Callable[[Command], Command]:
    """Give a command the options of the groups of settings that it takes.

    The command receives what was typed of them, and nothing else, as its argument `choices`: by
    the names in Python, as `dqpaint.draw` takes them.

    Args:
        name: of the command in `dqpaint.settings.COMMANDS`, which is read when it is called.
        file: whether it takes a file of settings, too.
        unsaid: whether help shows defaults at all.
    """

    def wrap(command: Command) -> Command:
        def whole() -> Command:
            from dqpaint.settings import COMMANDS, settings_of

            settings = list(settings_of(*COMMANDS[name]))
            made = options(settings, unsaid=unsaid)
            made += file_parameters() if file else []
            return with_options(command, made, settings)

        return listed(command.__name__, command.__doc__ or "", whole)

    return wrap


def listed(name: str, doc: str, whole: Callable[[], Command]) -> Command:
    """What stands for a command in a list, until `MadeWhenCalled` makes it."""

    def stand() -> None:
        pass

    stand.__name__, stand.__doc__ = name, doc
    stand.made = whole  # type: ignore[attr-defined]
    return stand


def with_options(
    command: Command, parameters: "list[inspect.Parameter]", settings: "Sequence[Setting]"
) -> Command:
    """The command with further parameters, as typer reads them off a signature.

    Args:
        command: receives what was typed of the settings as `choices`.
        parameters: from `options`; others have the names of parameters of the command, and stand in
            their place.
        settings: that the parameters give.
    """
    of_command = inspect.signature(command).parameters.values()
    own = [one for one in of_command if one.name != "choices"]
    names = {one.name for one in parameters}

    def call(**given: Any) -> None:
        context = given.pop("context")
        typed = {
            name for name in given
            if (source := context.get_parameter_source(name)) and source.name == "COMMANDLINE"
        }  # fmt: skip
        keywords = [setting.keyword for setting in settings] + ["settings"]
        choices = {keyword: given[keyword] for keyword in keywords if keyword in typed}
        for setting in settings:
            variant = setting.option.variant
            if variant and given[_variable(variant.name)]:
                choices[setting.keyword] = variant.value
        if given.get("no_project") is False and "settings" not in choices:
            choices = _with_project(choices, keywords)
        if given.get("trust") and "settings" in choices:
            from dqpaint.settings import Trusted

            choices["settings"] = Trusted(choices["settings"])
        command(**{one.name: given[one.name] for one in own}, choices=choices)

    context = inspect.Parameter("context", _KEYWORD, annotation=typer.Context)
    whole = [context, *(one for one in own if one.name not in names), *parameters]
    whole = [one.replace(kind=_KEYWORD) for one in whole]
    call.__signature__ = inspect.Signature(whole)  # type: ignore[attr-defined]
    call.__annotations__ = {one.name: one.annotation for one in whole}
    call.__name__, call.__doc__ = command.__name__, command.__doc__
    return call


def _with_project(typed: Choices, known: Sequence[str]) -> Choices:
    """What was typed over the defaults of the project that the working folder is in."""
    from dqpaint.settings import find_project, read_project, with_defaults

    try:
        path = find_project(Path.cwd())
    except OSError:  # a working folder that is gone
        path = None
    if path is None:
        return typed
    from dqpaint.painting import validate

    given = read_project(path, validate.check_settings, typed)
    made = with_defaults(given, typed, known)
    if added := [name for name in made if name not in typed]:
        from dqpaint.settings import SETTINGS

        note(f"defaults of {_nearby(path)}: {', '.join(SETTINGS[name].name for name in added)}")
    return made


def _nearby(path: Path) -> str:
    try:
        return os.path.relpath(path)
    except ValueError:  # on another drive
        return str(path)


_KEYWORD = inspect.Parameter.KEYWORD_ONLY


def options(
    settings: "Iterable[Setting]", usual: Mapping[str, Any] | None = None, unsaid: bool = True
) -> list[inspect.Parameter]:
    """The parameters of a command that give settings.

    Args:
        settings: of a command.
        usual: defaults of this command that help shows, by the names in Python.
        unsaid: whether help shows defaults at all.
    """
    return [one for setting in settings for one in _options(setting, usual or {}, unsaid)]


def _options(
    setting: "Setting", usual: Mapping[str, Any], unsaid: bool
) -> Iterator[inspect.Parameter]:
    """The parameters of a command that give one setting."""
    option = setting.option
    default = usual.get(setting.keyword, setting.default) if unsaid else None
    shown = f" [default: {option.unsaid}]" if unsaid and option.unsaid and default is None else ""
    flag = f"--{setting.name}"
    if setting.kind is bool and setting.panel:  # what a file of settings may say can be taken back
        flag += f"/--no-{setting.name}"
    info = typer.Option(
        flag,
        metavar=option.metavar,
        help=option.help + shown,
        rich_help_panel=setting.panel or None,
        autocompletion=completion.of_setting(setting.name),
    )
    kind: Any = list[str] if option.many else setting.kind
    yield parameter(setting.keyword, kind if default is not None else kind | None, default, info)
    if option.variant:
        info = typer.Option(
            f"--{option.variant.name}",
            help=option.variant.help,
            rich_help_panel=setting.panel or None,
        )
        yield parameter(_variable(option.variant.name), bool, False, info)


def file_parameters() -> list[inspect.Parameter]:
    """The parameters of a command that takes a file of settings."""
    return [
        parameter("settings", str | None, None, FILE),
        parameter("trust", bool, False, TRUST),
        parameter("no_project", bool, False, NO_PROJECT),
    ]


def parameter(name: str, kind: Any, default: Any, info: Any) -> inspect.Parameter:
    """A parameter as typer reads it: its type, and what typer is to know of it."""
    return inspect.Parameter(name, _KEYWORD, default=default, annotation=Annotated[kind, info])


def _variable(name: str) -> str:
    return name.replace("-", "_")

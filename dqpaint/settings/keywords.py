"""Groups of settings -> the keywords of a Python function: signature, docstring, refusals."""

import inspect
import textwrap
from collections.abc import Callable, Iterable, Sequence
from functools import wraps
from types import NoneType
from typing import Any, TypeVar

from dqpaint.diagnostics import closest
from dqpaint.errors import UsageError
from dqpaint.settings.commands import COMMANDS
from dqpaint.settings.declaration import Setting, settings_of

F = TypeVar("F", bound=Callable[..., Any])
PLACE = "options:"  # the line of a docstring that the keywords take the place of
WIDTH = 100


def check_keywords(
    name: str, given: Iterable[str], settings: Iterable[Setting], own: Sequence[str] = ()
) -> None:
    """Refuse keywords that a function does not take.

    Args:
        name: of the function.
        given: the keywords.
        settings: that it takes.
        own: its other parameters.

    Raises:
        UsageError: the first that is none of them.
    """
    known = [*own, *(setting.keyword for setting in settings)]
    parts = {part for setting in settings for part in setting.option.parts}
    for one in given:
        if one not in known and one not in parts:
            meant = closest(one, known)
            fix = f"did you mean '{meant}'?" if meant else f"known: {', '.join(known)}"
            raise UsageError(f"{name} takes no '{one}'; {fix}")


def keywords(command: str, parameters: Sequence[Setting] = ()) -> Callable[[F], F]:
    """Give a function, which takes `**options`, the settings of a command as its keywords.

    The signature names them, and the docstring has their meaning where it says `options:`. Others
    are refused with a UsageError.

    Args:
        command: in `COMMANDS`.
        parameters: more keywords, before the settings; but for those that the function names.
    """
    settings = [*parameters, *settings_of(*COMMANDS.get(command, ()))]

    def wrap(function: F) -> F:
        own = list(inspect.signature(function).parameters.values())[:-1]
        names = [one.name for one in own]
        others = [setting for setting in settings if setting.keyword not in names]

        @wraps(function)
        def call(*given: Any, **options: Any) -> Any:
            check_keywords(function.__name__, options, settings, names)
            return function(*given, **options)

        made = [
            inspect.Parameter(
                setting.keyword,
                inspect.Parameter.KEYWORD_ONLY,
                default=None,
                annotation=f"{python_type(setting)} | None",
            )
            for setting in others
        ]
        call.__signature__ = inspect.Signature([*own, *made])  # type: ignore[attr-defined]
        call.__doc__ = _documented(function.__doc__ or "", others)
        return call  # type: ignore[return-value]

    return wrap


def python_type(setting: Setting) -> str:
    """The type of a setting's keyword, as it is written."""
    if setting.option.python:
        return setting.option.python
    kinds = [one for one in setting.alternatives if one is not NoneType]
    return " | ".join(inspect.formatannotation(kind).replace("typing.", "") for kind in kinds)


def _documented(doc: str, settings: Sequence[Setting]) -> str:
    """A docstring with a line for each setting, from the help of its option."""
    lines = []
    for line in doc.splitlines():
        if line.strip() != PLACE:
            lines.append(line)
            continue
        indent = line[: len(line) - len(line.lstrip())]
        for setting in settings:
            option = setting.option
            unsaid = option.unsaid or ("" if setting.default is None else f"{setting.default!r}")
            said = f"{setting.keyword}: {option.help}" + (f" [default: {unsaid}]" if unsaid else "")
            if option.variant:
                said += f"; {option.variant.value!r} is {option.variant.help}"
            lines += textwrap.wrap(
                said, WIDTH, initial_indent=indent, subsequent_indent=indent + " " * 4,
                break_on_hyphens=False,
            )  # fmt: skip
    return "\n".join(lines)

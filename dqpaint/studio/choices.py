"""Declarations of settings -> the controls of the page, and what may come from a stranger.

The controls are made from the same fields as the options of the command line; `SUGGESTIONS` has the
names that some of them take.
"""

import shlex
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass
from typing import Any, Literal, get_args, get_origin

from dqpaint.errors import DqpaintError, UsageError
from dqpaint.settings import COMMANDS, Setting, make_settings, settings_of

LEFT_OUT = {
    "recorded",
    "max_samples",
    "max_memory",
    "timeout",
    "size",
    "kinematics",
    "trust",
}  # of the command line alone
VIEWS = ("front", "iso", "side", "top")
DISTURBANCE_EXAMPLES = (
    "twist=sine,x=0.02,frequency=2", "noise=0.0002", "latency=3", "payload=2", "push=y=40",
)  # fmt: skip
Kind = Literal["switch", "choice", "number", "text", "names"]


@dataclass(frozen=True)
class Control:
    """One control: the setting behind it, its kind, and the names that it offers."""

    setting: Setting
    kind: Kind
    names: tuple[str, ...] = ()

    @property
    def keyword(self) -> str:
        """What Python calls it."""
        return self.setting.keyword


def controls(laws: Sequence[str] = ()) -> dict[str, list[Control]]:
    """The controls by their panels.

    Args:
        laws: files of laws that the command line named.
    """
    found: dict[str, list[Control]] = {}
    for setting in settings_of(*COMMANDS["draw"]):
        if setting.keyword not in LEFT_OUT:
            names = tuple(SUGGESTIONS.get(setting.keyword, _nothing)())
            names += tuple(laws) if setting.keyword == "controller" else ()
            found.setdefault(setting.panel, []).append(
                Control(setting, _kind(setting, names), names or _literals(setting))
            )
    return found  # fmt: skip


def _kind(setting: Setting, names: Sequence[str]) -> Kind:
    if names:
        return "names"
    if _literals(setting):
        return "choice"
    if setting.kind is bool:
        return "switch"
    return "number" if setting.kind in (int, float) and not setting.option.parts else "text"


def _literals(setting: Setting) -> tuple[str, ...]:
    return tuple(
        str(value)
        for one in setting.alternatives
        if get_origin(one) is Literal
        for value in get_args(one)
        if isinstance(value, str)
    )


def _nothing() -> Iterable[str]:
    return ()


def _laws() -> Iterable[str]:
    from dqpaint.controllers import CONTROLLERS

    return CONTROLLERS


def _robots() -> Iterable[str]:
    from dqpaint.robots.loading import plugin_cards
    from dqpaint.robots.model import card_names

    return [*card_names(), *plugin_cards()]


def _plants() -> Iterable[str]:
    from dqpaint.plants import PLANTS

    return PLANTS


def _brushes() -> Iterable[str]:
    from dqpaint.brushes import BRUSHES

    return BRUSHES


def _looks() -> Iterable[str]:
    from dqpaint.light.film import LOOKS

    return LOOKS


def _objectives() -> Iterable[str]:
    from dqpaint.robots.kinematics import OBJECTIVES

    return OBJECTIVES


def _columns() -> Iterable[str]:
    from dqpaint.metrics import all_columns

    return [name for column in all_columns() if (name := column.colour_by)]


SUGGESTIONS: dict[str, Callable[[], Iterable[str]]] = {
    "controller": _laws,
    "robot": _robots,
    "plant": _plants,
    "brush": _brushes,
    "look": _looks,
    "null": _objectives,
    "view": lambda: VIEWS,
    "colour_by": _columns,
    "disturb": lambda: DISTURBANCE_EXAMPLES,
}


@dataclass(frozen=True)
class Gain:
    """A gain of a law: its name, usual value and meaning."""

    name: str
    default: float
    about: str


def gains_of(law: str) -> list[Gain]:
    """The gains of a law that are one number; none of a file."""
    from dqpaint.controllers import CONTROLLERS

    if law not in CONTROLLERS:
        return []
    fields = CONTROLLERS[law].gains.model_fields
    return [
        Gain(name, float(field.default), field.description or "")
        for name, field in fields.items()
        if isinstance(field.default, int | float) and not isinstance(field.default, bool)
    ]


def command(name: str, choices: Mapping[str, Any]) -> str:
    """The command line that would paint the same."""
    words = ["dqpaint", "draw", name]
    for setting in settings_of(*COMMANDS["draw"]):
        value = choices.get(setting.keyword)
        if value is None or value is False:
            continue
        flag = f"--{setting.name}"
        if value is True:
            words.append(flag)
        elif isinstance(value, Mapping):
            for key, one in value.items():
                words += [flag, f"{key}={one}"]
        elif isinstance(value, list | tuple):
            for one in value:
                words += [flag, str(one)]
        else:
            words += [flag, str(value)]
    return shlex.join(words)


def check_choices(choices: Mapping[str, Any], laws: Sequence[str]) -> dict[str, Any]:
    """Choices as a stranger may give them: those of the page, without files or code.

    Args:
        choices: by their names in Python.
        laws: files of laws that the command line named.

    Raises:
        UsageError: one is none of the page's, or names a file.
    """
    known = {one.keyword for group in controls(laws).values() for one in group}
    for key, value in choices.items():
        if key not in known:
            raise UsageError(f"'{key[:40]}' is no choice of this page")
        names = [value] if isinstance(value, str) else _texts(value)
        for name in names:
            if _names_a_file(name) and not (key == "controller" and name in laws):
                raise UsageError(
                    f"{key.replace('_', '-')} '{name[:60]}' is a file: code and files are taken "
                    "only from the command line of the studio"
                )
    try:
        make_settings(**choices)
    except DqpaintError as problem:
        raise UsageError(str(problem)) from None
    return dict(choices)


def _texts(value: object) -> list[str]:
    if isinstance(value, Mapping):
        return [text for one in value.items() for text in _texts(one)]
    if isinstance(value, list | tuple):
        return [text for one in value for text in _texts(one)]
    return [value] if isinstance(value, str) else []


def _names_a_file(text: str) -> bool:
    endings = (".py", ".urdf", ".toml", ".csv", ".json", ".png", ".jpg")
    return any(sign in text for sign in ("/", "\\")) or any(end in text.lower() for end in endings)

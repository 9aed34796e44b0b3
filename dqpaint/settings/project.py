"""A folder -> the defaults of the project that it lies in: `dqpaint.toml`, or `[tool.dqpaint]`.

They are found, not named, so they may say less than a settings file: nothing in them is run.
"""

from collections.abc import Collection, Mapping
from pathlib import Path
from typing import Any

from dqpaint.core import read_regular
from dqpaint.settings.file import LARGEST, PYPROJECT, Check, SettingsFile, read_given
from dqpaint.settings.model import SETTINGS, Settings

OWN = "dqpaint.toml"
TABLE = b"[tool.dqpaint"


def find_project(folder: Path) -> Path | None:
    """The nearest file of defaults, in a folder or above it.

    Args:
        folder: with its whole path.
    """
    for place in (folder, *folder.parents):
        if (place / OWN).is_file():
            return place / OWN
        try:
            if TABLE in read_regular(place / PYPROJECT, LARGEST):
                return place / PYPROJECT
        except OSError:
            continue
    return None


def read_project(path: Path, check: Check, typed: Collection[str]) -> SettingsFile:
    """The defaults of a project, without code that was typed.

    Args:
        path: from `find_project`.
        check: as for `read_given`.
        typed: names in Python.

    Raises:
        DqpaintError: a key or value is wrong, or names code, which only a file that was named runs.
    """
    return read_given(str(path), check, "refuse", typed)


def with_defaults(
    given: SettingsFile, typed: Mapping[str, Any], known: Collection[str]
) -> dict[str, Any]:
    """What was typed, and the defaults that a command knows; by the names in Python.

    Args:
        given: from `read_project`.
        typed: by the names in Python.
        known: names of the command's settings.

    Raises:
        UsageError: a typed value does not have the form of its setting.
    """
    of_settings = {name: value for name, value in typed.items() if name in SETTINGS}
    fields = given.under(of_settings)
    made = dict(typed)
    for name in known:
        if name not in SETTINGS or (name in typed and name not in ("gains", "disturb")):
            continue
        parts = SETTINGS[name].option.parts
        if parts and set(parts) & set(fields):
            made[name] = tuple(fields.get(p, Settings.model_fields[p].default) for p in parts)
        elif not parts and SETTINGS[name].field in fields:
            made[name] = fields[SETTINGS[name].field]
    return made

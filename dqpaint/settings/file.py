"""A TOML file of options, or the JSON summary of a run -> settings.

    view = "iso"
    exposure = "f/8,iso100,35mm,0.05cd"
    gain.k = 20
    disturb.twist = "sine,x=0.02,frequency=2"

Keys are the options of the command line without the dashes before them, or the fields of
`Settings`, which is how a summary has them. A file that a value names is looked for beside the
settings first. A law, a plant or a brush of one's own is code, which reading it runs: only for
what runs laws, and only from the folder of the settings, unless the file is `Trusted`.
"""

import json
import re
import tomllib
from collections.abc import Callable, Collection, Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any, Literal

from dqpaint import __version__
from dqpaint.core import choice_name, examples_folder, find_file, read_regular, split_spec
from dqpaint.diagnostics import closest
from dqpaint.errors import DqpaintError, UsageError
from dqpaint.settings.groups import DEFAULT_CONTROLLER
from dqpaint.settings.model import (
    SETTINGS,
    Settings,
    checked,
    read_choices,
)

LARGEST = 1_000_000  # bytes of a file
RUN_SCHEMA = "dqpaint-run-2"  # of the summaries that are written
READABLE = ("dqpaint-run-1", RUN_SCHEMA)
MEANT = {
    "camera": "view", "color-by": "colour-by", "colour": "colour-by", "law": "controller",
    "arm": "robot", "lens": "exposure", "f-number": "exposure", "iso": "exposure",
    "distance": "exposure", "shutter": "exposure", "azimuth": "view", "elevation": "view",
}  # fmt: skip
NOT_OF_THE_PICTURE = ("out", "save", "settings", "trust", "watch", "jobs")

CODE = ("controller", "plant", "brush")
"""Settings that may name a file of code."""
Check = Callable[[Settings], None]
Code = Literal["run", "leave", "refuse"]
PYPROJECT = "pyproject.toml"


class Trusted(str):
    """The path of settings whose code is run wherever it lies, and by every command."""

    __slots__ = ()


@dataclass(frozen=True)
class SettingsFile:
    """Settings of a file, with the version and drawing that it is for.

    Attributes:
        name: of the file; empty where there is none.
        choices: by the fields of `Settings`.
        version: of the dqpaint that it is for; None where it has none.
        sha256: hash of the drawing that it was made with, likewise.
    """

    name: str = ""
    choices: Mapping[str, Any] = field(default_factory=dict)
    version: str | None = None
    sha256: str | None = None

    def under(self, typed: Mapping[str, Any]) -> dict[str, Any]:
        """Choices of the file and of the user; the user's win, gains and disturbances singly.

        The gains of a file are those of its law, and go with it.

        Raises:
            UsageError: a typed value does not have the form of its setting.
        """
        given = dict(self.choices)
        said = read_choices(typed)
        law = given.get("controller", DEFAULT_CONTROLLER)
        if said.get("controller", law) != law:
            given.pop("gains", None)
        for name in ("gains", "disturb"):
            if name in given:
                said[name] = {**given[name], **said.get(name, {})}
        return {**given, **said}

    def remarks(self, sha256: str) -> tuple[str, ...]:
        """Notes on why the picture may differ from the one the file is for.

        Args:
            sha256: of the drawing as it is.
        """
        found: tuple[str, ...] = ()
        if self.version not in (None, __version__):
            found += (f"{self.name} is for dqpaint {self.version}, this is {__version__}",)
        if self.sha256 not in (None, sha256):
            found += (f"{self.name} was made with another text of this drawing",)
        return found


def read_given(
    path: str, check: Check, code: Code = "run", replaced: Collection[str] = ()
) -> SettingsFile:
    """Read a file of settings and check it key by key.

    Args:
        path: of the file; may be `Trusted`.
        check: raises a DqpaintError if the settings that one key gives are wrong; runs the code
            that they name.
        code: what becomes of a law, a plant or a brush that is a file of code: `run`, if it lies in
            the folder of the settings; `leave`: a law and a plant are left out, unread, and a brush
            is refused; `refuse`: all of it is refused.
        replaced: fields of `Settings` that are said elsewhere: code in them is left out.

    Raises:
        DqpaintError: it cannot be read, or a key or value is wrong; the message has the line.
    """
    place = Path(path)
    text = _text(place)
    raw, given = _parsed(place, text)
    choices: dict[str, Any] = {}
    spelt: dict[str, str] = {}
    lost: set[str] = set()
    for key, value in raw.items():
        try:
            for name, read in _read(key, _beside_all(place.parent, value)).items():
                if name in choices:
                    raise UsageError(f"{key} sets again what {spelt[name]} sets")
                choices[name], spelt[name] = read, key
            for name in [name for name in CODE if name in replaced and _code(choices, name)]:
                del choices[name]
                lost.add(name)
            of_key = {name: choices[name] for name in choices if spelt[name] == key}
            if not isinstance(path, Trusted):
                of_key = _known_code(place.parent, of_key, code)
            gains = of_key.pop("gains", None)  # of a law that another key may name
            check(checked(of_key, strict=True))
            if gains is not None:
                checked({"gains": gains}, strict=True)
        except DqpaintError as problem:
            raise DqpaintError(f"{_where(place, text, key)}: {problem}") from None
    if "controller" in lost:
        choices.pop("gains", None)
    if "gains" in choices:
        try:
            law: dict[str, Any] = {
                name: choices[name] for name in ("controller", "gains") if name in choices
            }
            if code == "run" or isinstance(path, Trusted) or not _code(law, "controller"):
                check(checked(law))
            else:
                del choices["gains"]
        except DqpaintError as problem:
            raise DqpaintError(f"{_where(place, text, spelt['gains'])}: {problem}") from None
    if not (code == "run" or isinstance(path, Trusted)):
        choices = _known_code(place.parent, choices, code)
    return SettingsFile(place.name, choices, *given)


def check_code(folder: Path, choices: Mapping[str, Any]) -> None:
    """Refuse code that lies outside a folder; examples of dqpaint are no strangers.

    Args:
        folder: of the file that names it.
        choices: by the fields of `Settings`.

    Raises:
        UsageError: a law, a plant or a brush is in a file elsewhere.
    """
    for name in CODE:
        file = _code(choices, name)
        if file is None:
            continue
        place = find_file(file).resolve()
        if not any(place.is_relative_to(one.resolve()) for one in (folder, examples_folder())):
            raise UsageError(
                f"{name} '{str(file)[-60:]}' is code outside the folder of this file, which is not "
                "run unasked: name it on the command line, or trust the file: --trust"
            )


def _code(choices: Mapping[str, Any], name: str) -> Path | None:
    """The file of code that a setting names."""
    value = choices.get(name)
    parts = split_spec(choice_name(value)) if isinstance(value, str) else None
    return parts[0] if parts else None


def _known_code(folder: Path, choices: Mapping[str, Any], code: Code) -> dict[str, Any]:
    """Choices without code that is not needed.

    Raises:
        UsageError: code that may not be run.
    """
    named = next((name for name in CODE if _code(choices, name)), "")
    if code == "run":
        check_code(folder, choices)
    elif code == "refuse" and named:
        raise UsageError(
            f"{named} '{choices[named][:60]}' is code, and a file that nobody named runs none: "
            f"give --{named} on the command line, or the file by --settings"
        )
    elif _code(choices, "brush"):
        raise UsageError(
            f"brush '{choices['brush'][:60]}' is code, and this command runs none that a file "
            "names: give --brush on the command line, or trust the file: --trust"
        )
    kept = code == "run"
    return {name: value for name, value in choices.items() if kept or not _code(choices, name)}


def beside(folder: Path, value: object) -> object:
    """A file of the folder as such, with what follows a colon; anything else as it is."""
    if not isinstance(value, str):
        return value
    head, sign, rest = value.partition(":")
    try:
        known = bool(head) and (folder / head).is_file()
    except (OSError, ValueError):
        known = False
    return f"{folder / head}{sign}{rest}" if known else value


def _beside_all(folder: Path, value: Any) -> Any:
    if isinstance(value, Mapping):
        return {key: _beside_all(folder, one) for key, one in value.items()}
    if isinstance(value, list):
        return [_beside_all(folder, one) for one in value]
    if isinstance(value, str) and re.search(r"\b(image|file)=", value):
        return re.sub(
            r"\b(image|file)=([^,]+)", lambda put: f"{put[1]}={beside(folder, put[2])}", value
        )
    return beside(folder, value)


def _text(place: Path) -> str:
    try:
        return read_regular(place, LARGEST).decode("utf-8")
    except (OSError, ValueError) as problem:
        reason = problem.strerror if isinstance(problem, OSError) else str(problem)
        raise DqpaintError(f"settings '{str(place)[:60]}' cannot be read: {reason}") from None


def _parsed(place: Path, text: str) -> tuple[dict[str, Any], tuple[str | None, str | None]]:
    """The settings of a file, the version it is for, and the hash of its drawing."""
    kind = "JSON" if place.suffix == ".json" else "TOML"
    try:
        raw = json.loads(text) if kind == "JSON" else tomllib.loads(text)
    except (ValueError, RecursionError) as problem:
        reason = "it is nested too deep" if isinstance(problem, RecursionError) else problem
        raise DqpaintError(f"{place.name} is no {kind}: {reason}") from None
    if place.name == PYPROJECT:
        tool = raw.get("tool", {})
        raw = tool.get("dqpaint", {}) if isinstance(tool, dict) else {}
        if not isinstance(raw, dict):
            raise DqpaintError(f"{place.name}: tool.dqpaint is a table: [tool.dqpaint]")
    if kind == "TOML":
        version = raw.pop("dqpaint", None)
        if not isinstance(version, str | None):
            where = _where(place, text, "dqpaint")
            raise DqpaintError(f'{where}: dqpaint is a version, for example "{__version__}"')
        return raw, (version, None)
    if not (isinstance(raw, dict) and raw.get("schema") in READABLE):
        raise DqpaintError(f"{place.name} is not the summary of a run: draw --save json makes one")
    settings, versions = raw.get("settings"), raw.get("versions")
    if not (isinstance(settings, dict) and isinstance(versions, dict)):
        raise DqpaintError(f"{place.name} is damaged: a summary has settings and versions")
    said = {name: value for name, value in settings.items() if value is not None}
    return said, (str(versions.get("dqpaint")), str(raw.get("sha256")))


def _read(key: str, value: Any) -> dict[str, Any]:
    """The fields of `Settings` that a key and its value give."""
    name = key.replace("_", "-")
    for setting in SETTINGS.values():
        if name in (setting.name, setting.keyword.replace("_", "-")):
            return read_choices({setting.keyword: value})
        variant = setting.option.variant
        if variant and name == variant.name:
            if not isinstance(value, bool):
                raise UsageError(f"{key} {value!r} should be true or false")
            return {setting.field: variant.value} if value else {}
    if (field := name.replace("-", "_")) in Settings.model_fields:
        return {field: value}
    if name in NOT_OF_THE_PICTURE:
        raise UsageError(f"'{name}' is no part of a picture: give it on the command line")
    known = sorted(
        {setting.name for setting in SETTINGS.values()}
        | {one.option.variant.name for one in SETTINGS.values() if one.option.variant}
    )
    meant = closest(name, known, MEANT)
    fix = f"did you mean '{meant}'?" if meant else f"known: {', '.join(known)}"
    raise UsageError(f"no setting named '{key[:60]}'; {fix}")


def _where(place: Path, text: str, key: str) -> str:
    """The file and, where it can be found, the line of a key."""
    word = rf"[\"']?{re.escape(key)}[\"']?"
    found = re.search(rf"^\s*(?:\[\s*)?{word}\s*(?=[=.:\]])", text, re.MULTILINE)
    if found is None:
        return f"{place.name}, {key[:60]}"
    return f"{place.name}:{text.count(chr(10), 0, found.end()) + 1}"

"""The examples in `gallery.toml` -> their pictures and summaries, and pages that show them all."""

import json
import shlex
import tomllib
from collections.abc import Iterator
from importlib.resources import files as resources
from pathlib import Path
from typing import Any, NamedTuple

from dqpaint.api import draw
from dqpaint.core import short_name
from dqpaint.outputs import files, summary
from dqpaint.settings import DEFAULT_CONTROLLER, SETTINGS
from dqpaint.studies.kinds import error_functions, hinf_bound


class Shot(NamedTuple):
    """One picture: the example, the sentence below it, and the options besides the defaults."""

    example: str
    caption: str
    options: dict[str, Any] = {}  # noqa: RUF012  nobody changes it
    suffix: str = ""  # of the files' name, where one example is shown twice

    @property
    def name(self) -> str:
        """The files' name."""
        law = short_name(self.options.get("controller", DEFAULT_CONTROLLER))
        return f"{self.example}-{law}{self.suffix}"

    @property
    def command(self) -> str:
        """The command that makes the same picture."""
        options = "".join(_option(name, value) for name, value in self.options.items())
        return f"dqpaint draw {self.example}{options}"


def _option(name: str, value: object) -> str:
    if (name, value) == ("ghost", "motion"):
        return " --motion-ghost"
    word = f" --{SETTINGS[name].name if name in SETTINGS else name}"
    if isinstance(value, list):
        return "".join(f"{word} {shlex.quote(one)}" for one in value)
    return word if value is True else f"{word} {shlex.quote(str(value))}"


def read_shots() -> list[Shot]:
    """The pictures of the gallery, in their order."""
    text = resources("dqpaint.studies").joinpath("gallery.toml").read_text("utf-8")
    return [Shot(**one) for one in tomllib.loads(text)["picture"]]


def make_gallery(folder: str) -> Iterator[Path]:
    """Paint every shot into a folder, with its summary, and pages that show them all."""
    for shot in read_shots():
        painting = draw(shot.example, **shot.options)
        facts = summary.summarise(painting)
        del facts["wall_s"]  # the only part that differs from run to run
        contents = {
            ".png": painting.picture.png,
            ".json": (json.dumps(facts, indent=2) + "\n").encode(),
        }
        yield from files.write(files.stem_for(f"{folder or '.'}/", shot.name), contents)
    yield from files.write(files.stem_for(f"{folder or '.'}/", "README"), {".md": page().encode()})
    found = hinf_bound.curves()
    contents = {".png": hinf_bound.picture(found), ".md": hinf_bound.page(found).encode()}
    yield from files.write(files.stem_for(f"{folder or '.'}/", "promise"), contents)
    chart = {".png": error_functions.picture()}
    yield from files.write(files.stem_for(f"{folder or '.'}/", "which-error"), chart)


def page() -> str:
    """The page of the gallery in Markdown."""
    parts = ["# Gallery\n\nMade by `dqpaint gallery`, never by hand.\n"]
    for shot in read_shots():
        text = f"{shot.caption}\n\n![{shot.caption}]({shot.name}.png)\n\n    {shot.command}\n"
        parts.append(f"## {shot.name}\n\n{text}")
    parts.append("[The H-infinity promise over frequency](promise.md)\n")
    parts.append("![How fast a law turns home, by the error's angle](which-error.png)\n")
    return "\n".join(parts)

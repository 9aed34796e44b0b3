"""The gallery: every example drawing, painted, with the command that paints it."""

import json
import shlex
from collections.abc import Iterator
from pathlib import Path
from typing import Any, NamedTuple

from dqpaint.api import draw
from dqpaint.core import short_name
from dqpaint.outputs import files, summary
from dqpaint.settings import DEFAULT_CONTROLLER
from dqpaint.studies.kinds import hinf_bound


class Shot(NamedTuple):
    """One picture: the example, what is said below it, and the choices besides the defaults."""

    example: str
    caption: str
    choices: dict[str, Any]
    shows: str = ""  # in the files' name, where one example is shown twice

    @property
    def name(self) -> str:
        """Of the files."""
        law = short_name(self.choices.get("controller", DEFAULT_CONTROLLER))
        return f"{self.example}-{law}{self.shows}"

    @property
    def command(self) -> str:
        """What to type for the same picture."""
        options = "".join(_option(name, value) for name, value in self.choices.items())
        return f"dqpaint draw {self.example}{options}"


def _option(name: str, value: object) -> str:
    if (name, value) == ("ghost", "motion"):
        return " --motion-ghost"
    word = f" --{name.replace('_', '-')}"
    return word if value is True else f"{word} {shlex.quote(str(value))}"


HELICOID = (
    "bar:length=300mm,leds=64,colours=orange/magenta/blueviolet/cyan/blueviolet/magenta/orange"
)
TOLD = {"plant": "compliant", "colour_by": "position-error:20", "overlay": True}

SHOTS = (
    Shot("star", "Trapezoid speed: the arm rests at each corner, and the corner glows.", {}),
    Shot(
        "lag", "Without feed-forward corners are cut and small circles shrink,", {"controller": "p"}
    ),
    Shot("lag", "with it they do not. Same drawing, same camera, same exposure.", {}),
    Shot(
        "lag",
        "On an elastic arm, coloured by its error, over what was asked, which is grey:",
        {"controller": "p", **TOLD},
        "-error",
    ),
    Shot(
        "lag",
        "with feed-forward lines and wide circles are true. Corners make the springs swing, "
        "and the small circle goes round as fast as they do.",
        TOLD,
        "-error",
    ),
    Shot(
        "quarter-turn",
        "A quarter turn under torques, within two micrometres.",
        {"controller": "accel", "view": "iso"},
    ),
    Shot("rose", "A formula with exact derivatives, six times in a ring.", {}),
    Shot("spiral", "A helix is an arc that rises.", {"view": "iso"}),
    Shot(
        "square",
        "Two sides in 500 samples, two in 300: the colours tell the speed.",
        {"colour_by": "speed"},
    ),
    Shot("circle", "The thesis's circle in 3000 samples.", {}),
    Shot("baxter-screw", "A screw of pitch zero about a line given in space.", {"view": "iso"}),
    Shot("signature", "Lettering runs through its vertices: no beads on the line.", {}),
    Shot("logo", "An SVG drawing, its arcs still arcs.", {}),
    Shot("orbit", "541 points of a CSV file, smoothly.", {}),
    Shot("ribbon", "A bar of light on a screw motion sweeps a helicoid.", {"view": "iso"}),
    Shot(
        "unwinding",
        "x and -x are one pose. A law that forgets it turns away where their signs part,",
        {"controller": "unwinding.py"},
    ),
    Shot("unwinding", "one that heeds it draws on.", {}),
    Shot(
        "helicoid",
        "A bar of LEDs across the axis of one screw: orientation is seen.",
        {"brush": HELICOID, "view": "45,8"},
    ),
    Shot(
        "helicoid",
        "The same with its arm, lit by what it painted; the camera stands where it was put.",
        {"brush": HELICOID, "view": "at:1.85:-0.9:0.66:0.26:0.02:0.475", "ghost": True},
        "-ghost",
    ),
    Shot(
        "star",
        "The arm as a veil, in the little light of a room: it was there, and there, and there.",
        {"view": "at:1.68:-1:0.72:0.3:0.02:0.47", "ghost": "motion", "ev": 0.5},
        "-motion",
    ),
    Shot(
        "pixelstick",
        "An image, column by column, along the way of a bar.",
        {"brush": "pixelstick:length=140mm,along=y", "view": "20,40"},
    ),
    Shot("step", "A jump of the set point: the error decays, and slower is brighter.", {}),
)


def make_gallery(folder: str) -> Iterator[Path]:
    """Paint every shot into a folder, with its summary, and pages that show them all."""
    for shot in SHOTS:
        painting = draw(shot.example, **shot.choices)
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


def page() -> str:
    """The page of the gallery in Markdown."""
    parts = ["# Gallery\n\nMade by `dqpaint gallery`, never by hand.\n"]
    for shot in SHOTS:
        text = f"{shot.caption}\n\n![{shot.caption}]({shot.name}.png)\n\n    {shot.command}\n"
        parts.append(f"## {shot.name}\n\n{text}")
    parts.append("[The H-infinity promise over frequency](promise.md)\n")
    return "\n".join(parts)

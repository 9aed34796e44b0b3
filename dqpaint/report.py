"""The figures a person wants to see after a command."""

import math
from collections.abc import Sequence
from pathlib import Path

from dqpaint.language import render
from dqpaint.motion import Motion, summary_line
from dqpaint.paint import Painting
from dqpaint.picture import Picture
from dqpaint.robots.limits import Clamp
from dqpaint.sketch import Preview
from dqpaint.terminal import table

WHITE = 250  # of 255
MOST_NAMED = 3  # limits in the table; all of them are in the warnings
WORTH_A_WARNING = 0.01  # of the light
NOTHING = 1e-9  # [mm, deg] is shown as 0


def of_painting(painting: Painting, written: Sequence[Path]) -> str:
    """The table that follows `draw`."""
    figures, settings = painting.metrics.figures, painting.settings
    gains = ", ".join(f"{name} = {value:.4g}" for name, value in painting.gains.items())
    rows = [
        ("drawing", summary_line(painting.motion)),
        ("arm", f"{painting.robot}, {settings.plant}"),
        ("controller", f"{settings.controller}  {gains}"),
        ("position error", _spread(figures, "position_error", "m", 1e3, "mm")),
        ("", f"largest at {_worst(painting)}"),
        ("orientation error", _spread(figures, "orientation_error", "rad", math.degrees(1), "deg")),
        ("commanded", f"{figures['command_integral_rad']:.3g} rad in all joints together"),
        ("limits", _limits_line(painting)),
        *_pictures(painting.pictures),
        *_files(written),
    ]
    return table(rows)


def of_preview(preview: Preview, written: Sequence[Path]) -> str:
    """The table that follows `preview`."""
    rows = [("drawing", summary_line(preview.motion)), *_pictures(preview.pictures)]
    return table([*rows, *_files(written)])


def of_developed(pictures: Sequence[Picture], written: Sequence[Path]) -> str:
    """The table that follows `develop`."""
    return table([*_pictures(pictures), *_files(written)])


def _pictures(pictures: Sequence[Picture]) -> list[tuple[str, str]]:
    """What the light and the exposure of the first picture are; the others are of the same run."""
    return [("light", light_line(pictures[0])), ("exposure", pictures[0].told)]


def light_line(picture: Picture) -> str:
    """What of the light fell on the film, and how bright the picture came out."""
    film = picture.film
    emitted = film.emitted.sum()
    red, green, blue = (picture.image[..., i] >= WHITE for i in range(3))
    white = float((red & green & blue).mean())
    return (
        f"{film.on_film.sum() / emitted:.1%} on film, {film.lost.sum() / emitted:.1%} lost; "
        f"{white:.2%} of the picture is white"
    )


def notes(motion: Motion) -> list[str]:
    """Warnings about a drawing."""
    return [render(note, motion.program.name, motion.program.text) for note in motion.notes]


def remarks(painting: Painting) -> list[str]:
    """Warnings about a drawing and its run."""
    texts = notes(painting.motion)
    for (kind, line), held in _grouped(painting).items():
        joints = "".join(f"\n    {clamp}" for clamp in held)
        texts.append(f"warning: line {line} runs into {kind} limits:{joints}{CURES[kind]}")
    film = painting.picture.film
    if film.lost.sum() > WORTH_A_WARNING * film.emitted.sum():
        share = film.lost.sum() / film.emitted.sum()
        texts.append(f"warning: {share:.0%} of the light fell outside the picture")
    return texts


CURES = {
    "position": "\n  = help: turn the tool less, or move the drawing with place",
    "speed": "\n  = help: draw it slower (speed, in, samples), or lower the gains",
    "torque": "\n  = help: a lower speed, a smoother law or lower gains need less torque",
}


def _grouped(painting: Painting) -> dict[tuple[str, int], list[Clamp]]:
    """The limits that were reached, by kind and line, in the order of time."""
    groups: dict[tuple[str, int], list[Clamp]] = {}
    for clamp in painting.limits:
        groups.setdefault((clamp.kind, clamp.line), []).append(clamp)
    return groups


def _limits_line(painting: Painting) -> str:
    groups = _grouped(painting)
    if not groups:
        return "none reached"
    parts = (f"{kind} (line {line})" for kind, line in list(groups)[:MOST_NAMED])
    more = f" and {len(groups) - MOST_NAMED} more" if len(groups) > MOST_NAMED else ""
    return f"{', '.join(parts)}{more} reached: there the arm could not follow"


def _spread(figures: dict[str, float], name: str, unit: str, scale: float, shown: str) -> str:
    rms, most = (figures[f"{name}_{kind}_{unit}"] * scale for kind in ("rms", "max"))
    rms, most = (0.0 if value < NOTHING else value for value in (rms, most))
    return f"rms {rms:.3g} {shown}, largest {most:.3g} {shown}"


def _worst(painting: Painting) -> str:
    motion = painting.motion
    row = int(painting.table["position_error_m"].argmax())
    return f"{motion.t[row]:.3f} s, line {motion.line[row]}"


def _files(written: Sequence[Path]) -> list[tuple[str, str]]:
    return [("written" if i == 0 else "", str(path)) for i, path in enumerate(written)]

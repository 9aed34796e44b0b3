"""The figures a person wants to see after a command."""

import math
from collections.abc import Sequence
from pathlib import Path

from dqpaint.language import render
from dqpaint.motion import Motion
from dqpaint.paint import Painting
from dqpaint.picture import Picture
from dqpaint.terminal import table

WHITE = 250  # of 255
MOST_CLAMPS = 8  # that are named one by one


def of_painting(painting: Painting, written: Sequence[Path]) -> str:
    """The table that follows `draw`."""
    figures, settings = painting.metrics.figures, painting.settings
    gains = ", ".join(f"{name} = {value:.4g}" for name, value in painting.gains.items())
    rows = [
        ("drawing", drawing_line(painting.motion)),
        ("arm", f"{painting.robot}, {settings.plant}"),
        ("controller", f"{settings.controller}  {gains}"),
        ("position error", _spread(figures, "position_error", "m", 1e3, "mm")),
        ("", f"largest at {_worst(painting)}"),
        ("orientation error", _spread(figures, "orientation_error", "rad", math.degrees(1), "deg")),
        ("commanded", f"{figures['command_integral_rad']:.3g} rad"),
        ("limits", f"{len(painting.track.clamps) or 'none'} reached"),
        ("light", light_line(painting.picture)),
        *_files(written),
    ]
    return table(rows)


def of_preview(motion: Motion, picture: Picture, written: Sequence[Path]) -> str:
    """The table that follows `preview`."""
    rows = [("drawing", drawing_line(motion)), ("light", light_line(picture)), *_files(written)]
    return table(rows)


def drawing_line(motion: Motion) -> str:
    """Length, time, steps and box of a drawing."""
    box = " x ".join(f"{side * 1e3:.0f}" for side in motion.box)
    return (
        f"{Path(motion.program.name).name}: {motion.length * 1e3:.0f} mm in {motion.t[-1]:.2f} s, "
        f"{len(motion.t) - 1} steps of {motion.period * 1e3:g} ms, box {box} mm"
    )


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
    held = painting.track.clamps
    texts = [f"warning: {clamp}" for clamp in held[:MOST_CLAMPS]]
    if len(held) > MOST_CLAMPS:
        texts.append(f"warning: {len(held) - MOST_CLAMPS} more limits are listed in the summary")
    return notes(painting.motion) + texts


def _spread(figures: dict[str, float], name: str, unit: str, scale: float, shown: str) -> str:
    rms, most = (figures[f"{name}_{kind}_{unit}"] * scale for kind in ("rms", "max"))
    return f"rms {rms:.3g} {shown}, largest {most:.3g} {shown}"


def _worst(painting: Painting) -> str:
    motion = painting.motion
    row = int(painting.table["position_error_m"].argmax())
    return f"{motion.t[row]:.3f} s, line {motion.line[row]}"


def _files(written: Sequence[Path]) -> list[tuple[str, str]]:
    return [("written" if i == 0 else "", str(path)) for i, path in enumerate(written)]

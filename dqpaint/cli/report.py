"""A painting, preview or film -> the tables and warnings that a command prints."""

import math
from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

from dqpaint.cli.terminal import table
from dqpaint.diagnostics import SourceLine, line_name
from dqpaint.language import render
from dqpaint.metrics import all_figures
from dqpaint.motion import Motion, summary_line
from dqpaint.painting import paint, picture
from dqpaint.robots.kinematics import Clamp

if TYPE_CHECKING:
    from dqpaint.painting import preview as previews
    from dqpaint.painting.photos import photo_light

WHITE = 250  # of 255
MOST_NAMED = 3  # limits in the table; all of them are in the warnings
LONGEST_TORQUE_PERIOD = 5e-3  # [s], the 200 Hz of Chandra 2020
WORTH_A_WARNING = 0.01  # of the light
NOTHING = 1e-9  # [mm, deg] is shown as 0


def of_painting(painting: paint.Painting, written: Sequence[Path]) -> str:
    """The table that follows `draw`."""
    figures = painting.metrics.figures
    gains = ", ".join(f"{name} = {_gain(value)}" for name, value in painting.gains.items())
    rows = [
        ("drawing", summary_line(painting.motion)),
        *([("placed", one.statement), ("", one.figures)] if (one := painting.placement) else []),
        ("arm", f"{painting.robot}, {_plant(painting)}"),
        ("controller", f"{painting.controller.name}  {gains}".rstrip()),
        *_disturbed(painting),
        ("position error", _spread(figures, "position_error", "m")),
        ("", f"largest at {_worst(painting)}"),
        ("orientation error", _spread(figures, "orientation_error", "rad")),
        *_commanded(figures),
        *_attenuation(painting),
        *_step_responses(painting),
        *_retiming(painting),
        ("limits", _limits_line(painting)),
        *_walls(painting),
        *_faults(painting),
        *_photos(painting.photos),
        *_reached(painting),
        *_pictures(painting.pictures),
        *_files(written),
    ]
    return table(rows)


def _walls(painting: paint.Painting) -> list[tuple[str, str]]:
    """How near the arm came to each wall, and for how long each held it back."""
    among, rows = painting.track.walls, list[tuple[str, str]]()
    if among is None:
        return rows
    motion = painting.motion
    for wall, unit, distance, active in zip(
        among.walls, among.units, among.distance.T, among.active.T, strict=True
    ):
        k = int(distance.argmin())
        least = distance[k] * (1e3 if unit == "m" else math.degrees(1))
        held = float(active[:-1].sum()) * motion.period
        rows.append((
            "" if rows else "walls",
            f"line {motion.program.line_name(wall.line)}: least distance "
            f"{0.0 if abs(least) < NOTHING else least:.3g} {'mm' if unit == 'm' else 'deg'} at "
            f"{motion.t[k]:.3f} s, " + (f"held the arm for {held:.3g} s" if held else "not met"),
        ))  # fmt: skip
    if among.lost.any():
        lost = painting.metrics.figures["wall_lost_m"] * 1e3
        rows.append(("", f"up to {among.lost.max() * 1e3:.3g} mm/s of the law's velocity given up, "
                     f"{lost:.3g} mm in all"))  # fmt: skip
    return rows


def _plant(painting: paint.Painting) -> str:
    """The plant, and the physics engine that it ran on."""
    return painting.plant + (f" on {painting.engine.title}" if painting.engine else "")


def _disturbed(painting: paint.Painting) -> list[tuple[str, str]]:
    """The disturbances, each with the values that were given."""
    rows: list[tuple[str, str]] = []
    for name, one in painting.disturbances.items():
        given = one.model_dump(exclude_defaults=True)
        values = ", ".join(f"{key} = {_gain(value)}" for key, value in given.items())
        rows.append(("" if rows else "disturbed by", f"{name}  {values or 'nothing'}"))
        if why := painting.without_effect.get(name):
            rows.append(("", f"without effect: {NO_EFFECT}"))
            rows.append(("", why))
    return rows


def _attenuation(painting: paint.Painting) -> list[tuple[str, str]]:
    """The measured attenuation of a disturbance beside the bound of the gains."""
    rows: list[tuple[str, str]] = []
    for part, one in painting.attenuation.items():
        said = f"{part} {one.ratio:.3g} s"
        if one.void and one.bound is not None:
            said += (
                f", bound {one.bound:.3g} s: void, as it is of an arm that follows its commands at "
                f"once, and '{painting.plant}' has springs or servo loops between"
            )
        elif one.bound is not None:
            kept = "holds" if one.bound_holds else f"exceeded, {one.ratio / one.bound:.3g} times"
            if not one.bound_holds and one.in_steps != one.bound:
                steps = f"in steps of {painting.motion.period * 1e3:.4g} ms"
                kept += f"; {steps} " + (f"it is {one.in_steps:.3g} s" if one.in_steps else "none")
            if not one.bound_holds and painting.limits:
                kept += "; commands were clipped"
            if not one.bound_holds and len(painting.disturbances) > 1:
                kept += "; other disturbances contributed"
            said += f", bound {one.bound:.3g} s: {kept}"
        if one.of_gammas is not None and painting.track.pose_disturbance.any():
            said += f"; {one.of_gammas:.3g} of what its gammas allow"
        rows.append(("" if rows else "disturbance", said))
    return rows


def _faults(painting: paint.Painting) -> list[tuple[str, str]]:
    """Why a run is no result; nothing where it is one."""
    faults = painting.judgement.faults
    return [("" if i else "no result", fault.says) for i, fault in enumerate(faults)]


def _retiming(painting: paint.Painting) -> list[tuple[str, str]]:
    """How a drawing was slowed down: as a whole, and at its corners."""
    told = (("retiming", painting.retiming), ("corners", painting.corners))
    return [(name, str(how)) for name, how in told if how is not None]


def _step_responses(painting: paint.Painting) -> list[tuple[str, str]]:
    """Settling time, overshoot and steady error of each step of the reference."""
    rows: list[tuple[str, str]] = []
    where = painting.motion.program.line_name
    for jump in painting.step_responses[:MOST_NAMED]:
        parts = ((jump.translation, 1e3, "mm"), (jump.rotation, math.degrees(1), "deg"))
        for part, scale, unit in parts:
            if not part.size:
                continue
            settled = (
                "never settles" if part.settling is None else f"settles in {part.settling:.3g} s"
            )
            steady = 0.0 if part.steady * scale < NOTHING else part.steady * scale
            rows.append((
                "" if rows else "step response",
                f"step on line {where(jump.line)}: {part.size * scale:.3g} {unit}, {settled}, "
                f"overshoot {part.overshoot:.1%}, steady error {steady:.2g} {unit}",
            ))  # fmt: skip
    return rows


def _commanded(figures: dict[str, float]) -> list[tuple[str, str]]:
    """The integral of the commands, where the joints are known."""
    return [
        ("command", f"{figures[name]:.3g} {known.display_unit}, joints' norm integrated over time")
        for name, known in all_figures().items()
        if known.title == "command" and name in figures
    ]


def _gain(value: Any) -> str:
    if isinstance(value, tuple):
        return f"({', '.join(map(_gain, value))})"
    return value if isinstance(value, str) else f"{value:.4g}"


def of_export(painting: paint.Painting, written: Sequence[Path]) -> str:
    """The table that follows `export`."""
    points = f"{len(painting.motion.t)} points, one every {painting.motion.period * 1e3:g} ms"
    rows = [
        ("drawing", summary_line(painting.motion)),
        *([("placed", one.statement), ("", one.figures)] if (one := painting.placement) else []),
        ("arm", f"{painting.robot}, {_plant(painting)}, {painting.controller.name}"),
        *_retiming(painting),
        ("trajectory", f"{points}; from rest to rest, within the arm's limits"),
        *_files(written),
    ]
    return table(rows)


def of_preview(preview: "previews.Preview", written: Sequence[Path]) -> str:
    """The table that follows `preview`."""
    rows = [("drawing", summary_line(preview.motion)), *_photos(preview.photos)]
    return table([*rows, *_pictures(preview.pictures), *_files(written)])


def _photos(photos: Sequence["photo_light.LitPhoto"]) -> list[tuple[str, str]]:
    """What is expected of photographs, and what they ask of the lamp."""
    rows: list[tuple[str, str]] = []
    for one in photos:
        strokes = f"{one.strokes:,} lit stroke{'' if one.strokes == 1 else 's'}"
        rows += [
            (
                "photo",
                f"{one.photo.name} as {one.photo.style}: expected likeness {one.likeness.ssim:.3f} "
                f"(SSIM of the greys), {one.likeness.rms:.3f} rms",
            ),
            (
                "",
                f"{strokes}, {one.length:.3g} m, {one.photo.detail * 1e3:.2g} mm apart, lamp on "
                f"for {one.seconds:.4g} s",
            ),
            *(
                []
                if one.ideal == one.likeness
                else [
                    ("", f"with a lamp of any power {one.ideal.ssim:.3f}, {one.ideal.rms:.3f} rms")
                ]
            ),
            (
                "",
                f"lamp from {one.least:.2%} to {one.largest:.0%} of its power, 1 : "
                f"{one.largest / max(one.least, 1e-9):.0f}; "
                + (
                    f"{one.steps} steps of the solver in {one.took:.1f} s"
                    if one.steps
                    else "its light was solved before"
                ),
            ),
        ]
    return rows


def _reached(painting: paint.Painting) -> list[tuple[str, str]]:
    """How like photographs are on the path that was reached, before and after `--relight`."""
    rows: list[tuple[str, str]] = []
    for number, before in enumerate(painting.reached):
        said = f"on the path that was reached {before.ssim:.3f}, {before.rms:.3f} rms"
        if painting.relit:
            after = painting.relit[number].likeness
            said += f"; its light solved again for it {after.ssim:.3f}, {after.rms:.3f} rms"
        rows.append(("", said))
    return rows


def of_developed(pictures: Sequence[picture.Picture], written: Sequence[Path]) -> str:
    """The table that follows `develop`."""
    return table([*_pictures(pictures), *_files(written)])


def _pictures(pictures: Sequence[picture.Picture]) -> list[tuple[str, str]]:
    """Light and exposure of the first picture; the others are of the same run."""
    return [("light", light_line(pictures[0])), ("exposure", pictures[0].exposure_text)]


def light_line(shot: picture.Picture) -> str:
    """The shares of the light on the film, lost and occluded, and of white pixels."""
    film, hidden = shot.film, shot.occluded
    emitted = shot.emitted.sum()
    red, green, blue = (shot.image[..., i] >= WHITE for i in range(3))
    white = float((red & green & blue).mean())
    if emitted == 0.0:
        return "none: no lamp shines towards the camera"
    behind = f", {hidden.energy.sum() / emitted:.1%} hidden by the arm" if hidden else ""
    return (
        f"{film.on_film.sum() / emitted:.1%} on film, {film.lost.sum() / emitted:.1%} lost"
        f"{behind}; {white:.2%} of the picture is white"
    )


def notes(motion: Motion) -> list[str]:
    """Warnings about a drawing."""
    return [render(note, motion.program.name, motion.program.text) for note in motion.notes]


def remarks(painting: paint.Painting) -> list[str]:
    """Warnings about a drawing and its run."""
    texts = [f"note: {note}" for note in painting.notes]
    texts += notes(painting.motion)
    for (kind, line), held in _grouped(painting).items():
        joints = "".join(f"\n    {clamp}" for clamp in held)
        where = painting.motion.program.line_name(line)
        texts.append(f"warning: line {where} reaches {kind} limits:{joints}{FIXES[kind]}")
    if not painting.judgement.is_result:
        texts.append(
            f"warning: this run is no result: {painting.judgement.why}\n  = help: {NO_RESULT}"
        )
    period = painting.motion.period
    if painting.track.torques and period > LONGEST_TORQUE_PERIOD * (1 + 1e-9):
        texts.append(
            f"warning: torques are held for {period * 1e3:g} ms; laws that command them are made "
            f"for {LONGEST_TORQUE_PERIOD * 1e3:g} ms (200 Hz) or less"
            "\n  = help: write period 5 ms in the drawing"
        )
    texts += _passed_walls(painting)
    film = painting.picture.film
    lost, emitted = film.lost.sum(), painting.picture.emitted.sum()
    if lost > WORTH_A_WARNING * emitted:
        texts.append(f"warning: {lost / emitted:.0%} of the light fell outside the picture")
    return [*texts, *of_arm(painting.pictures, painting.motion.program.text)]


def _passed_walls(painting: paint.Painting) -> list[str]:
    """A warning for walls that nothing held, or that the arm passed all the same."""
    among = painting.track.walls
    if among is None:
        return []
    passed = [
        painting.motion.program.line_name(wall.line)
        for wall, distance in zip(among.walls, among.distance.T, strict=True)
        if distance.min() < -PASSED
    ]
    if not passed:
        return []
    word = "walls of lines" if len(passed) > 1 else "wall of line"
    why = "a link was inside from the start, or eta times the period is above 1"
    if painting.recording is not None:
        why = "a recorded run is shown as it was"
    elif painting.track.torques:
        why = f"'{painting.controller.name}' commands torques: walls are held for joint rates alone"
    elif "qp" not in painting.resolver:
        why = f"resolver {painting.resolver} does not hold them, qp does"
    help = "say what is kept: for tool" if "inside" in why else "see dqpaint list resolvers"
    return [f"warning: the arm passed the {word} {', '.join(passed)}: {why}\n  = help: {help}"]


def of_arm(pictures: Sequence[picture.Picture], source: str = "") -> list[str]:
    """Warnings about light that the arm occludes, and about an arm that could not be shown.

    `source` is the text of the drawing, if it is known: it names the files that it includes.
    """
    texts: list[str] = []
    for one in pictures:
        seen = f" in {one.name}" if len(pictures) > 1 else ""
        texts += _hidden(one, seen, source)
    return [*texts, *dict.fromkeys(remark for one in pictures for remark in one.remarks)]


def _hidden(shot: picture.Picture, where: str, source: str) -> list[str]:
    """A warning where the arm occludes much of the light."""
    if shot.occluded is None:
        return []
    share = shot.occluded.energy.sum() / (shot.emitted.sum() or 1.0)
    if share <= WORTH_A_WARNING:
        return []
    lines = shot.occluded.lines
    named = ", ".join(
        f"{line_name(source, line)} ({part:.0%})" for line, part in lines[:MOST_NAMED]
    )
    more = f" and {len(lines) - MOST_NAMED} more" if len(lines) > MOST_NAMED else ""
    word = "lines" if len(lines) > 1 else "line"
    return [
        f"warning: the arm hides {share:.0%} of the light{where}: {word} {named}{more}"
        "\n  = help: look from another side (--view), or let it shine through (--no-occlusion)"
    ]


PASSED = 1e-4  # [m, rad] inside a wall is worth a warning
NO_EFFECT = "it moved the tool by less than 1 um and 0.001 deg all along"
NO_RESULT = (
    "its figures say nothing about the law; lower the gains, shorten the period, or draw slower"
)
FIXES = {
    "position": "\n  = help: turn the tool less, or move the drawing with place",
    "speed": "\n  = help: draw it slower (speed, in, samples), or lower the gains",
    "torque": "\n  = help: a lower speed or lower gains need less torque",
}


def _grouped(painting: paint.Painting) -> dict[tuple[str, SourceLine], list[Clamp]]:
    """The limits that were reached, by kind and line, in the order of time."""
    groups: dict[tuple[str, SourceLine], list[Clamp]] = {}
    for clamp in painting.limits:
        groups.setdefault((clamp.kind, clamp.line), []).append(clamp)
    return groups


def _limits_line(painting: paint.Painting) -> str:
    groups = _grouped(painting)
    if painting.recording is not None:
        return "not known of a recorded run"
    if not groups:
        return "none reached"
    where = painting.motion.program.line_name
    parts = (f"{kind} (line {where(line)})" for kind, line in list(groups)[:MOST_NAMED])
    more = f" and {len(groups) - MOST_NAMED} more" if len(groups) > MOST_NAMED else ""
    share = painting.metrics.figures.get("clipped_share", 0.0)
    return f"{', '.join(parts)}{more} clip {share:.1%} of the run: there the arm could not follow"


def _spread(figures: dict[str, float], name: str, unit: str) -> str:
    known = all_figures()[f"{name}_rms_{unit}"]
    rms, most = (figures[f"{name}_{kind}_{unit}"] * known.scale for kind in ("rms", "max"))
    rms, most = (0.0 if value < NOTHING else value for value in (rms, most))
    return f"rms {rms:.3g} {known.display_unit}, largest {most:.3g} {known.display_unit}"


def _worst(painting: paint.Painting) -> str:
    motion = painting.motion
    row = int(painting.table["position_error_m"].argmax())
    return f"{motion.t[row]:.3f} s, line {motion.program.line_name(motion.source.at(row))}"


def _files(written: Sequence[Path]) -> list[tuple[str, str]]:
    return [("written" if i == 0 else "", str(path)) for i, path in enumerate(written)]

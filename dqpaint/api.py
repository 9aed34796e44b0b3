"""The same from Python: `dqpaint.draw("star.traj", controller="hinf")`."""

import sys
from collections.abc import Callable, Mapping
from contextlib import AbstractContextManager, nullcontext
from dataclasses import replace
from os import PathLike
from pathlib import Path
from time import perf_counter
from typing import TYPE_CHECKING, Any, TypeGuard

from dqpaint.core import find_drawing
from dqpaint.errors import DqpaintError, UsageError
from dqpaint.language import Program, read
from dqpaint.outputs import files, registry
from dqpaint.settings import Settings, make_settings

if TYPE_CHECKING:
    from dqpaint.language.writing import builder
    from dqpaint.painting import paint, picture
    from dqpaint.painting import preview as previews
    from dqpaint.render import ArmMotion, SceneArm
    from dqpaint.settings import SettingsFile


def draw(
    drawing: "str | PathLike[str] | builder.Drawing",
    *,
    controller: str | Callable[..., Any] | None = None,
    gains: Mapping[str, float | tuple[float, ...] | str] | None = None,
    robot: str | None = None,
    tool: str | None = None,
    place: str | None = None,
    recorded: str | PathLike[str] | None = None,
    plant: str | None = None,
    disturb: Mapping[str, Mapping[str, float | str]] | None = None,
    seed: int | None = None,
    start: str | None = None,
    null: str | None = None,
    on_limit: str | None = None,
    size: tuple[int, int] | None = None,
    view: str | None = None,
    ev: float | None = None,
    brush: str | None = None,
    pwm: float | None = None,
    exposure: str | None = None,
    look: str | None = None,
    starburst: int | None = None,
    noise: int | None = None,
    colour_by: str | None = None,
    overlay: bool | None = None,
    magnify: float | None = None,
    ghost: bool | str | None = None,
    occlusion: bool | None = None,
    max_samples: int | None = None,
    settings: "str | PathLike[str] | SettingsFile | None" = None,
    progress: Callable[[float], None] = lambda _done: None,
) -> "paint.Painting":
    """Paint a drawing with a simulated arm, as `dqpaint draw` does; nothing is written.

    Args:
        drawing: a .traj file, the name of an example, or a `dqpaint.Drawing`.
        controller: the control law: a name, a file `mylaw.py[:NAME]`, or a function, a class or an
            object of one's own; each run makes an object of the class, or copies the given one.
        gains: of the law, in SI units; the others keep their defaults. A text such as
            "5..20@10%" changes on the way.
        robot: the arm; else the file's robot line, else the iiwa.
        tool: where the light sits on the flange, "X,Y,Z" or "X,Y,Z,ROLL,PITCH,YAW" [m, deg].
        place: "auto" puts the drawing where it fits the arm best.
        recorded: a CSV of a real arm's joints or poses, painted instead of a simulated run.
        plant: how the arm answers, with values as in "compliant:frequency=60".
        disturb: values of disturbances by their names, as in {"twist": {"x": 0.01}}.
        seed: of everything random.
        start: `first` (at the first pose) or `home`.
        null: what a redundant arm does with its freedom: start, home, limits, manipulability or
            none, with a gain as in "limits,gain=3".
        on_limit: `clip` a joint that would pass a limit, `slow` the drawing, or `stop`.
        size: width and height of the picture [px].
        view: front, iso, side, top, or "AZ,EL" in degrees; stereo, orbit; several with commas.
        ev: exposure in stops on top of the automatic one.
        brush: what shines, such as "bar:length=300mm"; else the file's own.
        pwm: frequency at which the lamps are dimmed [Hz]; else they are dimmed evenly.
        exposure: a camera's settings, such as "f/8,iso100,35mm,0.1cd"; else automatic.
        look: how the film is developed.
        starburst: blades of the aperture, for rays round what stands out.
        noise: seed of the sensor's noise; else there is none.
        colour_by: a figure of the run that the colours tell; the scale ends at a round number, or
            where it is said, as in "position-error:20" [mm].
        overlay: whether the asked drawing lies beneath the reached one.
        magnify: how many times as large deviations from the asked path are drawn.
        ghost: whether the arm is in the picture: True as it stood at the end, "motion" as a veil,
            as it moved.
        occlusion: whether the arm's body hides light from the camera; else as `ghost`.
        max_samples: how many samples the drawing may have; 2,000,000, if more are not allowed.
        settings: a file of such choices, TOML, or the JSON summary of a run; what is said here
            wins.
        progress: called while the arm moves, with the part done, 0 to 1.

    Raises:
        DqpaintError: a fault in the drawing, the choices or the run.
    """
    width, height = _width_and_height(size)
    own = None if isinstance(controller, str) else controller
    name = controller if own is None else getattr(own, "__name__", type(own).__name__)
    given, choices = _given(settings), dict(
        controller=name, gains=dict(gains) if gains else None, robot=robot, tool=tool, place=place,
        recorded=None if recorded is None else str(recorded),
        plant=plant,
        disturb={name: dict(values) for name, values in (disturb or {}).items()} or None, seed=seed,
        start=start, null=null, on_limit=on_limit, width=width, height=height, view=view, ev=ev,
        brush=brush, pwm=pwm, exposure=exposure, look=look, starburst=starburst, noise=noise,
        colour_by=colour_by, overlay=overlay, magnify=magnify, ghost=ghost,
        occlusion=occlusion, max_samples=max_samples,
    )  # fmt: skip
    chosen = make_settings(**given.under(choices))
    begin = perf_counter()
    program = _program(drawing)
    seconds = perf_counter() - begin

    # a fault in the text is told before the simulator is loaded
    from dqpaint.controllers.base import make_controller
    from dqpaint.painting import paint

    law = None if own is None else make_controller(own, str(name))
    with _places(drawing):
        painting = paint.paint(program, chosen, progress, law)
    notes = given.remarks(painting.sha256) + painting.notes
    return replace(painting, seconds={"language": seconds, **painting.seconds}, notes=notes)


def save(
    painting: "paint.Painting", out: str | PathLike[str] = ".", what: str = "png,csv,json"
) -> list[Path]:
    """Write the files of a painting, as `dqpaint draw` does.

    Args:
        painting: from `draw`.
        out: a folder (that exists, or ends with a slash), or the stem of the files.
        what: formats, with commas; `dqpaint list formats` tells them.

    Returns:
        The paths of the files.

    Raises:
        DqpaintError: an unknown format, or one that needs what the painting lacks; or the place
            cannot be written. Nothing was changed.
    """
    name = f"{Path(painting.motion.program.name).stem}-{painting.controller.name}"
    writers = registry.choose(what)
    stem = files.stem_for(str(out), name)
    return files.write(stem, registry.make(writers, painting))


def preview(
    drawing: "str | PathLike[str] | builder.Drawing",
    *,
    robot: str | None = None,
    tool: str | None = None,
    size: tuple[int, int] | None = None,
    view: str | None = None,
    ev: float | None = None,
    brush: str | None = None,
    pwm: float | None = None,
    exposure: str | None = None,
    look: str | None = None,
    starburst: int | None = None,
    noise: int | None = None,
    colour_by: str | None = None,
    ghost: bool | None = None,
    max_samples: int | None = None,
    settings: "str | PathLike[str] | SettingsFile | None" = None,
) -> "previews.Preview":
    """The asked pictures of a drawing, without an arm; arguments as those of `draw`.

    With `ghost` the camera leaves room for the arm, as that of `draw` does.
    """
    width, height = _width_and_height(size)
    choices = dict(
        robot=robot, tool=tool, width=width, height=height, view=view, ev=ev, brush=brush, pwm=pwm,
        exposure=exposure, look=look, starburst=starburst, noise=noise, colour_by=colour_by,
        ghost=ghost, max_samples=max_samples,
    )  # fmt: skip
    chosen = make_settings(**_given(settings).under(choices))
    program = _program(drawing)

    from dqpaint.painting import preview as previews

    with _places(drawing):
        return previews.sketch(program, chosen)


def _given(settings: "str | PathLike[str] | SettingsFile | None") -> "SettingsFile":
    from dqpaint.painting import validate
    from dqpaint.settings import SettingsFile, read_given

    if settings is None:
        return SettingsFile()
    return (
        settings
        if isinstance(settings, SettingsFile)
        else read_given(str(settings), validate.check_each)
    )


def _program(drawing: "str | PathLike[str] | builder.Drawing") -> Program:
    return drawing.program() if _is_built(drawing) else read(find_drawing(str(drawing)))


def _places(drawing: "str | PathLike[str] | builder.Drawing") -> AbstractContextManager[None]:
    """What is wrong with a drawing made by calls is told with the call."""
    return drawing.places() if _is_built(drawing) else nullcontext()


def _is_built(drawing: object) -> "TypeGuard[builder.Drawing]":
    """Whether it is a `Drawing`: where nobody has made one, their class need not be read."""
    build = sys.modules.get("dqpaint.language.writing.builder")
    return build is not None and isinstance(drawing, build.Drawing)


def develop(
    film: str | PathLike[str],
    *,
    size: tuple[int, int] | None = None,
    view: str | None = None,
    ev: float | None = None,
    exposure: str | None = None,
    look: str | None = None,
    starburst: int | None = None,
    noise: int | None = None,
    ghost: bool | str | None = None,
    occlusion: bool | None = None,
) -> "list[picture.Picture]":
    """Other pictures of a painting that was saved with `film`, without simulating it.

    Args:
        film: the file; arguments as those of `draw`, and what is not said is as it was.
        size: width and height of the picture [px].
        view: from where; several with commas.
        ev: exposure in stops on top of the automatic one.
        exposure: a camera's settings, or "auto".
        look: how the film is developed.
        starburst: blades of the aperture; 0 for a round one.
        noise: seed of the sensor's noise.
        ghost: whether the arm is in the picture, and how.
        occlusion: whether its body hides light from the camera; else as it was.

    Raises:
        DqpaintError: no film, or a choice that is none.
    """
    from dqpaint.painting import film_file, picture
    from dqpaint.painting import scene as scenes

    scene, before, cast, worked = film_file.read(str(film))
    width, height = _width_and_height(size)
    choices = {
        "width": width, "height": height, "view": view, "ev": ev, "exposure": exposure,
        "look": look, "starburst": starburst, "noise": noise, "ghost": ghost,
        "occlusion": occlusion,
    }  # fmt: skip
    given = {name: value for name, value in choices.items() if value is not None}
    settings = make_settings(**{**before.model_dump(), **given})
    scenes.check_choices(settings)
    staged, remark = _stage(settings, cast)
    with staged as staging:
        pictures = list(picture.photograph(scene, settings, staging, worked))
    return [replace(one, remarks=(*remark, *one.remarks)) for one in pictures]


def _stage(
    settings: Settings, cast: "ArmMotion | None"
) -> "tuple[AbstractContextManager[SceneArm | None], tuple[str, ...]]":
    """The arm of a film, if it is to be seen and is still there; and else what there is to say."""
    if not settings.staged:
        return nullcontext(), ()
    from dqpaint.render import on_stage
    from dqpaint.robots.loading import find_card
    from dqpaint.robots.urdf import prepare

    try:
        if cast is None:
            raise DqpaintError("the film does not say how its joints moved")
        card = find_card(cast.robot)
        if card.joints != cast.posture.shape[1]:
            raise DqpaintError(f"{card.name} has {card.joints} joints, that arm had others")
        prepare(card)
    except DqpaintError as problem:
        return nullcontext(), (
            f"warning: the arm is left out, and what it hides is not traced: {problem}",
        )
    return on_stage(settings, card, cast), ()


def _width_and_height(size: tuple[int, int] | None) -> tuple[int | None, int | None]:
    if size is None:
        return None, None
    if isinstance(size, str) or len(size) != 2:
        raise UsageError(f"size {size!r} is not (width, height) in pixels")
    return size[0], size[1]

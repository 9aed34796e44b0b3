"""A drawing and settings -> paintings, previews, developed pictures and files, from Python."""

import sys
from collections.abc import Callable
from contextlib import AbstractContextManager, nullcontext
from dataclasses import replace
from os import PathLike
from pathlib import Path
from time import perf_counter
from typing import TYPE_CHECKING, TypeGuard, Unpack

from dqpaint.core import find_drawing
from dqpaint.errors import DqpaintError, UsageError
from dqpaint.language import Program, parse, read
from dqpaint.outputs import files, registry
from dqpaint.settings import (
    Code,
    DevelopOptions,
    DrawOptions,
    PreviewOptions,
    Settings,
    SettingsFile,
    keywords,
    make_settings,
    read_choices,
)

if TYPE_CHECKING:
    from dqpaint.language.writing import builder
    from dqpaint.painting import paint, picture
    from dqpaint.painting import preview as previews
    from dqpaint.render import ArmMotion, SceneArm

INLINE = "text.traj"  # what messages and files are called after a drawing given as text


@keywords("draw")
def draw(
    drawing: "str | PathLike[str] | builder.Drawing | None" = None,
    *,
    text: str | None = None,
    settings: "str | PathLike[str] | SettingsFile | None" = None,
    progress: Callable[[float], None] = lambda _done: None,
    formats: str | None = None,
    before: "Callable[[paint.PreparedRun], None]" = lambda _ready: None,
    **options: Unpack[DrawOptions],
) -> "paint.Painting":
    """Paint a drawing with a simulated arm, as `dqpaint draw` does; nothing is written.

    Args:
        drawing: a .traj file, the name of an example, or a `dqpaint.Drawing`.
        text: of a drawing, in its place; files that it names lie in the working folder.
        settings: a file of such choices, TOML, or the JSON summary of a run; keywords here
            win.
        progress: called while the arm moves, with the share done, 0 to 1.
        formats: what will be saved, with commas; a run that cannot be is refused before it begins.
        before: called with what was prepared, before the arm moves.
        options:

    Raises:
        DqpaintError: a fault in the drawing, the choices or the run.
    """
    controller = options.get("controller")
    writers = [] if formats is None else registry.choose_writers(formats)
    own = None if isinstance(controller, str | PathLike) else controller
    if own is not None:
        options["controller"] = getattr(own, "__name__", type(own).__name__)
    given = _given(settings)
    chosen = make_settings(**given.under(options))
    begin = perf_counter()
    program = _program(drawing, text)
    seconds = perf_counter() - begin

    # an error in the text is raised before the simulator is loaded
    from dqpaint.controllers.base import make_controller
    from dqpaint.painting import paint

    def check(ready: paint.PreparedRun) -> None:
        registry.check_before_run(writers, ready)
        before(ready)

    law = None if own is None else make_controller(own, chosen.controller)
    with _places(drawing):
        painting = paint.paint(program, chosen, progress, law, check)
    notes = given.remarks(painting.sha256) + painting.notes
    return replace(painting, seconds={"language": seconds, **painting.seconds}, notes=notes)


def save(
    painting: "paint.Painting", out: str | PathLike[str] = ".", what: str = "png,csv,json"
) -> list[Path]:
    """Write the files of a painting, as `dqpaint draw` does.

    Args:
        painting: from `draw`.
        out: a folder (that exists, or ends with a slash), or the stem of the files.
        what: formats, with commas; `dqpaint list formats` lists them.

    Returns:
        The paths of the files.

    Raises:
        DqpaintError: an unknown format, one that needs what the painting lacks, or a folder
            that cannot be written. Nothing was changed.
    """
    name = f"{Path(painting.motion.program.name).stem}-{painting.controller.name}"
    writers = registry.choose_writers(what)
    stem = files.stem_for(str(out), name)
    return files.write(stem, registry.make_files(writers, painting))


@keywords("preview")
def preview(
    drawing: "str | PathLike[str] | builder.Drawing | None" = None,
    *,
    text: str | None = None,
    settings: "str | PathLike[str] | SettingsFile | None" = None,
    progress: Callable[[float], None] = lambda _done: None,
    **options: Unpack[PreviewOptions],
) -> "previews.Preview":
    """The reference pictures of a drawing, without an arm.

    With `ghost` the camera leaves room for the arm, as that of `draw` does.

    Args:
        drawing: a .traj file, the name of an example, or a `dqpaint.Drawing`.
        text: of a drawing, in its place; files that it names lie in the working folder.
        settings: a file of such choices; keywords here win.
        progress: called while the light of photographs is solved for, with the share done.
        options:

    Raises:
        DqpaintError: a fault in the drawing or the choices.
    """
    chosen = make_settings(**_given(settings, "leave").under(options))
    program = _program(drawing, text)

    from dqpaint.painting import preview as previews

    with _places(drawing):
        return previews.make_preview(program, chosen, progress)


def _given(
    settings: "str | PathLike[str] | SettingsFile | None", code: Code = "run"
) -> SettingsFile:
    if settings is None:
        return SettingsFile()
    from dqpaint.painting import validate

    return validate.settings_file(settings, code)


def _program(drawing: "str | PathLike[str] | builder.Drawing | None", text: str | None) -> Program:
    if (drawing is None) == (text is None):
        raise UsageError("give either a drawing, by its file or name, or the text= of one")
    if text is not None:
        return parse(text, INLINE, Path(INLINE))
    return drawing.program() if _is_built(drawing) else read(find_drawing(str(drawing)))


def _places(drawing: object) -> AbstractContextManager[None]:
    """A context in which errors of a drawing made by calls name the call."""
    return drawing.places() if _is_built(drawing) else nullcontext()


def _is_built(drawing: object) -> "TypeGuard[builder.Drawing]":
    """Whether it is a `Drawing`; the class is not imported where no drawing was made."""
    build = sys.modules.get("dqpaint.language.writing.builder")
    return build is not None and isinstance(drawing, build.Drawing)


@keywords("develop")
def develop(
    film: str | PathLike[str], **options: Unpack[DevelopOptions]
) -> "list[picture.Picture]":
    """Other pictures of a painting that was saved with `film`, without simulating it.

    Args:
        film: the file; options that are not given stay as they were.
        options:

    Raises:
        DqpaintError: not a film, or a wrong choice.
    """
    from dqpaint.painting import film_file, picture
    from dqpaint.painting import scene as scenes

    scene, before, cast, worked = film_file.read(str(film))
    settings = make_settings(
        **{**before.model_dump(exclude={"max_memory"}), **read_choices(options)}
    )
    scenes.check_light_settings(settings)
    staged, remark = _stage(settings, cast)
    with staged as staging:
        pictures = list(picture.photograph(scene, settings, staging, worked))
    return [replace(one, remarks=(*remark, *one.remarks)) for one in pictures]


def _stage(
    settings: Settings, cast: "ArmMotion | None"
) -> "tuple[AbstractContextManager[SceneArm | None], tuple[str, ...]]":
    """The arm of a film if it is to be seen, and a warning where it cannot be."""
    if not settings.staged:
        return nullcontext(), ()
    from dqpaint.render import scene_arm_of_run
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
    return scene_arm_of_run(settings, card, cast), ()

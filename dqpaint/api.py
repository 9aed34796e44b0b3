"""The same from Python: `dqpaint.draw("star.traj", controller="hinf")`."""

from collections.abc import Callable, Mapping
from dataclasses import replace
from os import PathLike
from pathlib import Path
from time import perf_counter
from typing import TYPE_CHECKING, Any

from dqpaint import outputs
from dqpaint.errors import UsageError
from dqpaint.examples import find_drawing
from dqpaint.language import read
from dqpaint.motion import plan
from dqpaint.robots.choose import card_for
from dqpaint.settings import make_settings

if TYPE_CHECKING:
    from dqpaint.paint import Painting
    from dqpaint.picture import Picture


def draw(
    drawing: str | PathLike[str],
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
    size: tuple[int, int] | None = None,
    view: str | None = None,
    ev: float | None = None,
    progress: Callable[[float], None] = lambda _done: None,
) -> "Painting":
    """Paint a drawing with a simulated arm, as `dqpaint draw` does; nothing is written.

    Args:
        drawing: a .traj file, or the name of an example.
        controller: the control law: a name, a file `mylaw.py[:NAME]`, or a function of one's own.
        gains: of the law, in SI units; the others keep their defaults. A text such as
            "5..20@10%" changes on the way.
        robot: the arm; else the file's robot line, else the iiwa.
        tool: where the light sits on the flange, "X,Y,Z" or "X,Y,Z,ROLL,PITCH,YAW" [m, deg].
        place: "auto" puts the drawing where it fits the arm best.
        recorded: a CSV of a real arm's joints or poses, painted instead of a simulated run.
        plant: how the arm answers.
        disturb: values of disturbances by their names, as in {"twist": {"x": 0.01}}.
        seed: of everything random.
        start: `first` (at the first pose) or `home`.
        size: width and height of the picture [px].
        view: front, iso, side, top, or "AZ,EL" in degrees.
        ev: exposure in stops on top of the automatic one.
        progress: called while the arm moves, with the part done, 0 to 1.

    Raises:
        DqpaintError: a fault in the drawing, the choices or the run.
    """
    width, height = _width_and_height(size)
    own = controller if callable(controller) else None
    name = getattr(own, "__name__", "own") if own else controller
    settings = make_settings(
        controller=name, gains=dict(gains) if gains else None, robot=robot, tool=tool, place=place,
        recorded=None if recorded is None else str(recorded),
        plant=plant,
        disturb={name: dict(values) for name, values in (disturb or {}).items()}, seed=seed,
        start=start, width=width, height=height, view=view, ev=ev,
    )  # fmt: skip
    begin = perf_counter()
    program = read(find_drawing(str(drawing)))
    seconds = perf_counter() - begin

    # a fault in the text is told before the simulator is loaded
    from dqpaint.controllers.own import make_controller
    from dqpaint.paint import paint

    law = make_controller(own, str(name)) if own else None
    painting = paint(program, settings, progress, law)
    return replace(painting, seconds={"language": seconds, **painting.seconds})


def save(
    painting: "Painting", out: str | PathLike[str] = ".", what: str = "png,csv,json"
) -> list[Path]:
    """Write the files of a painting, as `dqpaint draw` does.

    Args:
        painting: from `draw`.
        out: a folder (that exists, or ends with a slash), or the stem of the files.
        what: a list of png, csv, json, motion.

    Returns:
        The paths of the files.

    Raises:
        DqpaintError: the place cannot be written; nothing was changed.
    """
    name = f"{Path(painting.motion.program.name).stem}-{painting.controller.name}"
    makers = outputs.choose(what)
    stem = outputs.stem_for(str(out), name)
    return outputs.write(stem, {end: make(painting) for end, make in makers.items()})


def preview(
    drawing: str | PathLike[str],
    *,
    robot: str | None = None,
    tool: str | None = None,
    size: tuple[int, int] | None = None,
    view: str | None = None,
    ev: float | None = None,
) -> "Picture":
    """The asked picture of a drawing, without an arm; arguments as those of `draw`."""
    width, height = _width_and_height(size)
    settings = make_settings(robot=robot, tool=tool, width=width, height=height, view=view, ev=ev)
    program = read(find_drawing(str(drawing)))

    from dqpaint.picture import take

    card = card_for(program, settings.robot, settings.tool)
    motion = plan(program, card.canvas.pose)
    return take(motion, motion.points, settings)


def _width_and_height(size: tuple[int, int] | None) -> tuple[int | None, int | None]:
    if size is None:
        return None, None
    if isinstance(size, str) or len(size) != 2:
        raise UsageError(f"size {size!r} is not (width, height) in pixels")
    return size[0], size[1]

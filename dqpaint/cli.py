"""The command line: arguments in, calls, tables out. No arithmetic, and no early imports.

`--help` and `check` start without the simulator, the kinematics and the image library: each
command imports what it needs.
"""

import json
import os
import shutil
import sys
from typing import Annotated, Any, NoReturn

import typer

from dqpaint import __version__, cli_arm
from dqpaint.cli_options import (
    Disturb,
    Drawing,
    From,
    Gain,
    Law,
    Out,
    PlaceAt,
    PlantName,
    Recorded,
    Robot,
    Seed,
    Tool,
)
from dqpaint.errors import DqpaintError, UsageError

app = typer.Typer(
    add_completion=False,
    rich_markup_mode=None,
    pretty_exceptions_enable=False,
    no_args_is_help=True,
    context_settings={"help_option_names": ["-h", "--help"]},
)

Drawings = Annotated[list[str], typer.Argument(metavar="FILE...", help="drawings, or examples")]
Size = Annotated[str, typer.Option(metavar="WxH", help="of the picture, in pixels")]
View = Annotated[
    str,
    typer.Option(
        metavar="VIEW", help="front, iso, side, top, or AZ,EL: degrees to its right and above"
    ),
]
Ev = Annotated[float, typer.Option(help="exposure in stops, on top of the automatic one")]
Save = Annotated[str, typer.Option(metavar="LIST", help="of png, csv, json, motion")]
AsJson = Annotated[bool, typer.Option("--json", help="for a program to read")]

DEBUG = "DQPAINT_DEBUG"  # an environment variable: internal errors show where they are
INTERRUPTED = 130

DRAW_EXAMPLES = """Examples:

  dqpaint draw star

  dqpaint draw trajectories/lag.traj --controller p --gain k=15 --out pictures/
"""


def _version(wanted: bool) -> None:
    if wanted:
        print(f"dqpaint {__version__}")
        raise typer.Exit()


@app.callback()
def common(
    version: Annotated[
        bool, typer.Option("--version", callback=_version, is_eager=True, help="print it and end")
    ] = False,
) -> None:
    """Light paintings by a simulated robot arm: a short text, a control law, a long exposure."""


@app.command(epilog=DRAW_EXAMPLES)
def draw(
    file: Drawing,
    controller: Law = "hinf",
    gain: Gain = None,
    robot: Robot = None,
    tool: Tool = None,
    place: PlaceAt = None,
    recorded: Recorded = None,
    plant: PlantName = None,
    disturb: Disturb = None,
    seed: Seed = 0,
    start: From = "first",
    size: Size = "1280x720",
    view: View = "front",
    ev: Ev = 0.0,
    out: Out = None,
    save: Save = "png,csv,json",
) -> None:
    """Paint a drawing with an arm: picture, per-step CSV and summary."""
    from dqpaint import api, outputs
    from dqpaint.controllers.own import short_name
    from dqpaint.examples import find_drawing
    from dqpaint.settings import parse_disturbances, parse_gains, parse_size
    from dqpaint.terminal import Progress

    makers = outputs.choose(save)
    path = find_drawing(file)
    stem = outputs.stem_for(
        out, f"{path.stem}-{'recorded' if recorded else short_name(controller)}"
    )
    with Progress(path.name) as progress:
        painting = api.draw(
            path, controller=controller, gains=parse_gains(gain or []), robot=robot,
            tool=tool, place=place, recorded=recorded, plant=plant,
            disturb=parse_disturbances(disturb or []),
            seed=seed, start=start, size=parse_size(size), view=view, ev=ev, progress=progress,
        )  # fmt: skip
    written = outputs.write(stem, {end: make(painting) for end, make in makers.items()})

    from dqpaint import report

    _finish(report.remarks(painting), report.of_painting(painting, written), painting.image)


@app.command(
    epilog="Examples:\n\n  dqpaint preview star\n\n  dqpaint preview helix.traj --view iso"
)
def preview(
    file: Drawing,
    robot: Robot = None,
    tool: Tool = None,
    size: Size = "1280x720",
    view: View = "front",
    ev: Ev = 0.0,
    out: Out = None,
) -> None:
    """Take the asked picture, without an arm, at once; with length, time and brightness."""
    from dqpaint import api, outputs
    from dqpaint.examples import find_drawing
    from dqpaint.settings import parse_size

    path = find_drawing(file)
    stem = outputs.stem_for(out, f"{path.stem}-preview")
    picture = api.preview(path, robot=robot, tool=tool, size=parse_size(size), view=view, ev=ev)
    written = outputs.write(stem, {".png": picture.png})

    from dqpaint import report

    _finish(report.notes(picture.motion), report.of_preview(picture, written), picture.image)


CHECK_EXAMPLES = """Examples:

  dqpaint check drawings/*.traj --json

  dqpaint check star --robot ur5 --place auto
"""


@app.command(epilog=CHECK_EXAMPLES)
def check(
    files: Drawings,
    robot: Robot = None,
    tool: Tool = None,
    place: PlaceAt = None,
    as_json: AsJson = False,
) -> None:
    """Read drawings: every error at its place, or length, time, steps and box.

    With --robot, or a robot line in the file, it also looks ahead, line by line: reach, joint
    limits, speeds, torques, singularities, collisions, and light the arm would hide.
    """
    from dqpaint import checking

    results = [checking.check(name, robot, tool, place) for name in files]
    if as_json:
        print(json.dumps(checking.as_json(results), indent=2))
    else:
        print("\n".join(result.text for result in results))
    if any(result.errors for result in results):
        raise typer.Exit(1)


@app.command(
    "list", epilog="Examples:\n\n  dqpaint list controllers\n\n  dqpaint list robots --json"
)
def list_(
    what: Annotated[
        str,
        typer.Argument(
            metavar="[robots|controllers|plants|disturbances|examples]", help="all, if not said"
        ),
    ] = "all",
    as_json: AsJson = False,
) -> None:
    """Tell what there is to choose from."""
    from dqpaint import listing

    lists = listing.lists(what)
    if as_json:
        found = lists if what == "all" else lists[what]
        print(json.dumps(found, indent=2))
    else:
        print(listing.text(lists))


POSE_EXAMPLES = """Examples:

  dqpaint pose iiwa --deg=0,26,0,-93,0,-29,90

  dqpaint pose viper850 --deg=20,-110,190,25,45,20 --flange --json
"""


@app.command(epilog=POSE_EXAMPLES)
def pose(
    robot: Annotated[str, typer.Argument(metavar="ROBOT", help="its name, or its .urdf or .toml")],
    deg: Annotated[
        str | None, typer.Option(metavar="A,B,...", help="the joints in degrees [default: home]")
    ] = None,
    rad: Annotated[
        str | None, typer.Option(metavar="A,B,...", help="the joints in radians")
    ] = None,
    flange: Annotated[bool, typer.Option("--flange", help="the bare last link, no tool")] = False,
    tool: Tool = None,
    as_json: AsJson = False,
) -> None:
    """Tell where an arm's tool is: dual quaternion, matrix, screw, Jacobian, manipulability."""
    from dqpaint import posing
    from dqpaint.robots.choose import find_card, with_tool

    if flange and tool is not None:
        raise UsageError("--flange leaves the tool out: give it or --tool, not both")
    card = with_tool(find_card(robot), tool)
    posed = posing.pose_arm(card, posing.read_posture(card, deg, rad), flange)
    for kind, sentences in (("note", posed.notes), ("warning", posed.beyond)):
        for sentence in sentences:
            print(f"{kind}: {sentence}", file=sys.stderr)
    print(json.dumps(posing.as_json(posed), indent=2) if as_json else posing.text(posed))


@app.command(epilog="Examples:\n\n  dqpaint gallery\n\n  dqpaint gallery --out pictures")
def gallery(
    out: Annotated[str, typer.Option(metavar="FOLDER", help="where the pictures go")] = "gallery",
) -> None:
    """Make every picture of the gallery again."""
    from dqpaint.gallery import make_gallery

    for path in make_gallery(out):
        print(path)


cli_arm.add_to(app)


def _finish(remarks: list[str], table: str, image: Any) -> None:
    """Say what there is to say, and show the picture to who can see it."""
    from dqpaint.terminal import blocks, shows_pictures

    for text in remarks:
        print(text, file=sys.stderr)
    print(table)
    if shows_pictures(sys.stdout):
        print(blocks(image, shutil.get_terminal_size().columns))


def run() -> None:
    """Answer the arguments of this process; leaves by SystemExit or KeyboardInterrupt."""
    _secure_streams()
    try:
        _answer()
    except OSError as problem:  # of a stream: files have their own errors
        sys.stdout = open(os.devnull, "w")  # noqa: SIM115  nothing more can be said there
        if not isinstance(problem, BrokenPipeError):
            _end(f"error: standard output cannot be written: {problem.strerror}", 1)
        sys.exit(1)


def _answer() -> None:
    try:
        app()
    except UsageError as problem:
        _end(f"usage: {problem}", 2)
    except DqpaintError as problem:
        text = str(problem)
        _end(text if text.startswith(("error[", "warning[")) else f"error: {text}", 1)
    except SystemExit as stop:
        if stop.code == INTERRUPTED:  # typer has met a Ctrl-C
            raise KeyboardInterrupt from None
        sys.stdout.flush()
        raise
    except OSError:
        raise
    except Exception as fault:
        if os.environ.get(DEBUG):
            raise
        _end(f"internal error, please report it: {fault!r}; {DEBUG}=1 shows where", 1)


def _secure_streams() -> None:
    """Streams that are closed become deaf; what an encoding lacks is written as its number."""
    for name in ("stdout", "stderr"):
        stream = getattr(sys, name)
        if stream is None:
            setattr(sys, name, open(os.devnull, "w"))  # noqa: SIM115  for as long as we run
        else:
            stream.reconfigure(errors="backslashreplace")


def _end(text: str, code: int) -> NoReturn:
    print(text, file=sys.stderr)
    sys.exit(code)

"""Arguments of `draw`, `preview`, `develop`, `check`, `list`, `pose`, `gallery` -> files, tables.

`--help` and `check` start without the simulator, the kinematics and the image library: each
command imports what it needs.
"""

import json
import os
import shutil
import sys
from typing import TYPE_CHECKING, Annotated, Any

import typer

from dqpaint import __version__
from dqpaint.cli import export, language, plotting
from dqpaint.cli.language import point_at
from dqpaint.cli.options import (
    Choices,
    Drawing,
    MadeWhenCalled,
    Out,
    Save,
    takes,
)
from dqpaint.core.inputs import send_raw
from dqpaint.errors import UsageError

if TYPE_CHECKING:
    from dqpaint.painting import paint

app = typer.Typer(
    add_completion=False,
    rich_markup_mode=None,
    pretty_exceptions_enable=False,
    no_args_is_help=True,
    context_settings={"help_option_names": ["-h", "--help"]},
)

Drawings = Annotated[
    list[str], typer.Argument(metavar="FILE...", help="drawings, or examples; - reads stdin")
]
AsJson = Annotated[bool, typer.Option("--json", help="as JSON, for programs")]

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
        bool, typer.Option("--version", callback=_version, is_eager=True, help="print the version")
    ] = False,
) -> None:
    """Light paintings by a simulated robot arm: a short text, a control law, a long exposure."""


@app.command(cls=MadeWhenCalled, epilog=DRAW_EXAMPLES)
@takes("draw")
def draw(choices: Choices, file: Drawing, out: Out = None, save: Save = "png,csv,json") -> None:
    """Paint a drawing with an arm: picture, per-step CSV and summary."""
    from dqpaint import api
    from dqpaint.cli.terminal import Progress, note
    from dqpaint.core import find_drawing, short_name
    from dqpaint.outputs import files, registry
    from dqpaint.painting import validate
    from dqpaint.settings import DEFAULT_CONTROLLER

    writers = registry.choose_writers(save)
    path = find_drawing(file)
    given = validate.settings_file(choices.pop("settings", None))
    both = given.under(choices)
    law = "recorded" if both.get("recorded") else both.get("controller", DEFAULT_CONTROLLER)
    stem = files.stem_for(out, f"{path.stem}-{short_name(law)}", note)
    with Progress(path.name) as progress:
        painting = api.draw(
            path, **choices, settings=given, progress=progress, formats=save, before=_tell_place
        )
    with Progress("movie") as progress:
        written = files.write(stem, registry.make_files(writers, painting, progress))

    from dqpaint.cli import report

    _finish(report.remarks(painting), report.of_painting(painting, written), painting.image)


def _tell_place(ready: "paint.PreparedRun") -> None:
    """Say that `place auto` found but a poor place, before the arm moves."""
    placed = ready.prepared.placement
    if placed is not None and placed.is_poor:
        print(f"warning: place auto found {placed.figures}", file=sys.stderr)


@app.command(
    cls=MadeWhenCalled,
    epilog="Examples:\n\n  dqpaint preview star\n\n  dqpaint preview helix.traj --view iso --watch",
)
@takes("preview")
def preview(
    choices: Choices,
    file: Drawing,
    out: Out = None,
    watch: Annotated[
        bool, typer.Option("--watch", help="again at each save, until Ctrl-C")
    ] = False,
) -> None:
    """Make the reference picture without an arm; with length, time and brightness."""
    from dqpaint import api
    from dqpaint.cli.terminal import note
    from dqpaint.core import find_drawing
    from dqpaint.outputs import files

    path = find_drawing(file)
    stem = files.stem_for(out, f"{path.stem}-preview", note)

    def show() -> None:
        preview = api.preview(path, **choices)
        written = files.write_pictures(stem, preview.pictures)

        from dqpaint.cli import report

        _finish(report.notes(preview.motion), report.of_preview(preview, written), preview.image)

    if not watch:
        show()
        return
    from pathlib import Path

    from dqpaint.cli import watch as watching

    settings = choices.get("settings")
    watching.watch(path, show, others=[Path(settings)] if settings else ())


@app.command(
    cls=MadeWhenCalled,
    epilog="Examples:\n\n  dqpaint develop star-hinf-film.npz --look aces --ev 1\n\n"
    "  dqpaint develop star-hinf-film.npz --view iso,orbit:8 --size 640x360 --out round/",
)
@takes("develop", file=False, unsaid=False)
def develop(
    choices: Choices,
    film: Annotated[str, typer.Argument(metavar="FILM", help="from: dqpaint draw --save film")],
    out: Out = None,
) -> None:
    """Make other pictures of a finished painting, without simulating it again."""
    from pathlib import Path

    from dqpaint import api
    from dqpaint.cli.terminal import note
    from dqpaint.outputs import files

    name = Path(film).stem.removesuffix("-film")
    stem = files.stem_for(out, f"{name}-developed", note)
    pictures = api.develop(film, **choices)
    written = files.write_pictures(stem, pictures)

    from dqpaint.cli import report

    _finish(report.of_arm(pictures), report.of_developed(pictures, written), pictures[0].image)


CHECK_EXAMPLES = """Examples:

  dqpaint check drawings/*.traj --json

  dqpaint check star --robot panda --place auto --view iso
"""


@app.command(cls=MadeWhenCalled, epilog=CHECK_EXAMPLES)
@takes("check")
def check(choices: Choices, files: Drawings, as_json: AsJson = False) -> None:
    """Read drawings: every error with its position, or length, time, steps and bounding box.

    With --robot or any other choice of a run, or a robot line in the file, it also looks ahead,
    line by line: reach, joint limits, speeds, torques, singularities, collisions and occlusion.
    """
    # Read when numpy is: no matrix here is large enough for threads, and waiting for work they
    # take a tenth of the time of a long file.
    os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")
    from dqpaint.planning import check as checking

    if choices.keys() - {"max_samples"}:  # of a run; else the validator is not imported
        from dqpaint.painting import validate
        from dqpaint.settings import make_settings

        choices = validate.settings_file(choices.pop("settings", None), runs=False).under(choices)
        validate.check_settings(make_settings(**choices))
    results = [checking.check(name, **choices) for name in files]
    if as_json:
        print(json.dumps(checking.as_json(results), indent=2))
    else:
        print("\n".join(result.text for result in results))
        point_at([finding.code for result in results for finding in result.diagnostics], sys.stdout)
    if any(result.errors for result in results):
        raise typer.Exit(1)


@app.command(
    "list", epilog="Examples:\n\n  dqpaint list controllers\n\n  dqpaint list robots --json"
)
def list_(
    what: Annotated[
        str, typer.Argument(metavar="[robots|controllers|...]", help="which list")
    ] = "all",
    as_json: AsJson = False,
) -> None:
    """List the arms, laws, brushes and all else that an option can name."""
    from dqpaint.cli import listing

    lists = listing.lists(what)
    if as_json:
        found = lists if what == "all" else lists[what]
        print(json.dumps(found, indent=2))
    else:
        print(listing.text(lists))
    for fault in listing.faults(what):
        print(f"warning: {fault}", file=sys.stderr)


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
    flange: Annotated[
        bool, typer.Option("--flange", help="of the last link, without tool")
    ] = False,
    tool: Annotated[
        str | None,
        typer.Option(
            metavar="X,Y,Z[,R,P,Y]", help="in place of the card's, m and deg, or with units"
        ),
    ] = None,
    as_json: AsJson = False,
) -> None:
    """Print the pose of an arm's tool: dual quaternion, matrix, screw; Jacobian, manipulability."""
    from dqpaint.cli import pose as pose_text
    from dqpaint.robots import pose_query
    from dqpaint.robots.loading import find_card, with_tool

    if flange and tool is not None:
        raise UsageError("--flange leaves the tool out: give it or --tool, not both")
    card = with_tool(find_card(robot), tool)
    posed = pose_query.pose_arm(card, pose_query.read_posture(card, deg, rad), flange)
    for kind, sentences in (("note", posed.notes), ("warning", posed.limit_violations)):
        for sentence in sentences:
            print(f"{kind}: {sentence}", file=sys.stderr)
    print(json.dumps(pose_query.as_json(posed), indent=2) if as_json else pose_text.text(posed))


@app.command(epilog="Examples:\n\n  dqpaint gallery\n\n  dqpaint gallery --out pictures")
def gallery(
    out: Annotated[str, typer.Option(metavar="FOLDER", help="where the pictures go")] = "gallery",
) -> None:
    """Make every picture of the gallery again."""
    from dqpaint.studies import gallery

    for path in gallery.make_gallery(out):
        print(path)


export.add_to(app)
plotting.add_to(app)
language.add_to(app)


def _finish(remarks: list[str], table: str, image: Any) -> None:
    """Print warnings and a table, and the picture where the terminal shows colours."""
    from dqpaint.cli.terminal import blocks, shows_pictures

    for text in remarks:
        print(text, file=sys.stderr)
    print(table)
    if shows_pictures(sys.stdout):
        send_raw(blocks(image, shutil.get_terminal_size().columns) + "\n", sys.stdout)

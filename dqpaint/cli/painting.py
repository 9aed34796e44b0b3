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
from dqpaint.clean_stream import send_raw
from dqpaint.cli import export, language, plotting
from dqpaint.cli.front import completion, doctor
from dqpaint.cli.front.colours import findings, labels, show
from dqpaint.cli.front.help_pages import MadeWhenCalled, Page
from dqpaint.cli.front.streams import (
    FORMATS,
    TO_STDOUT,
    USUAL_SAVE,
    check_stdout,
    choose_format,
    is_quiet,
    note,
    one_format,
    remarks,
    send_one,
    tell_annotations,
    tell_result,
)
from dqpaint.cli.language import point_at
from dqpaint.cli.options import FILES, Choices, Drawing, Out, Save, takes
from dqpaint.errors import UsageError

if TYPE_CHECKING:
    from dqpaint.painting import paint

app = typer.Typer(
    rich_markup_mode=None,
    pretty_exceptions_enable=False,
    context_settings={"help_option_names": ["-h", "--help"]},
    epilog="dqpaint draw star\n\ndqpaint list examples\n\ndqpaint draw --help",
)

Drawings = Annotated[
    list[str],
    typer.Argument(
        metavar="FILE...",
        help="drawings, or examples; - reads stdin",
        autocompletion=completion.drawings,
    ),
]
AsJson = Annotated[
    bool, typer.Option("--json", help="as JSON, for programs", rich_help_panel=FILES)
]

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


@app.command(cls=MadeWhenCalled, epilog=DRAW_EXAMPLES, rich_help_panel="Draw")
@takes("draw")
def draw(
    choices: Choices,
    file: Drawing,
    out: Out = None,
    save: Save = USUAL_SAVE,
    as_json: Annotated[
        bool,
        typer.Option("--json", help="print the summary as JSON", rich_help_panel=FILES),
    ] = False,
) -> None:
    """Paint a drawing with an arm: picture, per-step CSV and summary."""
    if out == TO_STDOUT:
        save = one_format(save, as_json)
    from dqpaint import api
    from dqpaint.cli.terminal import Progress
    from dqpaint.core import find_drawing, short_name
    from dqpaint.outputs import WRITERS, files, registry
    from dqpaint.painting import validate
    from dqpaint.settings import DEFAULT_CONTROLLER

    writers = registry.choose_writers(save)
    path = find_drawing(file)
    given = validate.settings_file(choices.pop("settings", None))
    both = given.under(choices)
    law = "recorded" if both.get("recorded") else both.get("controller", DEFAULT_CONTROLLER)
    name = f"{path.stem}-{short_name(law)}"
    stem = None if out == TO_STDOUT else files.stem_for(out, name, note)
    with Progress(path.name) as progress:
        painting = api.draw(
            path, **choices, settings=given, progress=progress, formats=save, before=_tell_place
        )
    with Progress("movie") as progress:
        made = registry.make_files(writers, painting, progress)
    written = files.write(stem, made) if stem else send_one(made)

    from dqpaint.cli import report

    remarks(report.remarks(painting))
    if as_json:
        print(WRITERS["json"].make(painting, progress)[".json"].decode(), end="")
    else:
        _finish(report.of_painting(painting, written), painting.image, stem is None)


def _tell_place(ready: "paint.PreparedRun") -> None:
    """Say that `place auto` found but a poor place, before the arm moves."""
    placed = ready.prepared.placement
    if placed is not None and placed.is_poor:
        remarks([f"warning: place auto found {placed.figures}"])


@app.command(
    cls=MadeWhenCalled,
    epilog="Examples:\n\n  dqpaint preview star\n\n  dqpaint preview helix.traj --view iso --watch",
    rich_help_panel="Draw",
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
    from dqpaint.cli.terminal import Progress
    from dqpaint.core import find_drawing
    from dqpaint.outputs import files

    if out == TO_STDOUT:
        check_stdout()
    path = find_drawing(file)
    stem = None if out == TO_STDOUT else files.stem_for(out, f"{path.stem}-preview", note)

    def show() -> None:
        with Progress(path.name) as progress:
            preview = api.preview(path, **choices, progress=progress)
        made = files.picture_files(preview.pictures)
        written = files.write(stem, made) if stem else send_one(made)

        from dqpaint.cli import report

        remarks(report.notes(preview.motion))
        _finish(report.of_preview(preview, written), preview.image, stem is None)

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
    rich_help_panel="Draw",
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
    from dqpaint.outputs import files

    if out == TO_STDOUT:
        check_stdout()
    name = Path(film).stem.removesuffix("-film")
    stem = None if out == TO_STDOUT else files.stem_for(out, f"{name}-developed", note)
    pictures = api.develop(film, **choices)
    made = files.picture_files(pictures)
    written = files.write(stem, made) if stem else send_one(made)

    from dqpaint.cli import report

    remarks(report.of_arm(pictures))
    _finish(report.of_developed(pictures, written), pictures[0].image, stem is None)


CHECK_EXAMPLES = """Examples:

  dqpaint check drawings/*.traj --json

  dqpaint check star --robot panda --place auto --view iso
"""


@app.command(cls=MadeWhenCalled, epilog=CHECK_EXAMPLES, rich_help_panel="Write")
@takes("check")
def check(
    choices: Choices,
    files: Drawings,
    form: Annotated[
        str,
        typer.Option(
            "--format",
            metavar="|".join(FORMATS),
            help="github and sarif are for code scanners",
            rich_help_panel=FILES,
            autocompletion=completion.one_of(*FORMATS),
        ),
    ] = "text",
    as_json: AsJson = False,
) -> None:
    """Read drawings: every error with its position, or length, time, steps and bounding box.

    With --robot or any other choice of a run, or a robot line in the file, it also looks ahead,
    line by line: reach, joint limits, speeds, torques, singularities, collisions and occlusion.
    """
    # Read when numpy is: no matrix here is large enough for threads, and waiting for work they
    # take a tenth of the time of a long file.
    os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")
    from dqpaint.planning import check as checking

    form = choose_format("json" if as_json else form)

    if choices.keys() - {"max_samples"}:  # of a run; else the validator is not imported
        from dqpaint.painting import validate
        from dqpaint.settings import make_settings

        choices = validate.settings_file(choices.pop("settings", None), "leave").under(choices)
        validate.check_settings(make_settings(**choices))
    results = [checking.check(name, **choices) for name in files]
    if form == "json":
        print(json.dumps(checking.as_json(results), indent=2))
    elif form != "text":
        tell_annotations(checking.annotations(results), form)
    else:
        between = "\n\n" if any(one.diagnostics for one in results) else "\n"
        if told := between.join(filter(None, (one.told(is_quiet()) for one in results))):
            show(told)
        tell_result(checking.count_line(results), findings)
        point_at([finding.code for result in results for finding in result.diagnostics], sys.stdout)
    if any(result.errors for result in results):
        raise typer.Exit(1)


@app.command(
    "list",
    cls=Page,
    epilog="Examples:\n\n  dqpaint list controllers\n\n  dqpaint list robots --json",
    rich_help_panel="Write",
)
def list_(
    what: Annotated[
        str | None,
        typer.Argument(
            metavar="NAME",
            help="which list, or all of them [default: an overview]",
            autocompletion=completion.lists,
        ),
    ] = None,
    as_json: AsJson = False,
) -> None:
    """List the arms, laws, brushes and all else that an option can name."""
    from dqpaint.cli import listing

    everything = what in (None, "all")
    lists = listing.lists(what or "all")
    if as_json:
        print(json.dumps(lists if everything else lists[str(what)], indent=2))
    elif what is None:
        show(listing.overview(lists), painter=labels)
    else:
        show(listing.text(lists), painter=labels)
    remarks(f"warning: {fault}" for fault in listing.faults(what or "all"))


POSE_EXAMPLES = """Examples:

  dqpaint pose iiwa --deg=0,26,0,-93,0,-29,90

  dqpaint pose viper850 --deg=20,-110,190,25,45,20 --flange --json
"""


@app.command(cls=Page, epilog=POSE_EXAMPLES, rich_help_panel="Arms")
def pose(
    robot: Annotated[
        str,
        typer.Argument(
            metavar="ROBOT",
            help="its name, or its .urdf or .toml",
            autocompletion=completion.robots,
        ),
    ],
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
        remarks(f"{kind}: {sentence}" for sentence in sentences)
    if as_json:
        print(json.dumps(pose_query.as_json(posed), indent=2))
    else:
        show(pose_text.text(posed), painter=labels)


@app.command(
    cls=Page,
    epilog="Examples:\n\n  dqpaint gallery\n\n  dqpaint gallery --out pictures",
    rich_help_panel="Draw",
)
def gallery(
    out: Annotated[str, typer.Option(metavar="FOLDER", help="where the pictures go")] = "gallery",
) -> None:
    """Make every picture of the gallery again."""
    from dqpaint.studies import gallery

    for path in gallery.make_gallery(out):
        print(path)


STUDIO_EXAMPLES = """Examples:

  dqpaint studio star

  dqpaint studio lessons/ --present
"""


@app.command(rich_help_panel="Draw", epilog=STUDIO_EXAMPLES)
def studio(
    file: Annotated[
        str | None,
        typer.Argument(metavar="[FILE|FOLDER]", help="a drawing, or the folder of drawings"),
    ] = None,
    port: Annotated[
        int, typer.Option(min=0, max=65535, metavar="PORT", help="0 takes a free one")
    ] = 8470,
    no_open: Annotated[
        bool, typer.Option("--no-open", help="print the address, open no browser")
    ] = False,
    present: Annotated[
        bool, typer.Option("--present", help="for a lecture hall: large, read-only, page by page")
    ] = False,
    law: Annotated[
        list[str] | None,
        typer.Option(metavar="FILE.py[:NAME]", help="a law of one's own to choose; repeatable"),
    ] = None,
) -> None:
    """Open a live page: text, picture, arm, curves and sliders; on this machine alone."""
    from dqpaint.studio import serve

    serve(file, port, law or (), not no_open, present)


export.add_to(app)
plotting.add_to(app)
language.add_to(app)
doctor.add_to(app)


def _finish(table: str, image: Any, aside: bool = False) -> None:
    """Print a table, and the picture where the terminal shows colours.

    Args:
        table: of results.
        image: the picture (H, W, 3).
        aside: whether standard output has the picture, and the table goes to standard error.
    """
    from dqpaint.cli.terminal import blocks, shows_pictures

    tell_result(table, stream=sys.stderr if aside else None)
    if shows_pictures(sys.stdout) and not is_quiet():
        send_raw(blocks(image, shutil.get_terminal_size().columns) + "\n", sys.stdout)

"""The command for real arms: arguments in, calls, text out. `cli` adds it to its own."""

import sys
from typing import Annotated

import typer

from dqpaint.cli.options import (
    Disturb,
    Drawing,
    From,
    Gain,
    Law,
    MaxSamples,
    Null,
    OnLimit,
    Out,
    PlaceAt,
    PlantName,
    Robot,
    Seed,
    Tool,
)


def add_to(app: typer.Typer) -> None:
    """Make the command known."""
    app.command(epilog=EXPORT_EXAMPLES)(export)


EXPORT_EXAMPLES = """Examples:

  dqpaint export star --format ros2

  dqpaint export rose --robot ur5 --format urscript --on-limit slow --out programs/
"""


def export(
    file: Drawing,
    form: Annotated[
        str | None,
        typer.Option("--format", metavar="NAME", help="needed; see: dqpaint list formats"),
    ] = None,
    controller: Law = "hinf",
    gain: Gain = None,
    robot: Robot = None,
    tool: Tool = None,
    place: PlaceAt = None,
    plant: PlantName = None,
    disturb: Disturb = None,
    seed: Seed = 0,
    start: From = "first",
    null: Null = "start",
    on_limit: OnLimit = "clip",
    max_samples: MaxSamples = 2_000_000,
    out: Out = None,
) -> None:
    """Run a drawing as draw does; write the joint trajectory for a real arm, and light cues.

    Refused where a limit was met, or where the arm would have to begin suddenly. Nothing here looks
    after people or machines.
    """
    from dqpaint import api
    from dqpaint.cli.terminal import Progress
    from dqpaint.core import find_drawing, short_name
    from dqpaint.outputs import files, registry
    from dqpaint.settings import parse_disturbances, parse_gains

    writer = registry.choose_form(form)  # an unknown one is told before anything is simulated
    path = find_drawing(file)
    stem = files.stem_for(out, f"{path.stem}-{short_name(controller)}")
    with Progress(path.name) as progress:
        painting = api.draw(
            path, controller=controller, gains=parse_gains(gain or []), robot=robot,
            tool=tool, place=place, plant=plant, disturb=parse_disturbances(disturb or []),
            seed=seed, start=start, null=null, on_limit=on_limit, size=(64, 36),
            max_samples=max_samples, progress=progress,
        )  # fmt: skip
    written = files.write(stem, registry.make([writer], painting))

    from dqpaint.cli import report

    for text in report.remarks(painting):
        print(text, file=sys.stderr)
    print(report.of_export(painting, written))

"""The command for real arms: arguments in, calls, text out. `cli` adds it to its own."""

import sys
from typing import Annotated

import typer

from dqpaint.cli.options import Choices, Drawing, MadeWhenCalled, Out, takes


def add_to(app: typer.Typer) -> None:
    """Make the command known."""
    app.command(cls=MadeWhenCalled, epilog=EXPORT_EXAMPLES)(export)


EXPORT_EXAMPLES = """Examples:

  dqpaint export star --format ros2

  dqpaint export rose --robot ur5 --format urscript --on-limit slow --out programs/
"""


@takes("export")
def export(
    choices: Choices,
    file: Drawing,
    form: Annotated[
        str | None,
        typer.Option("--format", metavar="NAME", help="needed; see: dqpaint list formats"),
    ] = None,
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
    from dqpaint.painting import validate
    from dqpaint.settings import DEFAULT_CONTROLLER

    writer = registry.choose_export_writer(
        form
    )  # an unknown one is told before anything is simulated
    path = find_drawing(file)
    given = validate.settings_file(choices.pop("settings", None))
    law = given.under(choices).get("controller", DEFAULT_CONTROLLER)
    stem = files.stem_for(out, f"{path.stem}-{short_name(law)}")
    with Progress(path.name) as progress:
        painting = api.draw(path, **choices, size=(64, 36), settings=given, progress=progress)
    written = files.write(stem, registry.make_files([writer], painting))

    from dqpaint.cli import report

    for text in report.remarks(painting):
        print(text, file=sys.stderr)
    print(report.of_export(painting, written))

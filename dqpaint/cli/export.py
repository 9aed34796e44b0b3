"""Arguments of `dqpaint export` -> a joint trajectory for a real arm, and a table."""

from typing import Annotated

import typer

from dqpaint.cli.front.help_pages import MadeWhenCalled
from dqpaint.cli.front.streams import note, remarks, tell_result
from dqpaint.cli.options import FILES, Choices, Drawing, Out, takes


def add_to(app: typer.Typer) -> None:
    """Add the command to an application."""
    app.command(cls=MadeWhenCalled, epilog=EXPORT_EXAMPLES, rich_help_panel="Arms")(export)


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
        typer.Option(
            "--format",
            metavar="NAME",
            help="required; see: dqpaint list formats",
            rich_help_panel=FILES,
        ),
    ] = None,
    out: Out = None,
) -> None:
    """Run a drawing as draw does; write the joint trajectory for a real arm, and light cues.

    Refused where a limit was met, or where the arm would have to begin suddenly. dqpaint makes no
    safety checks on real hardware.
    """
    from dqpaint import api
    from dqpaint.cli.terminal import Progress
    from dqpaint.core import find_drawing, short_name
    from dqpaint.outputs import files, registry
    from dqpaint.painting import validate
    from dqpaint.settings import DEFAULT_CONTROLLER

    writer = registry.choose_export_writer(form)  # first: an unknown one is an error at once
    path = find_drawing(file)
    given = validate.settings_file(choices.pop("settings", None))
    law = given.under(choices).get("controller", DEFAULT_CONTROLLER)
    stem = files.stem_for(out, f"{path.stem}-{short_name(law)}", note)
    with Progress(path.name) as progress:
        painting = api.draw(
            path, **choices, size=(64, 36), settings=given, progress=progress, formats=writer.name
        )
    written = files.write(stem, registry.make_files([writer], painting))

    from dqpaint.cli import report

    remarks(report.remarks(painting))
    tell_result(report.of_export(painting, written))

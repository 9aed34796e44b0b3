"""Arguments of `dqpaint plot` -> the curves of a run over time."""

from typing import Annotated

import typer

from dqpaint.cli.front.help_pages import MadeWhenCalled
from dqpaint.cli.front.streams import note, tell_result
from dqpaint.cli.options import FILES, Choices, Out, takes

EXAMPLES = """Examples:

  dqpaint plot lag --controller p --what error,path

  dqpaint plot star-hinf.csv --span 0..2 --scale log --save png,pdf
"""


def add_to(app: typer.Typer) -> None:
    """Add the command to an application."""
    app.command(cls=MadeWhenCalled, epilog=EXAMPLES, rich_help_panel="Compare")(plot)


@takes("plot")
def plot(
    choices: Choices,
    file: Annotated[
        str,
        typer.Argument(metavar="FILE|RUN.csv", help="a drawing, which is run; or the CSV of a run"),
    ],
    what: Annotated[
        str | None,
        typer.Option(
            metavar="A,B,...",
            help="of error, path, speed, joints, commands, torques, motors, effort [default: all]",
        ),
    ] = None,
    scale: Annotated[
        str, typer.Option(metavar="linear|log", help="of errors, speed and effort")
    ] = "linear",
    span: Annotated[
        str | None, typer.Option(metavar="A..B", help="seconds that are shown [default: all]")
    ] = None,
    each: Annotated[
        bool, typer.Option("--each", help="a panel for each joint, in its unit")
    ] = False,
    out: Out = None,
    save: Annotated[
        str, typer.Option(metavar="A,B,...", help="png, pdf, svg", rich_help_panel=FILES)
    ] = "png",
) -> None:
    """Draw a run's curves over time: errors, path, speed, joints and commands with their limits."""
    from pathlib import Path

    from dqpaint.outputs import files
    from dqpaint.studies import plot as plots

    plots.read_forms(save)  # before a run
    made = plots.plot(file, what=what, scale=scale, span=span, each=each, **choices)  # type: ignore[arg-type]
    stem = files.stem_for(out, f"{Path(made.name).name}-plot")
    for text in made.notes:
        note(text)
    tell_result("\n".join(f"  written  {path}" for path in made.save(stem, save)))

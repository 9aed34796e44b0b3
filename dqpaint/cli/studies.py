"""Declarations of studies -> their commands, made when they are called."""

import inspect
import os
import shlex
import shutil
import signal
import sys
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Any

import typer

from dqpaint.cli.front.colours import BOLD, CYAN, paint
from dqpaint.cli.front.help_pages import MadeWhenCalled, Pages
from dqpaint.cli.front.streams import choose_format, note, tell_annotations, tell_result
from dqpaint.cli.options import (
    FILES,
    Choices,
    Command,
    file_parameters,
    listed,
    options,
    parameter,
    with_options,
)
from dqpaint.cli.painting import app

if TYPE_CHECKING:
    from dqpaint.studies.declared import Study

__all__ = ["app"]

BUILT_IN = {
    "compare": "Paint one drawing by several laws, plants, arms or disturbances: pictures, errors,"
    " a table.",
    "sweep": "Run a drawing over one or two axes of values: table, and a curve or a heat map.",
    "tune": "Find the gains with the least error within an effort bound, and the trade-off of the"
    " two.",
    "rehearse": "Draw, learn from the error, draw again: each trial follows a path that the last"
    " one taught.",
    "worst": "Seek the disturbance of a given size that a law answers worst, beside what it"
    " promises.",
    "replay": "Repeat a paper's experiment: its numbers beside ours, and which of its claims hold.",
    "verify": "Draw a folder again and compare it with its references, gate by gate.",
}
"""The first lines of their docstrings: the list of commands imports no study."""

REPORT = typer.Option("--report", help="also write one HTML page of it all", rich_help_panel=FILES)


class CommandsAndStudies(Pages):
    """Commands, and for a name that is none of them the study that a plugin brings."""

    def get_command(self, ctx: Any, cmd_name: str) -> Any:
        """The command of a name; None if there is none."""
        found = super().get_command(ctx, cmd_name)
        if found is not None:
            return found
        from dqpaint.studies.declared import STUDIES

        return MadeWhenCalled(cmd_name, callback=_listed(cmd_name)) if cmd_name in STUDIES else None


def _listed(name: str, about: str = "") -> Command:
    return listed(name, about, partial(_made, name))


def _made(name: str) -> Command:
    """The command of a study."""
    from dqpaint.studies.declared import STUDIES

    kind = STUDIES[name]

    def command(choices: Choices, subject: str, report: bool) -> None:
        _carry_out(name, kind, subject, choices, report)

    about = kind.subject
    default = inspect.Parameter.empty if about.default is None else about.default
    settings = [one for one in kind.settings() if one.keyword not in kind.replaced]
    made = [
        parameter("subject", str, default, typer.Argument(metavar=about.metavar, help=about.help)),
        *options(kind.parameters()),
        parameter("report", bool, False, REPORT),
        *options(settings, kind.defaults, kind.whole),
        *(file_parameters() if kind.whole else []),
    ]
    command.__name__ = name
    command.__doc__ = inspect.getdoc(kind)
    whole = with_options(command, made, [*kind.parameters(), *settings])
    whole.epilog = kind.examples  # type: ignore[attr-defined]
    return whole


def _carry_out(
    name: str, kind: "type[Study]", subject: str, choices: Choices, report: bool
) -> None:
    """Carry a study out, write its files and print its tables, as wide as the terminal."""
    # Read when numpy is: workers compute, and where memory is short OpenBLAS, which takes some for
    # each thread, ends the process.
    os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")
    from dqpaint.studies.declared import run_study

    _end_like_ctrl_c()
    folder = Path(choices.get("folder") or kind.default_folder(name, subject))
    study = run_study(name, subject, choices, folder, StudyProgress())
    for remark in study.remarks:
        note(remark)
    text = study.table_text(shutil.get_terminal_size((100_000, 24)).columns)
    written = study.save(_again(report))
    if (form := choose_format(choices.get("format", "text"))) == "text":
        _finish(text, written)
    else:
        tell_annotations(study.annotations, form)
    if not study.passed:
        raise typer.Exit(1)


def _end_like_ctrl_c() -> None:
    """Let what asks this process to end stop the study as a Ctrl-C does: workers end, runs stay."""

    def stop(number: int, _frame: object) -> None:
        raise KeyboardInterrupt

    for name in ("SIGTERM", "SIGHUP"):
        number = getattr(signal, name, None)
        if number is not None and signal.getsignal(number) != signal.SIG_IGN:  # nohup stays
            signal.signal(number, stop)


class StudyProgress:
    """Progress of a study on a terminal: a bar, and notes on standard error."""

    def __init__(self) -> None:
        self._bar: Any = None

    def begin(self, title: str) -> None:
        """Start a progress bar."""
        from dqpaint.cli.terminal import Progress

        self._bar = Progress(title)

    def show(self, done: float) -> None:
        """Show the share that is done, 0 to 1."""
        self._bar(done)

    def note(self, text: str, aside: bool = False) -> None:
        """Print a note; an aside only to a terminal."""
        if not aside or sys.stderr.isatty():
            note(text)

    def end(self) -> None:
        """Remove the bar."""
        self._bar.__exit__()


def _again(report: bool) -> str | None:
    """The command line, for a report."""
    return shlex.join(["dqpaint", *sys.argv[1:]]) if report else None


def _finish(text: str, paths: list[Path]) -> None:
    """Print the tables and the paths of files, which are written before."""
    for path in paths:
        report = path.with_name(f"{path.name.removesuffix('-table.csv')}-report.html")
        if path.name.endswith("-table.csv") and report not in paths and report.exists():
            note(f"{report} is of an earlier run; --report makes it again")
    tell_result("\n".join([text, *(f"  written  {path}" for path in paths)]), studies_table)


def studies_table(text: str) -> str:
    """The tables of a study, the first line of each bold, and the files written."""
    before, line, blank = [], "", True
    for line in text.split("\n"):
        if line.startswith("  written  "):
            line = f"  {paint('written', CYAN)}{line[9:]}"
        elif blank and line:
            line = paint(line, BOLD)
        blank = not line
        before.append(line)
    return "\n".join(before)


for _name, _about in BUILT_IN.items():
    app.command(cls=MadeWhenCalled, rich_help_panel="Compare")(_listed(_name, _about))
app.info.cls = CommandsAndStudies  # a name that is no command may be a plugin's study

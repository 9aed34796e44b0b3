"""Arguments of `compare`, `sweep`, `tune`, `replay`, `verify` -> files, tables and exit codes."""

import shlex
import shutil
import sys
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from dqpaint.cli.options import Choices, Drawing, MadeWhenCalled, takes
from dqpaint.cli.painting import app

if TYPE_CHECKING:
    from dqpaint.studies.kinds import study_result

__all__ = ["app"]

Runs = Annotated[
    int, typer.Option(metavar="N", help="runs of each choice, with the seeds that follow --seed")
]
Jobs = Annotated[int | None, typer.Option(metavar="N", help="processes [default: all cores]")]
Address = Annotated[
    str | None,
    typer.Option(
        "--cluster", metavar="ADDRESS", help="address of a Dask scheduler, instead of --jobs"
    ),
]
Folder = Annotated[
    str | None,
    typer.Option("--out", metavar="FOLDER", help="folder of the study; a stopped one resumes"),
]
Measure = Annotated[
    str,
    typer.Option(
        "--figure", metavar="NAME", help="figure that is tested and drawn: see dqpaint list figures"
    ),
]

Laws = Annotated[
    str | None,
    typer.Option(
        metavar="A,B(GAIN=VALUE),...", help="the laws, with gains of their own [default: hinf]"
    ),
]
Plants = Annotated[
    str | None, typer.Option(metavar="A,B(KEY=VALUE),...", help="the plants [default: stiff]")
]
Robots = Annotated[str | None, typer.Option(metavar="A,B,...", help="the arms")]
Disturbs = Annotated[
    str | None,
    typer.Option(
        metavar="A(KEY=VALUE),...",
        help="disturbances, one at a time: none,payload(2),payload(2)+latency(3)",
    ),
]
Report = Annotated[bool, typer.Option("--report", help="also write one HTML page of it all")]

COMPARE_EXAMPLES = """Examples:

  dqpaint compare lag --controllers "hinf,p,p(k=5)"

  dqpaint compare lag --controllers hinf,pff --runs 10 --disturb twist=noise,x=0.02,frequency=5
"""


@app.command(cls=MadeWhenCalled, epilog=COMPARE_EXAMPLES)
@takes("compare", without=("controller", "plant", "robot"), usual={"size": "640x360"})
def compare(
    choices: Choices,
    file: Drawing,
    controllers: Laws = None,
    plants: Plants = None,
    robots: Robots = None,
    disturbs: Disturbs = None,
    runs: Runs = 1,
    figure: Measure = "error_integral",
    jobs: Jobs = None,
    cluster: Address = None,
    out: Folder = None,
    report: Report = False,
) -> None:
    """Paint one drawing by several laws, plants, arms or disturbances: pictures, errors, a table.

    With --runs each is done with several seeds, and the table has means and standard deviations.
    """
    from dqpaint.studies.experiment import check_figure, requests
    from dqpaint.studies.kinds import compare as study

    check_figure(figure)
    several = {"controller": controllers, "plant": plants, "robot": robots, "disturb": disturbs}
    axes, base = requests.read_comparison(choices, several, size=study.SIZE)
    compared = study.compare(
        file, axes, base, _folder(out, file, "compare"), runs, requests.workers(jobs, cluster),
        StudyProgress(), figure,
    )  # fmt: skip
    _save(compared, report)


SWEEP_EXAMPLES = """Examples:

  dqpaint sweep star --controller p --vary k=5..400:log:9

  dqpaint sweep star --vary gamma_T=0.01..1:log:5 --vary disturb.twist.x=0,0.01,0.02
"""


@app.command(cls=MadeWhenCalled, epilog=SWEEP_EXAMPLES)
@takes("sweep", without=("controller", "plant", "robot"))
def sweep(
    choices: Choices,
    file: Drawing,
    vary: Annotated[
        list[str] | None,
        typer.Option(
            metavar="NAME=VALUES",
            help="a gain, plant, robot, disturb.NAME.VALUE ...: k=5,10,20 or k=1..100:log:9; "
            "once or twice",
        ),
    ] = None,
    controllers: Laws = None,
    plants: Plants = None,
    robots: Robots = None,
    disturbs: Disturbs = None,
    runs: Runs = 1,
    figure: Measure = "position_error_rms_m",
    jobs: Jobs = None,
    cluster: Address = None,
    out: Folder = None,
    report: Report = False,
) -> None:
    """Run a drawing over one or two axes of values: table, and a curve or a heat map.

    Unstable points are marked. A sweep that was stopped resumes.
    """
    from dqpaint.studies.experiment import check_figure, requests
    from dqpaint.studies.kinds import sweep as study

    check_figure(figure)
    several = {"controller": controllers, "plant": plants, "robot": robots, "disturb": disturbs}
    axes, base = requests.read_sweep(vary or (), choices, several)
    swept = study.sweep(
        file, axes, base, _folder(out, file, "sweep"), runs, requests.workers(jobs, cluster),
        StudyProgress(), figure,
    )  # fmt: skip
    _save(swept, report)


TUNE_EXAMPLES = """Examples:

  dqpaint tune circle --controller p --vary k=2..200 --effort 1.05

  dqpaint tune star --controller hinf --plant compliant --runs 3 --disturb noise=0.0005
"""


@app.command(cls=MadeWhenCalled, epilog=TUNE_EXAMPLES)
@takes("tune")
def tune(
    choices: Choices,
    file: Drawing,
    vary: Annotated[
        list[str] | None,
        typer.Option(
            metavar="GAIN=LOW..HIGH[:lin]",
            help="range of a gain, repeatable "
            "[default: all of the law's, from a tenth to ten times the default value]",
        ),
    ] = None,
    effort: Annotated[
        float,
        typer.Option(metavar="X", help="bound on the effort, times what the drawing itself needs"),
    ] = 1.1,
    runs: Runs = 1,
    figure: Annotated[
        str, typer.Option("--figure", metavar="NAME", help="figure to minimise, as in the JSON")
    ] = "error_integral",
    effort_figure: Annotated[
        str, typer.Option(metavar="NAME", help="figure that is bounded")
    ] = "command_integral_rad",
    budget: Annotated[int, typer.Option(metavar="N", help="largest number of runs")] = 300,
    jobs: Jobs = None,
    cluster: Address = None,
    out: Folder = None,
    report: Report = False,
) -> None:
    """Find the gains with the least error within an effort bound, and the trade-off of the two.

    The bound is 1 for the effort of an arm that follows the drawing exactly. Seeded; a search that
    was stopped resumes.
    """
    from dqpaint.painting import validate
    from dqpaint.studies.experiment import check_figure, requests
    from dqpaint.studies.kinds import tune as study

    check_figure(figure)
    check_figure(effort_figure)
    tuned = study.tune(
        file, vary or [], validate.settings_of_choices(choices), _folder(out, file, "tune"),
        factor=effort,
        error=figure, effort=effort_figure, count=runs, budget=budget,
        jobs=requests.workers(jobs, cluster), reporter=StudyProgress(),
    )  # fmt: skip
    _save(tuned, report)
    if tuned.best is None:
        raise typer.Exit(1)


REPLAY_EXAMPLES = """Examples:

  dqpaint replay thesis-spiral --runs 10

  dqpaint replay ozgur-cost
"""


@app.command(cls=MadeWhenCalled, epilog=REPLAY_EXAMPLES)
@takes("replay", file=False, unsaid=False)
def replay(
    choices: Choices,
    name: Annotated[str, typer.Argument(metavar="NAME", help="see: dqpaint list replays")],
    runs: Annotated[
        int | None,
        typer.Option(metavar="N", help="runs of each choice, with the seeds that follow --seed"),
    ] = None,
    jobs: Jobs = None,
    cluster: Address = None,
    out: Folder = None,
    report: Report = False,
) -> None:
    """Repeat a paper's experiment: its numbers beside ours, and which of its claims hold.

    Every verdict follows from the numbers of this run; the paper's own are judged alike.
    """
    from dqpaint.settings import read_choices
    from dqpaint.studies.experiment import requests
    from dqpaint.studies.kinds import replay as study
    from dqpaint.studies.replay.measures import MeasureRequest

    folder = Path(out) if out else Path(f"{name}-replay")
    crew = requests.workers(jobs, cluster)
    replayed = study.replay(
        name, MeasureRequest(folder, runs, crew, read_choices(choices), StudyProgress())
    )
    _save(replayed, report)


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
            print(f"note: {text}", file=sys.stderr)

    def end(self) -> None:
        """Remove the bar."""
        self._bar.__exit__()


def _folder(out: str | None, file: str, what: str) -> Path:
    return Path(out) if out else Path(f"{Path(file).stem}-{what}")


def _again(report: bool) -> str | None:
    """The command line, for a report."""
    return shlex.join(["dqpaint", *sys.argv[1:]]) if report else None


def _save(study: "study_result.StudyResult", report: bool) -> None:
    """Write the files of a study and print its tables, as wide as the terminal or any pipe."""
    text = study.table_text(shutil.get_terminal_size((100_000, 24)).columns)
    _finish(text, study.save(_again(report)))


def _finish(text: str, paths: list[Path]) -> None:
    """Print the tables and the paths of files, which are written before."""
    for path in paths:
        report = path.with_name(f"{path.name.removesuffix('-table.csv')}-report.html")
        if path.name.endswith("-table.csv") and report not in paths and report.exists():
            print(f"note: {report} is of an earlier run; --report makes it again", file=sys.stderr)
    print("\n".join([text, *(f"  written  {path}" for path in paths)]))


@app.command(
    epilog="Examples:\n\n  dqpaint verify drawings/\n\n  dqpaint verify drawings/ --update"
)
def verify(
    folder: Annotated[
        str,
        typer.Argument(
            metavar="FOLDER", help="folder of drawings (or a cases.toml) and references"
        ),
    ] = ".",
    update: Annotated[
        bool, typer.Option("--update", help="make new references, and list what changed")
    ] = False,
    jobs: Jobs = None,
    cluster: Address = None,
    out: Annotated[
        str, typer.Option(metavar="FOLDER", help="folder for pictures of differences")
    ] = "verify-differences",
    report: Report = False,
) -> None:
    """Draw a folder again and compare it with its references, gate by gate."""
    from dqpaint.studies.experiment import requests
    from dqpaint.studies.kinds import verify as study

    crew = requests.workers(jobs, cluster)
    verdicts = study.verify(Path(folder), crew, lenient=update, reporter=StudyProgress())
    for text in study.remarks(verdicts):
        print(text, file=sys.stderr)
    if update:
        print("\n".join(study.update(verdicts, Path(folder))))
        return
    _finish(study.table_text(verdicts), study.save_differences(verdicts, Path(out), _again(report)))
    if any(verdict.faults for verdict in verdicts):
        raise typer.Exit(1)

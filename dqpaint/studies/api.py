"""Calls from Python -> finished studies: `dqpaint.compare("lag", ["hinf", "p(k=5)"], runs=3)`.

What they return has the table, the pictures and the page of the study, and shows itself in a
notebook. Settings are named as those of `dqpaint.draw`.
"""

import tempfile
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass
from os import PathLike
from pathlib import Path
from typing import Any, Generic, TypeVar, Unpack

import numpy as np
from numpy.typing import NDArray

from dqpaint.language.writing import builder
from dqpaint.light.images import decode_png
from dqpaint.outputs import files
from dqpaint.painting import validate
from dqpaint.settings import (
    DrawOptions,
    ReplayOptions,
    RunOptions,
    SettingsFile,
    keywords,
    read_choices,
)
from dqpaint.studies.experiment import cells, requests
from dqpaint.studies.experiment.requests import Vary, workers
from dqpaint.studies.kinds import compare as comparing
from dqpaint.studies.kinds import replay as replaying
from dqpaint.studies.kinds import sweep as sweeping
from dqpaint.studies.kinds import tune as tuning
from dqpaint.studies.kinds import verify as verifying
from dqpaint.studies.kinds.compare import Comparison
from dqpaint.studies.kinds.replay import Replay
from dqpaint.studies.kinds.study_result import StudyResult
from dqpaint.studies.kinds.sweep import Sweep
from dqpaint.studies.kinds.tuning import Tuning
from dqpaint.studies.kinds.verify import Verdict
from dqpaint.studies.replay.measure import MeasureRequest
from dqpaint.studies.runner.reporter import SILENT, Callback, Reporter

S = TypeVar("S", bound=StudyResult)
Where = str | PathLike[str]
Several = Sequence[str] | str
Progress = Callable[[float], None]


@dataclass(frozen=True, repr=False)
class FinishedStudy(Generic[S]):
    """A finished study.

    Attributes:
        study: its cells and all there is to know of them.
        text: the tables, as the command line has them.
        files: what is saved, by the ends of the names.
        stem: what the names begin with.
    """

    study: S
    text: str
    files: dict[str, bytes]
    stem: str

    @property
    def table(self) -> dict[str, Any]:
        """The columns of the CSV: choices as texts, figures as arrays (N,) in SI units."""
        columns = cells.columns(self.study.cells) if self.study.cells else {}
        numbers = {"runs", "done"} | {n for n in columns if n.endswith(("_mean", "_std"))}
        return {n: np.array(v) if n in numbers else v for n, v in columns.items()}

    @property
    def pictures(self) -> dict[str, NDArray[np.uint8]]:
        """Charts and pictures (H, W, 3) by the ends of their names, such as `sheet`."""
        return {
            end.removesuffix(".png").removeprefix("-"): decode_png(data)
            for end, data in self.files.items()
            if end.endswith(".png")
        }

    @property
    def page(self) -> str:
        """The report as HTML."""
        return self.files["-report.html"].decode()

    def save(self, folder: Where = ".") -> list[Path]:
        """Write all files; returns their paths.

        Raises:
            OutputError: the folder cannot be written.
        """
        return files.write(Path(folder) / self.stem, self.files)

    def __repr__(self) -> str:
        return f"<{type(self.study).__name__} of {self.study.name}: {len(self.study.cells)} cells>"

    def __str__(self) -> str:
        return self.text

    def _repr_markdown_(self) -> str:
        return self.files["-table.md"].decode()


@keywords("compare")
def compare(
    drawing: Where | builder.Drawing,
    controllers: Several | None = None,
    *,
    plants: Several | None = None,
    robots: Several | None = None,
    disturbs: Several | None = None,
    runs: int = 1,
    figure: str = "error_integral",
    folder: Where | None = None,
    jobs: int | None = None,
    cluster: str | None = None,
    progress: Progress | None = None,
    settings: Where | SettingsFile | None = None,
    **options: Unpack[DrawOptions],
) -> FinishedStudy[Comparison]:
    """Paint one drawing by several laws, plants, arms or disturbances, as `dqpaint compare` does.

    The pictures are 640 x 360, if nothing else is said.

    Args:
        drawing: a .traj file, the name of an example, or a `dqpaint.Drawing`.
        controllers: laws, with gains of their own as in "p(k=5)"; a list, or a text with commas.
        plants: how the arm answers, likewise, such as "compliant(frequency=60)".
        robots: the arms.
        disturbs: disturbances, one of them at a time, besides those of `disturb`: "none",
            "payload(2)", "payload(2)+latency(3)".
        runs: how many of each, with the seeds that follow.
        figure: that is tested for differences.
        folder: where the runs are kept, so that a study that was stopped goes on; else nowhere.
        jobs: how many processes; None is one a core.
        cluster: address of a Dask scheduler, instead.
        progress: called with the part done, 0 to 1.
        settings: a file of settings; what is said here wins.
        options:

    Raises:
        DqpaintError: a fault in the drawing, the choices or the folder.
    """
    cells.check_figure(figure)
    several = {"controller": controllers, "plant": plants, "robot": robots, "disturb": disturbs}
    given = {**options, "settings": settings}
    axes, base = requests.read_comparison(given, several, size=comparing.SIZE)
    with _kept(folder) as place:
        made = comparing.compare(
            _name(drawing), axes, base, place, runs, workers(jobs, cluster), _reporter(progress),
            figure,
        )  # fmt: skip
        call = _call(
            "compare", drawing, controllers, plants=plants, robots=robots, disturbs=disturbs,
            runs=runs, figure=figure, **given,
        )  # fmt: skip
        return _finished(made, call)


@keywords("sweep")
def sweep(
    drawing: Where | builder.Drawing,
    vary: Vary = (),
    *,
    controllers: Several | None = None,
    plants: Several | None = None,
    robots: Several | None = None,
    disturbs: Several | None = None,
    runs: int = 1,
    figure: str = "position_error_rms_m",
    folder: Where | None = None,
    jobs: int | None = None,
    cluster: str | None = None,
    progress: Progress | None = None,
    settings: Where | SettingsFile | None = None,
    **options: Unpack[DrawOptions],
) -> FinishedStudy[Sweep]:
    """Run a drawing over one or two axes of values, as `dqpaint sweep` does.

    Args:
        drawing: a .traj file, the name of an example, or a `dqpaint.Drawing`.
        vary: axes, as in "k=5..400:log:7" or {"k": [5, 10, 20]}.
        controllers: an axis of laws, as those of `compare`.
        plants: likewise.
        robots: likewise.
        disturbs: likewise.
        runs: how many of each, with the seeds that follow.
        figure: that is drawn.
        folder: where the runs are kept, so that a study that was stopped goes on; else nowhere.
        jobs: how many processes; None is one a core.
        cluster: address of a Dask scheduler, instead.
        progress: called with the part done, 0 to 1.
        settings: a file of settings; what is said here wins.
        options:

    Raises:
        DqpaintError: a fault in the drawing, the choices or the folder.
    """
    cells.check_figure(figure)
    several = {"controller": controllers, "plant": plants, "robot": robots, "disturb": disturbs}
    given = {**options, "settings": settings}
    axes, base = requests.read_sweep(vary, given, several)
    with _kept(folder) as place:
        made = sweeping.sweep(
            _name(drawing), axes, base, place, runs, workers(jobs, cluster), _reporter(progress),
            figure,
        )  # fmt: skip
        call = _call(
            "sweep", drawing, vary, controllers=controllers, plants=plants, robots=robots,
            disturbs=disturbs, runs=runs, figure=figure, **given,
        )  # fmt: skip
        return _finished(made, call)


@keywords("tune")
def tune(
    drawing: Where | builder.Drawing,
    vary: Vary = (),
    *,
    effort: float = 1.1,
    runs: int = 1,
    figure: str = "error_integral",
    effort_figure: str = tuning.EFFORT,
    budget: int = 300,
    folder: Where | None = None,
    jobs: int | None = None,
    cluster: str | None = None,
    progress: Progress | None = None,
    settings: Where | SettingsFile | None = None,
    **options: Unpack[RunOptions],
) -> FinishedStudy[Tuning]:
    """Seek the gains with the least error within an effort bound, as `dqpaint tune` does.

    Args:
        drawing: a .traj file, the name of an example, or a `dqpaint.Drawing`.
        vary: where gains are sought, as in "k=1..100" or {"k": (1, 100)}; if not given, all of the
            law's.
        effort: at most, times what the drawing itself needs.
        runs: how many of each, with the seeds that follow.
        figure: that is to be small.
        effort_figure: that is bounded.
        budget: the most runs.
        folder: where the runs are kept, so that a study that was stopped goes on; else nowhere.
        jobs: how many processes; None is one a core.
        cluster: address of a Dask scheduler, instead.
        progress: called with the part done, 0 to 1.
        settings: a file of settings; what is said here wins.
        options:

    Returns:
        A study whose `study.best` has the gains in `choice`; None if nothing keeps the bound.

    Raises:
        DqpaintError: a fault in the drawing, the choices or the folder.
    """
    for name in (figure, effort_figure):
        cells.check_figure(name)
    texts = requests.vary_texts(vary, span=True)
    given = {**options, "settings": settings}
    requests.check_named(given.get("controller"))
    with _kept(folder) as place:
        made = tuning.tune(
            _name(drawing), texts, validate.settings_of_choices(given), place, factor=effort,
            error=figure, effort=effort_figure, count=runs, budget=budget,
            jobs=workers(jobs, cluster), reporter=_reporter(progress),
        )  # fmt: skip
        call = _call(
            "tune", drawing, vary, effort=effort, runs=runs, figure=figure,
            effort_figure=effort_figure, budget=budget, **given,
        )  # fmt: skip
        return _finished(made, call)


@keywords("replay")
def replay(
    name: str,
    *,
    runs: int | None = None,
    folder: Where | None = None,
    jobs: int | None = None,
    cluster: str | None = None,
    progress: Progress | None = None,
    **options: Unpack[ReplayOptions],
) -> FinishedStudy[Replay]:
    """Do a paper's experiment again, as `dqpaint replay` does: its numbers beside ours, its claims.

    Args:
        name: of the replay; `dqpaint list replays` tells them.
        runs: how many of each, with the seeds that follow; None leaves it to the replay.
        folder: where the runs are kept, so that a study that was stopped goes on; else nowhere.
        jobs: how many processes; None is one a core.
        cluster: address of a Dask scheduler, instead.
        progress: called with the part done, 0 to 1.
        options:

    Raises:
        DqpaintError: a fault in the choices or the folder, or nothing could be run.
    """
    with _kept(folder) as place:
        request = MeasureRequest(
            place, runs, workers(jobs, cluster), read_choices(options), _reporter(progress)
        )
        made = replaying.replay(name, request)
        return _finished(made, _call("replay", name, runs=runs, **options))


def verify(
    folder: Where = ".",
    *,
    out: Where | None = None,
    jobs: int | None = None,
    cluster: str | None = None,
    progress: Progress | None = None,
) -> list[Verdict]:
    """Draw a folder again and compare it with its references, as `dqpaint verify` does.

    Args:
        folder: of drawings (or a cases.toml) and references.
        out: where pictures of what differs go; else nowhere.
        jobs: how many processes; None is one a core.
        cluster: address of a Dask scheduler, instead.
        progress: called with the part done, 0 to 1.

    Returns:
        A verdict a case; one without `faults` is alike.

    Raises:
        DqpaintError: the folder has no cases, or a reference is damaged.
    """
    crew = workers(jobs, cluster)
    verdicts = verifying.verify(Path(folder), crew, reporter=_reporter(progress))
    if out is not None:
        verifying.save_differences(verdicts, Path(out), _call("verify", Path(folder)))
    return verdicts


def _finished(study: S, call: str) -> FinishedStudy[S]:
    return FinishedStudy(study, study.table_text(), study.contents(call), study.stem)


def _reporter(progress: Progress | None) -> Reporter:
    return SILENT if progress is None else Callback(progress)


def _call(name: str, *given: Any, **choices: Any) -> str:
    """The call, as a report says it; what was left as usual is left out."""
    shown = [str(one) if isinstance(one, Path) else one for one in given]
    words = ["drawing" if isinstance(one, builder.Drawing) else repr(one) for one in shown]
    while words and words[-1] in ("None", "()"):
        words.pop()
    words += [f"{key}={value!r}" for key, value in choices.items() if value is not None]
    return f"dqpaint.{name}({', '.join(words)})"


def _name(drawing: Where | builder.Drawing) -> str | builder.Drawing:
    return drawing if isinstance(drawing, builder.Drawing) else str(drawing)


@contextmanager
def _kept(folder: Where | None) -> Iterator[Path]:
    """The study's folder, or a passing one."""
    if folder is not None:
        yield Path(folder)
        return
    with tempfile.TemporaryDirectory(prefix="dqpaint-study-") as scratch:
        yield Path(scratch)

"""Studies from Python: `dqpaint.compare("lag", ["hinf", "p(k=5)"], runs=3)`.

What they return has the table, the pictures and the page of the study, and shows itself in a
notebook. Settings are named as those of `dqpaint.draw`.
"""

import tempfile
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass
from os import PathLike
from pathlib import Path
from typing import Any, Generic, TypeVar

import numpy as np
from numpy.typing import NDArray

from dqpaint.errors import UsageError
from dqpaint.language.writing import builder
from dqpaint.light.images import decode_png
from dqpaint.outputs import files
from dqpaint.settings import Settings, make_settings
from dqpaint.studies.experiment import cells
from dqpaint.studies.experiment.axes import Axis, parse_axis
from dqpaint.studies.kinds import compare as comparing
from dqpaint.studies.kinds import sweep as sweeping
from dqpaint.studies.kinds import tune as tuning
from dqpaint.studies.kinds import tune_report
from dqpaint.studies.kinds import verify as verifying
from dqpaint.studies.kinds.compare import Comparison
from dqpaint.studies.kinds.sweep import Sweep
from dqpaint.studies.kinds.tune import Tuning
from dqpaint.studies.kinds.verify import Verdict
from dqpaint.studies.runner.engine import Workers

S = TypeVar("S", Comparison, Sweep, Tuning)
Where = str | PathLike[str]
WIDE = 100_000  # columns: a table as wide as it is


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
        columns = cells.columns(self.study.cells)
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
        place = Path(folder)
        place.mkdir(parents=True, exist_ok=True)
        return files.write(place / self.stem, self.files)

    def __repr__(self) -> str:
        return f"<{type(self.study).__name__} of {self.study.name}: {len(self.study.cells)} cells>"

    def __str__(self) -> str:
        return self.text

    def _repr_markdown_(self) -> str:
        return self.files["-table.md"].decode()


def compare(
    drawing: Where | builder.Drawing,
    controllers: Sequence[str] = ("hinf",),
    *,
    plants: Sequence[str] | None = None,
    robots: Sequence[str] | None = None,
    runs: int = 1,
    figure: str = "error_integral",
    size: tuple[int, int] = (640, 360),
    folder: Where | None = None,
    jobs: int | None = None,
    cluster: str | None = None,
    **settings: Any,
) -> FinishedStudy[Comparison]:
    """Paint one drawing by several laws, plants or arms, as `dqpaint compare` does.

    Args:
        drawing: a .traj file, the name of an example, or a `dqpaint.Drawing`.
        controllers: laws, with gains of their own as in "p(k=5)".
        plants: how the arm answers.
        robots: the arms.
        runs: how many of each, with the seeds that follow.
        figure: that is tested for differences.
        size: width and height of the pictures [px].
        folder: where the runs are kept, so that a study that was stopped goes on; else nowhere.
        jobs: how many processes; None is one a core.
        cluster: address of a Dask scheduler, instead.
        settings: as those of `dqpaint.draw`, alike for all runs.

    Raises:
        DqpaintError: a fault in the drawing, the choices or the folder.
    """
    cells.check_figure(figure)
    axes = [
        Axis(name, tuple(_texts(name, values)))
        for name, values in (("controller", controllers), ("plant", plants), ("robot", robots))
        if values is not None
    ]
    base = _settings({**settings, "width": size[0], "height": size[1]})
    with _kept(folder) as place:
        made = comparing.compare(_name(drawing), axes, base, place, runs, _workers(jobs, cluster))
        text = comparing.told(made, figure, WIDE)
        again = _call(
            "compare", drawing, list(controllers), plants=plants, robots=robots, runs=runs,
            figure=figure, size=size, **settings,
        )  # fmt: skip
        files = comparing.contents(made, figure, again)
    return FinishedStudy(made, text, files, comparing.stem(made))


def sweep(
    drawing: Where | builder.Drawing,
    vary: Sequence[str] | str,
    *,
    runs: int = 1,
    figure: str = "position_error_rms_m",
    folder: Where | None = None,
    jobs: int | None = None,
    cluster: str | None = None,
    **settings: Any,
) -> FinishedStudy[Sweep]:
    """Run a drawing over one or two axes of values, as `dqpaint sweep` does.

    Args:
        drawing: a .traj file, the name of an example, or a `dqpaint.Drawing`.
        vary: one or two axes, as in "k=5..400:log:7".
        runs: how many of each, with the seeds that follow.
        figure: that is drawn.
        folder: where the runs are kept; else nowhere.
        jobs: how many processes; None is one a core.
        cluster: address of a Dask scheduler, instead.
        settings: as those of `dqpaint.draw`, such as controller="p".

    Raises:
        DqpaintError: a fault in the drawing, the choices or the folder.
    """
    cells.check_figure(figure)
    axes = [parse_axis(text) for text in ([vary] if isinstance(vary, str) else vary)]
    with _kept(folder) as place:
        made = sweeping.sweep(
            _name(drawing), axes, _settings(settings), place, runs, _workers(jobs, cluster)
        )
        text = sweeping.told(made, figure, WIDE)
        again = _call("sweep", drawing, vary, runs=runs, figure=figure, **settings)
        files = sweeping.contents(made, figure, again)
    return FinishedStudy(made, text, files, sweeping.stem(made))


def tune(
    drawing: Where | builder.Drawing,
    vary: Sequence[str] | str = (),
    *,
    effort: float = 1.1,
    runs: int = 1,
    figure: str = "error_integral",
    effort_figure: str = tuning.EFFORT,
    budget: int = 300,
    folder: Where | None = None,
    jobs: int | None = None,
    cluster: str | None = None,
    **settings: Any,
) -> FinishedStudy[Tuning]:
    """Seek the gains with the least error within an effort bound, as `dqpaint tune` does.

    Args:
        drawing: a .traj file, the name of an example, or a `dqpaint.Drawing`.
        vary: where gains are sought, as in "k=1..100"; if not given, all of the law's.
        effort: at most, times what the drawing itself needs.
        runs: how many of each, with the seeds that follow.
        figure: that is to be small.
        effort_figure: that is bounded.
        budget: the most runs.
        folder: where the runs are kept; else nowhere.
        jobs: how many processes; None is one a core.
        cluster: address of a Dask scheduler, instead.
        settings: as those of `dqpaint.draw`, such as controller="p".

    Returns:
        A study whose `study.best` has the gains in `choice`; None if nothing keeps the bound.

    Raises:
        DqpaintError: a fault in the drawing, the choices or the folder.
    """
    for name in (figure, effort_figure):
        cells.check_figure(name)
    texts = [vary] if isinstance(vary, str) else vary
    with _kept(folder) as place:
        made = tuning.tune(
            _name(drawing), texts, _settings(settings), place, factor=effort, error=figure,
            effort=effort_figure, count=runs, budget=budget, jobs=_workers(jobs, cluster),
        )  # fmt: skip
        text = tune_report.told(made, WIDE)
        again = _call(
            "tune", drawing, vary, effort=effort, runs=runs, figure=figure,
            effort_figure=effort_figure, budget=budget, **settings,
        )  # fmt: skip
        files = tune_report.contents(made, again)
    return FinishedStudy(made, text, files, tune_report.stem(made))


def verify(
    folder: Where = ".",
    *,
    out: Where | None = None,
    jobs: int | None = None,
    cluster: str | None = None,
) -> list[Verdict]:
    """Draw a folder again and compare it with its references, as `dqpaint verify` does.

    Args:
        folder: of drawings (or a cases.toml) and references.
        out: where pictures of what differs go; else nowhere.
        jobs: how many processes; None is one a core.
        cluster: address of a Dask scheduler, instead.

    Returns:
        A verdict a case; one without `faults` is alike.

    Raises:
        DqpaintError: the folder has no cases, or a reference is damaged.
    """
    verdicts = verifying.verify(Path(folder), _workers(jobs, cluster))
    if out is not None:
        verifying.save_differences(verdicts, Path(out), _call("verify", Path(folder)))
    return verdicts


def _call(name: str, *given: Any, **choices: Any) -> str:
    """The call, as a report says it; what was left as usual is left out."""
    shown = [str(one) if isinstance(one, Path) else one for one in given]
    words = ["drawing" if isinstance(one, builder.Drawing) else repr(one) for one in shown]
    words += [f"{key}={value!r}" for key, value in choices.items() if value is not None]
    return f"dqpaint.{name}({', '.join(words)})"


def _name(drawing: Where | builder.Drawing) -> str | builder.Drawing:
    return drawing if isinstance(drawing, builder.Drawing) else str(drawing)


def _texts(name: str, values: Sequence[str]) -> list[str]:
    if isinstance(values, str):
        raise UsageError(f"{name}s {values!r} is one text; a list of names is needed")
    for value in values:
        if not isinstance(value, str):
            raise UsageError(
                f"{name} {value!r} is no name: runs go to other processes, so a law of one's own "
                "is a file, as in 'mylaw.py'"
            )
    if not values or len(set(values)) < len(values):
        raise UsageError(f"{name}s {list(values)}: at least one is needed, and each once")
    return list(values)


def _settings(choices: dict[str, Any]) -> Settings:
    if "controller" in choices:
        _texts("controller", [choices["controller"]])
    return make_settings(**choices)


def _workers(jobs: int | None, cluster: str | None) -> Workers:
    if jobs is not None and cluster is not None:
        raise UsageError("jobs is how many processes here, cluster asks others: not both")
    return jobs if cluster is None else cluster


@contextmanager
def _kept(folder: Where | None) -> Iterator[Path]:
    """The study's folder, or a passing one."""
    if folder is not None:
        yield Path(folder)
        return
    with tempfile.TemporaryDirectory(prefix="dqpaint-study-") as scratch:
        yield Path(scratch)

"""Calls from Python -> finished studies: `dqpaint.compare("lag", ["hinf", "p(k=5)"], runs=3)`.

What they return has the table, the pictures and the page of the study, and shows itself in a
notebook. Parameters and settings are those of the command, as their declaration has them.
"""

import tempfile
from base64 import b64encode
from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import contextmanager
from dataclasses import dataclass
from html import escape
from os import PathLike
from pathlib import Path
from typing import Any, Generic, TypeVar, Unpack

import numpy as np
from numpy.typing import NDArray

from dqpaint.language.writing import builder
from dqpaint.light.images import decode_png
from dqpaint.outputs import files
from dqpaint.settings import SettingsFile, keywords
from dqpaint.studies.declared import STUDIES, run_study
from dqpaint.studies.experiment import cells, runs_table
from dqpaint.studies.experiment.requests import Vary
from dqpaint.studies.kinds import StudyResult
from dqpaint.studies.kinds.compare import Comparison
from dqpaint.studies.kinds.replay import Replay
from dqpaint.studies.kinds.sweep import Sweep
from dqpaint.studies.kinds.tuning import Tuning
from dqpaint.studies.kinds.verify import Verdict, Verification, save_differences
from dqpaint.studies.options import CompareOptions, ReplayOptions, SweepOptions, TuneOptions
from dqpaint.studies.runner.reporter import Callback

S = TypeVar("S", bound=StudyResult)
Where = str | PathLike[str]
Laws = str | Callable[..., Any] | Sequence[str | Callable[..., Any]]
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
        return {n: np.array(v) if not isinstance(v[0], str) else v for n, v in columns.items()}

    @property
    def runs(self) -> dict[str, Any]:
        """The tidy table, a row a run, as `-runs.csv` has it: `pandas.DataFrame(study.runs)`.

        Choices are texts, seeds and figures arrays (R,) in SI units; `status` tells which count.
        """
        columns = runs_table.columns(self.study.cells)
        return {n: np.array(v) if not isinstance(v[0], str) else v for n, v in columns.items()}

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

    def _repr_html_(self) -> str:
        """The tables and all pictures, for a notebook."""
        shown = [
            f'<img alt="{escape(end)}" style="max-width: 100%" '
            f'src="data:image/png;base64,{b64encode(data).decode()}">'
            for end, data in self.files.items()
            if end.endswith(".png")
        ]
        return "\n".join([f"<pre>{escape(self.text)}</pre>", *shown])


@keywords("compare", STUDIES["compare"].parameters())
def compare(
    drawing: Where | builder.Drawing,
    controllers: Laws | None = None,
    *,
    progress: Progress | None = None,
    settings: Where | SettingsFile | None = None,
    **options: Unpack[CompareOptions],
) -> FinishedStudy[Comparison]:
    """Paint one drawing by several laws, plants, arms or disturbances, as `dqpaint compare` does.

    The pictures are 640 x 360, if nothing else is given. Without a `folder` nothing is kept.

    Args:
        drawing: a .traj file, the name of an example, or a `dqpaint.Drawing`.
        controllers: laws, with gains of their own as in "p(k=5)"; a list, or a text with commas.
            Also functions and classes that stand at the top of a file.
        progress: called with the part done, 0 to 1.
        settings: a file of settings; what is given here wins.
        options:

    Raises:
        DqpaintError: a fault in the drawing, the choices or the folder.
    """
    given = {"controllers": controllers, **options, "settings": settings}
    return _finished("compare", drawing, given, progress)


@keywords("sweep", STUDIES["sweep"].parameters())
def sweep(
    drawing: Where | builder.Drawing,
    vary: Vary | None = None,
    *,
    progress: Progress | None = None,
    settings: Where | SettingsFile | None = None,
    **options: Unpack[SweepOptions],
) -> FinishedStudy[Sweep]:
    """Run a drawing over one or two axes of values, as `dqpaint sweep` does.

    Args:
        drawing: a .traj file, the name of an example, or a `dqpaint.Drawing`.
        vary: axes, as in "k=5..400:log:7" or {"k": [5, 10, 20]}.
        progress: called with the part done, 0 to 1.
        settings: a file of settings; what is given here wins.
        options:

    Raises:
        DqpaintError: a fault in the drawing, the choices or the folder.
    """
    given = {"vary": vary, **options, "settings": settings}
    return _finished("sweep", drawing, given, progress)


@keywords("tune", STUDIES["tune"].parameters())
def tune(
    drawing: Where | builder.Drawing,
    vary: Vary | None = None,
    *,
    progress: Progress | None = None,
    settings: Where | SettingsFile | None = None,
    **options: Unpack[TuneOptions],
) -> FinishedStudy[Tuning]:
    """Seek the gains with the least error within an effort bound, as `dqpaint tune` does.

    `study.best` of what is returned has the gains in `choice`; None if nothing keeps the bound.

    Args:
        drawing: a .traj file, the name of an example, or a `dqpaint.Drawing`.
        vary: where gains are sought, as in "k=1..100" or {"k": (1, 100)}; if not given, all of the
            law's, from a tenth to ten times the usual value.
        progress: called with the part done, 0 to 1.
        settings: a file of settings; what is given here wins.
        options:

    Raises:
        DqpaintError: a fault in the drawing, the choices or the folder.
    """
    given = {"vary": vary, **options, "settings": settings}
    return _finished("tune", drawing, given, progress)


@keywords("replay", STUDIES["replay"].parameters())
def replay(
    name: str, *, progress: Progress | None = None, **options: Unpack[ReplayOptions]
) -> FinishedStudy[Replay]:
    """Do a paper's experiment again, as `dqpaint replay` does: its numbers beside ours, its claims.

    Args:
        name: of the replay; `dqpaint list replays` tells them.
        progress: called with the part done, 0 to 1.
        options:

    Raises:
        DqpaintError: a fault in the choices or the folder, or nothing could be run.
    """
    return _finished("replay", name, options, progress)


def study(
    name: str,
    subject: Where | builder.Drawing,
    *,
    progress: Progress | None = None,
    **options: Any,
) -> FinishedStudy[Any]:
    """Carry out a study by its name, such as one of another package.

    Args:
        name: as `dqpaint list studies` has it.
        subject: the drawing, or what else the study is about.
        progress: called with the part done, 0 to 1.
        options: parameters and settings, as `dqpaint NAME --help` has them.

    Raises:
        UsageError: an unknown study or parameter.
        DqpaintError: a fault in the drawing, the choices or the folder.
    """
    return _finished(name, subject, options, progress)


def verify(
    folder: Where = ".",
    *,
    out: Where | None = None,
    jobs: int | None = None,
    cluster: str | None = None,
    trust: bool = False,
    progress: Progress | None = None,
) -> list[Verdict]:
    """Draw a folder again and compare it with its references, as `dqpaint verify` does.

    Args:
        folder: of drawings (or a cases.toml) and references.
        out: where pictures of what differs go; else nowhere.
        jobs: how many processes; None is one a core.
        cluster: address of a Dask scheduler, instead.
        trust: whether cases may name code that lies outside of the folder.
        progress: called with the part done, 0 to 1.

    Returns:
        A verdict a case; one without `faults` is alike.

    Raises:
        DqpaintError: the folder has no cases, or a reference is damaged.
    """
    given = {"jobs": jobs, "cluster": cluster, "trust": trust}
    made = _carried_out("verify", folder, given, Path(), progress)
    assert isinstance(made, Verification)
    if out is not None:
        save_differences(made.verdicts, Path(out), _call("verify", folder, {}))
    return list(made.verdicts)


def _finished(
    name: str,
    subject: Where | builder.Drawing,
    given: Mapping[str, Any],
    progress: Progress | None,
) -> FinishedStudy[Any]:
    """A study with its text and files, which need its folder."""
    with _kept(given.get("folder")) as place:
        made = _carried_out(name, subject, given, place, progress)
        call = _call(name, subject, given)
        return FinishedStudy(made, made.table_text(), made.contents(call), made.stem)


def _carried_out(
    name: str,
    subject: Where | builder.Drawing,
    given: Mapping[str, Any],
    folder: Path,
    progress: Progress | None,
) -> StudyResult:
    about = subject if isinstance(subject, builder.Drawing) else str(subject)
    return run_study(name, about, given, folder, Callback(progress) if progress else None)


OWN_FUNCTIONS = ("compare", "sweep", "tune", "replay", "verify")
NOT_OF_THE_RESULT = ("folder", "jobs", "cluster")


def _call(name: str, subject: Where | builder.Drawing, given: Mapping[str, Any]) -> str:
    """The call, as a report says it; what is not given is left out."""
    words = ["drawing" if isinstance(subject, builder.Drawing) else repr(str(subject))]
    words += [
        f"{key}={_written(value)}"
        for key, value in given.items()
        if value is not None and key not in NOT_OF_THE_RESULT
    ]
    if name in OWN_FUNCTIONS:
        return f"dqpaint.{name}({', '.join(words)})"
    return f"dqpaint.study({', '.join([repr(name), *words])})"


def _written(value: object) -> str:
    """A value as it is written in a call."""
    if isinstance(value, list | tuple):
        return f"[{', '.join(map(_written, value))}]"
    return str(getattr(value, "__name__", repr(value)))


@contextmanager
def _kept(folder: Where | None) -> Iterator[Path]:
    """The study's folder, or a passing one."""
    if folder is not None:
        yield Path(folder)
        return
    with tempfile.TemporaryDirectory(prefix="dqpaint-study-") as scratch:
        yield Path(scratch)

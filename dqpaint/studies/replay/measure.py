"""The request and the result of a replay's measure, and the registry of measures."""

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from dqpaint.core import Registry
from dqpaint.errors import UsageError
from dqpaint.settings import SETTINGS
from dqpaint.studies.experiment.cells import Cell
from dqpaint.studies.replay.claims import Numbers
from dqpaint.studies.replay.papers import Paper
from dqpaint.studies.report.page import Pictured
from dqpaint.studies.runner.engine import Workers
from dqpaint.studies.runner.reporter import SILENT, Reporter


@dataclass(frozen=True)
class MeasureRequest:
    """What a person asked for.

    Attributes:
        folder: of the study.
        runs: how many of each, with the seeds that follow; None leaves it to the replay.
        jobs: how many processes, None is one a core; or the address of a Dask cluster.
        settings: that take the place of the paper's, by their names.
        reporter: is told how far it is.
    """

    folder: Path
    runs: int | None = None
    jobs: Workers = None
    settings: Mapping[str, Any] = field(default_factory=dict)
    reporter: Reporter = SILENT

    def nothing_but(self, paper: Paper, *names: str) -> None:
        """Refuse all settings but some; and runs and workers, for such a replay has no study.

        Raises:
            UsageError: one of them was given.
        """
        given = set(self.settings) - set(names)
        given |= {"runs"} if self.runs is not None else set()
        given |= {"cluster" if isinstance(self.jobs, str) else "jobs"} if self.jobs else set()
        for name in ("runs", "jobs", "cluster", *self.settings):
            if name in given:
                option = SETTINGS[name].name if name in SETTINGS else name
                raise UsageError(f"replay '{paper.name}' takes no --{option}: {paper.title}")


@dataclass(frozen=True)
class MeasureResult:
    """What came out here.

    Attributes:
        numbers: by the names of cell and figure, SI units.
        ours: on what it was measured, in words, a line for each group of cells.
        lost: why a cell has no numbers, or ones that say nothing, by its name.
        shown: charts, maps and pictures, by the ends of their names.
        cells: of a study, with every run; for a table of all figures.
        departures: what a person chose instead of what the replay's file says.
    """

    numbers: Numbers
    ours: str
    lost: Mapping[str, str] = field(default_factory=dict)
    shown: Mapping[str, Pictured] = field(default_factory=dict)
    cells: tuple[Cell, ...] = ()
    departures: tuple[str, ...] = ()


Measure = Callable[[Paper, MeasureRequest], MeasureResult]
MEASURES: Registry[Measure] = Registry("kind of replay")

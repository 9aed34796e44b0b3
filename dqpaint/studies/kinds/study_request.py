"""What a caller asks of a study besides its parameters -> its drawing, settings and runs."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from dqpaint.language.writing import builder
from dqpaint.painting import validate
from dqpaint.settings import Settings
from dqpaint.studies.experiment import requests
from dqpaint.studies.experiment.cells import Cell, run_cells
from dqpaint.studies.runner.engine import Workers, carry_out_study
from dqpaint.studies.runner.reporter import SILENT, Reporter
from dqpaint.studies.runner.run import Run, drawing_text, repeated


@dataclass(frozen=True)
class StudyRequest:
    """What a caller asks of a study besides its parameters.

    Attributes:
        study: its name.
        subject: the drawing: a file, an example's name, or one made by calls; or what else the
            study is about.
        choices: settings by their names in Python, with a file of them as `settings`.
        folder: of the study's journal and files.
        jobs: how many processes, None is one a core; or the address of a Dask cluster.
        reporter: shows how far the study is.
    """

    study: str
    subject: str | builder.Drawing
    choices: Mapping[str, Any]
    folder: Path
    jobs: Workers = None
    reporter: Reporter = SILENT

    @property
    def drawing(self) -> tuple[str, str]:
        """Path and text of the drawing; DqpaintError."""
        return drawing_text(self.subject)

    def settings(self, **defaults: Any) -> Settings:
        """The settings of the choices, and defaults where they say nothing; DqpaintError."""
        return validate.settings_of_choices(requests.named_law(self.choices), **defaults)

    def cells(
        self, choices: Sequence[dict[str, str]], runs: Sequence[Run], count: int
    ) -> tuple[Cell, ...]:
        """Carry out runs, each `count` times with the seeds that follow: a cell a choice.

        Raises:
            DqpaintError: a run is at fault before it begins, or the folder.
        """
        return run_cells(choices, repeated(list(runs), count), self._carry_out)

    def _carry_out(self, runs: list[Run]) -> Any:
        return carry_out_study(runs, self.folder, self.jobs, self.study, self.reporter)

"""The cells of a study -> its tables and files: what every kind of study has in common."""

from abc import ABC, abstractmethod
from dataclasses import dataclass
from pathlib import Path

from dqpaint.outputs import files
from dqpaint.settings import Settings
from dqpaint.studies.experiment.cells import Cell
from dqpaint.studies.report.page import Block, Page, html

ANY_WIDTH = 100_000  # characters: a table as wide as it is


@dataclass(frozen=True, kw_only=True)
class StudyResult(ABC):
    """A finished study.

    Attributes:
        name: of the drawing, or of the replay.
        cells: one a choice, with its runs; none where nothing was run.
        folder: of the journal and of the files.
        settings: that all runs have in common; None where they have none.
        text: of the drawing.
    """

    name: str
    cells: tuple[Cell, ...]
    folder: Path
    settings: Settings | None = None
    text: str = ""

    @property
    def stem(self) -> str:
        """The first part of the files' names."""
        return Path(self.name).stem

    @property
    @abstractmethod
    def title(self) -> str:
        """The heading of its pages."""

    @abstractmethod
    def table_text(self, width: int = ANY_WIDTH) -> str:
        """The tables as text of at most so many characters a line, where that is possible.

        Raises:
            UsageError: a figure that no run has.
            DqpaintError: every run failed.
        """

    @abstractmethod
    def files_and_blocks(self) -> tuple[dict[str, bytes], list[Block]]:
        """Charts and tables by the ends of their names, and what the page of the study shows."""

    def contents(self, command: str | None = None) -> dict[str, bytes]:
        """All files by the ends of their names.

        Args:
            command: the command or call that makes them again, for a page; None for no page.
        """
        made, blocks = self.files_and_blocks()
        if command is not None:
            page = Page(self.title, blocks, self.settings, self.text, command)
            made["-report.html"] = html(page)
        return made

    def save(self, command: str | None = None) -> list[Path]:
        """Write the files, as `contents` has them; returns their paths.

        Raises:
            OutputError: the folder cannot be written.
        """
        return files.write(self.folder / self.stem, self.contents(command))

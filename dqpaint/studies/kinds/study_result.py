"""The cells of a study -> its tables and files: what every kind of study has in common."""

from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path

from dqpaint.core import tables
from dqpaint.diagnostics import Annotation
from dqpaint.outputs import files
from dqpaint.settings import Settings
from dqpaint.studies.experiment import cells, runs_table
from dqpaint.studies.experiment.cells import Cell
from dqpaint.studies.report import latex
from dqpaint.studies.report.page import Block, Page, Pictured, Rows, Words, files_of, html

ANY_WIDTH = 100_000  # characters: a table as wide as it is


@dataclass(frozen=True, kw_only=True)
class StudyResult:
    """A finished study; a kind of study shows more than the table of its cells.

    Attributes:
        name: of the drawing, or of the replay.
        cells: one a choice, with its runs; none where nothing was run.
        folder: of the journal and of the files.
        settings: that all runs have in common; None where they have none.
        text: of the drawing.
        formats: files besides the usual ones: tex, pdf, svg.
    """

    name: str
    cells: tuple[Cell, ...]
    folder: Path
    settings: Settings | None = None
    text: str = ""
    formats: tuple[str, ...] = ()

    @property
    def stem(self) -> str:
        """The first part of the files' names."""
        return Path(self.name).stem

    @property
    def title(self) -> str:
        """The heading of its pages."""
        return self.name

    @property
    def remarks(self) -> list[str]:
        """What else is to be said, a sentence each."""
        return []

    @property
    def hidden(self) -> list[str]:
        """What its means do not show: runs that are no results, and clipped ones; lines of text."""
        return cells.what_means_hide(self.cells)

    @property
    def passed(self) -> bool:
        """Whether it came to what was asked; else the command ends with exit code 1."""
        return True

    @property
    def annotations(self) -> list[Annotation]:
        """Why it did not pass, for code scanners."""
        return []

    def shown(self) -> Mapping[str, Pictured]:
        """Charts and pictures by the ends of their names."""
        return {}

    def table_text(self, width: int = ANY_WIDTH) -> str:
        """The tables as text of at most so many characters a line, where that is possible.

        Raises:
            UsageError: a figure that no run has.
            DqpaintError: every run failed.
        """
        if not any(result.figures for cell in self.cells for result in cell.results):
            raise cells.every_run_failed(self.cells)
        return "\n".join([*tables.fit(cells.rows(self.cells), width), *self.hidden])

    def files_and_blocks(self) -> tuple[dict[str, bytes], list[Block]]:
        """Charts and tables by the ends of their names, and what the page of the study shows."""
        rows, shown = cells.rows(self.cells), self.shown()
        made = {
            **files_of(shown, self.formats),
            "-table.csv": cells.csv(self.cells),
            "-table.md": tables.page(self.title, tables.markdown(rows), *self.hidden_block),
        }
        blocks = [Words("\n".join(self.hidden)), *shown.values()]
        return made, [*blocks, Rows("All cells", rows, note=cells.figure_meanings())]

    @property
    def hidden_block(self) -> list[str]:
        """The same as a block of a page in Markdown, if there is any."""
        return ["```\n" + "\n".join(self.hidden) + "\n```"] if self.hidden else []

    def contents(self, command: str | None = None) -> dict[str, bytes]:
        """All files by the ends of their names.

        Args:
            command: the command or call that makes them again, for a page; None for no page.
        """
        made, blocks = self.files_and_blocks()
        if any(cell.runs for cell in self.cells):
            made["-runs.csv"] = runs_table.csv(self.cells)
        if "tex" in self.formats:
            several = [block for block in blocks if isinstance(block, Rows)]
            made["-table.tex"] = latex.tables([(one.title, one.lines) for one in several])
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

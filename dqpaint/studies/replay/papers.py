"""A TOML file of a replay -> a paper's experiment, its numbers and its claims.

A new replay of a drawing under some laws is a new file here alone. One that measures something else
names its own `measure`, see `dqpaint.studies.replay.measures`. Numbers are the papers'; what they
are compared with is worked out anew by every replay.
"""

import tomllib
from pathlib import Path
from typing import Any, Literal

from pydantic import BaseModel, ConfigDict, Field, model_validator

from dqpaint.core import find_drawing
from dqpaint.errors import UnknownNameError

Kind = Literal["order", "spread", "ratio", "alike", "equals", "below", "trend"]


class _Data(BaseModel):
    model_config = ConfigDict(extra="forbid", frozen=True)


class Figure(_Data):
    """A figure that is compared: its name in a summary, and what the paper calls it."""

    name: str
    says: str
    paper: str = ""


class Cell(_Data):
    """One row of a paper's table.

    Attributes:
        name: what claims call it.
        settings: what is run for it.
        table: where its numbers stand.
        published: by the name of the figure a number, or mean and standard deviation.
        elsewhere: numbers that follow from another place of the paper: `equals` holds the published
            ones against them, as it holds ours against the published ones.
        group: cells of different groups cannot but differ: pairs of them show nothing.
        drawing: of this cell, if it is not the replay's.
    """

    name: str
    settings: dict[str, Any] = Field(default_factory=dict)
    table: str = ""
    published: dict[str, float | tuple[float, float]] = Field(default_factory=dict)
    elsewhere: dict[str, float] = Field(default_factory=dict)
    group: str = ""
    drawing: str = ""


class Claim(_Data):
    """Something that can be true of a table of numbers, the paper's and ours alike.

    Attributes:
        says: it in words.
        kind: `order`: the cells' means rise from the first to the last. `spread`: so do their
            standard deviations. `ratio`: the first is `value` times the second. `alike`: all are
            within `tolerance` of the first. `equals`: each is `value`, or without one the paper's
            number. `below`: each is at most `value`. `trend`: the figure goes `way` along `axis`
            from each cell of a grid to the next.
        figure: of which numbers, by its name.
        cells: by their names.
        value: what a ratio, a bound or a number is.
        tolerance: of `ratio` and `alike` as a part, of `equals` in the figure's unit.
        axis: of a trend.
        way: of a trend.
        where: the paper says so; empty for what is ours.
        means: what follows if it holds, in a sentence; {here} is the number found here.
    """

    says: str
    kind: Kind
    figure: str
    cells: tuple[str, ...] = ()
    value: float = 1.0
    tolerance: float = 0.0
    axis: str = ""
    way: Literal["rises", "falls"] = "rises"
    where: str = ""
    means: str = ""

    @property
    def stated(self) -> float | None:
        """The value, if one is given."""
        return self.value if "value" in self.model_fields_set else None


class Fitted(_Data):
    """A value of a plant that is fitted: where it begins, and its open bounds."""

    start: float
    low: float
    high: float


class Fit(_Data):
    """A plant that is fitted to some rows of a paper's tables.

    Attributes:
        cells: the rows, by their names.
        figures: their numbers.
        plant: its text, with the names of the parameters in braces.
        parameters: by their names.
    """

    cells: tuple[str, ...]
    figures: tuple[str, ...]
    plant: str
    parameters: dict[str, Fitted]


class Paper(_Data):
    """A paper's experiment.

    Attributes:
        name: of the replay.
        title: what is done, in a line.
        source: author, year, section and tables.
        theirs: on what it was measured.
        measure: how ours is, by its name in `dqpaint.studies.replay.measures`.
        runs: how often theirs was repeated.
        drawing: a file beside this one, or an example.
        settings: what all runs have in common.
        axes: of a grid of cells, by the name of a gain.
        grid_drawing: of the grid, if it has another one.
        grid_settings: what all cells of the grid have in common.
        figures: the columns.
        cells: the rows.
        cells_from: the replay that has them, if they are not here.
        fit: of a plant to some of them, for the measure `identified`.
        claims: what is looked at.
        curves: cells whose first runs are shown over time, by the paper's figure.
        assumed: what the paper leaves open and a run needs all the same.
        open: what cannot be tested, and why.
    """

    name: str
    title: str
    source: str
    theirs: str
    measure: str = "tracking"
    runs: int = 1
    drawing: str = ""
    settings: dict[str, Any] = Field(default_factory=dict)
    axes: dict[str, tuple[float, ...]] = Field(default_factory=dict)
    grid_drawing: str = ""
    grid_settings: dict[str, Any] = Field(default_factory=dict)
    figures: tuple[Figure, ...]
    cells: tuple[Cell, ...] = ()
    cells_from: str = ""
    fit: Fit | None = None
    claims: tuple[Claim, ...]
    curves: dict[str, tuple[str, ...]] = Field(default_factory=dict)
    assumed: tuple[str, ...] = ()
    open: tuple[str, ...]

    @model_validator(mode="after")
    def _is_whole(self) -> "Paper":
        """Claims and numbers name cells and figures that are there."""
        cells = [cell.name for cell in self.cells]
        figures = {figure.name for figure in self.figures}
        if len(set(cells)) < len(cells):
            raise ValueError("a cell is there twice")
        for cell in self.cells:
            if not {*cell.published, *cell.elsewhere} <= figures:
                raise ValueError(f"cell '{cell.name}' has a number of no figure")
            if cell.published and not cell.table:
                raise ValueError(f"cell '{cell.name}' does not say where its numbers stand")
        shown = {name for names in self.curves.values() for name in names}
        if not shown <= set(cells):
            raise ValueError("a curve is of a cell that is not there")
        for claim in self.claims:
            if not set(claim.cells) <= set(cells) or claim.figure not in figures:
                raise ValueError(f"claim '{claim.says}' names a cell or figure that is not there")
            if claim.kind == "trend" and claim.axis not in self.axes:
                raise ValueError(f"claim '{claim.says}' names an axis that is not there")
        if self.fit and not (
            set(self.fit.cells) <= set(cells) and set(self.fit.figures) <= figures
        ):
            raise ValueError("fit names a cell or figure that is not there")
        return self


def paper_names() -> list[str]:
    """The names of all replays."""
    return sorted(path.stem for path in _folder().glob("*.toml"))


def read_paper(name: str) -> Paper:
    """A paper's experiment by the name of its replay.

    Raises:
        UnknownNameError: there is none of that name.
    """
    if name not in paper_names():
        raise UnknownNameError("replay", name, paper_names())
    data = _data(name)
    if source := data.get("cells_from"):
        data["cells"] = _data(source)["cells"]
    return Paper(name=name, **data)


def _data(name: str) -> dict[str, Any]:
    return tomllib.loads((_folder() / f"{name}.toml").read_text("utf-8"))


def find_paper_drawing(name: str) -> Path:
    """The file of a drawing that a paper names: one of its own, or an example."""
    own = _folder() / f"{name}.traj"
    return own if own.is_file() else find_drawing(name)


def _folder() -> Path:
    return Path(__file__).with_suffix("")

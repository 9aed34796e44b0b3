"""A painting, the CSV of a run or a drawing -> its curves in time."""

import json
from collections.abc import Sequence
from dataclasses import dataclass
from os import PathLike
from pathlib import Path
from typing import Any, Unpack

from dqpaint.api import draw
from dqpaint.core import NumberTable, read_regular
from dqpaint.errors import DqpaintError, UsageError
from dqpaint.language.writing import builder
from dqpaint.outputs import files
from dqpaint.painting import paint
from dqpaint.robots.loading import card_for, find_card, with_tool
from dqpaint.robots.model import Card
from dqpaint.settings import RunOptions, keywords
from dqpaint.studies.experiment.requests import read_span
from dqpaint.studies.report.charts import Form
from dqpaint.studies.report.page import Charts
from dqpaint.studies.report.run_charts import Choice, RunTable, Scale, charts_of_run

FORMS: tuple[Form, ...] = ("png", "pdf", "svg")
LARGEST_SUMMARY = 1_000_000  # bytes
SMALL = (64, 36)  # px of a picture that nobody looks at
OF_CSV = ("robot", "tool")

Where = str | PathLike[str]


@dataclass(frozen=True, repr=False)
class RunPlot:
    """The curves of a run.

    Attributes:
        name: of the run.
        charts: its panels.
        notes: what could not be shown, a sentence each.
    """

    name: str
    charts: Charts
    notes: tuple[str, ...] = ()

    def encoded(self, form: Form = "png") -> bytes:
        """As a PNG, PDF or SVG file."""
        return self.charts.encoded(form)

    def save(self, stem: Where, what: str | Sequence[str] = "png") -> list[Path]:
        """Write files `STEM.png` ...; returns their paths.

        Args:
            stem: path without an ending.
            what: of png, pdf, svg.

        Raises:
            UsageError: another form.
            OutputError: the folder cannot be written.
        """
        forms = read_forms(what)
        return files.write(Path(stem), {f".{form}": self.encoded(form) for form in forms})

    def __repr__(self) -> str:
        titles = ", ".join(panel.title for panel in self.charts.panels)
        return f"<RunPlot of {self.name}: {titles}>"

    def _repr_png_(self) -> bytes:
        return self.encoded()


@keywords("plot")
def plot(
    run: "Where | paint.Painting | builder.Drawing",
    *,
    what: Sequence[str] | str | None = None,
    scale: Scale = "linear",
    span: str | tuple[float, float] | None = None,
    each: bool = False,
    settings: Where | None = None,
    **options: Unpack[RunOptions],
) -> RunPlot:
    """Draw the curves of a run over time, as `dqpaint plot` does.

    Args:
        run: a painting; a CSV file of `draw`, whose summary beside it has the arm; or a drawing,
            which is run first.
        what: of error, path, speed, joints, commands, torques, motors, effort; None is all that the
            run has.
        scale: linear, or log of what is never below 0.
        span: seconds that are shown, as in "0..0.5" or (0, 0.5).
        each: a panel for each joint in its unit, instead of all joints by their limits.
        settings: a file of settings, for a drawing.
        options: of the run of a drawing; of a CSV `robot` and `tool`, for the limits.

    Raises:
        DqpaintError: the file is no such table, or a fault in the drawing or the choices.
    """
    names = [one.strip() for one in what.split(",")] if isinstance(what, str) else what or ()
    if scale not in ("linear", "log"):
        raise UsageError(f"scale '{scale}' is neither linear nor log")
    ends = read_span(span) if isinstance(span, str) else span
    choice = Choice(tuple(names), scale, ends, each)
    given = {key: value for key, value in options.items() if value not in (None, {}, ())}
    notes: tuple[str, ...] = ()
    if isinstance(run, paint.Painting):
        table = _of_painting(run)
    elif not isinstance(run, builder.Drawing) and Path(run).suffix.lower() == ".csv":
        table, notes = _of_csv(str(run), given, settings)
    else:
        painting = draw(run, **options, size=SMALL, settings=settings)
        table, notes = _of_painting(painting), painting.notes
    return RunPlot(table.name, charts_of_run(table, choice), notes)


def read_forms(what: str | Sequence[str]) -> tuple[Form, ...]:
    """The forms of a text with commas, or of several.

    Raises:
        UsageError: one is none.
    """
    names = what.split(",") if isinstance(what, str) else what
    said = [name.strip() for name in names]
    for name in said or [""]:
        if name not in FORMS:
            raise UsageError(f"save '{name[:40]}' is none of: {', '.join(FORMS)}")
    return tuple(form for form in FORMS if form in said)


def _of_painting(painting: paint.Painting) -> RunTable:
    settings, program = painting.settings, painting.motion.program
    card = card_for(program, settings.robot, settings.tool)
    held = [(c.kind, c.joint, c.start, c.start + c.seconds) for c in painting.limits]
    name = f"{Path(program.name).stem}-{painting.controller.name}"
    return RunTable(name, painting.table, card, held)


def _of_csv(
    path: str, given: dict[str, object], settings: Where | None
) -> tuple[RunTable, tuple[str, ...]]:
    """The table of a file, with the arm and limits of the summary beside it."""
    others = [key for key in given if key not in OF_CSV] + ["settings"] * (settings is not None)
    if others:
        raise UsageError(f"{Path(path).name} is a run that is over: leave out {', '.join(others)}")
    summary, notes = _summary(Path(path).with_suffix(".json"))
    held = [
        (one["kind"], one["joint"], one["start"], one["start"] + one["seconds"])
        for one in summary.get("limits", ())
    ]
    card: Card | None = None
    chosen = summary.get("settings", {})
    robot = given.get("robot") or chosen.get("robot") or summary.get("robot")
    tool = given.get("tool") or chosen.get("tool")
    if robot:
        try:
            card = with_tool(find_card(str(robot)), None if tool is None else str(tool))
        except DqpaintError:
            if "robot" in given:
                raise
            notes += (f"note: no limits are shown: the arm '{robot}' is not here",)
    table = NumberTable(path, "run")
    names = [name for name in table.names if name != "t_s"]
    columns = dict(zip(names, table.columns(names).T, strict=True))
    return RunTable(Path(path).stem, {"t_s": table.times(), **columns}, card, held), notes


def _summary(path: Path) -> tuple[dict[str, Any], tuple[str, ...]]:
    """The summary beside a CSV; nothing, and a note, where there is none."""
    try:
        found = json.loads(read_regular(path, LARGEST_SUMMARY))
        if isinstance(found, dict) and str(found.get("schema", "")).startswith("dqpaint-run"):
            return found, ()
    except (OSError, ValueError, RecursionError):
        pass
    return {}, (
        f"note: no limits are shown: {path.name} is not beside it, or no summary; "
        "--robot NAME shows those of an arm",
    )

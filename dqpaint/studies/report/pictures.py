"""Pictures and errors of cells -> a contact sheet, an overlay, errors over time, step responses.

A few share one chart and one overlay. Many are split by the first part of their names, such as the
law of `HIR, 20 %`: a panel each, all with the same axes, exposure and place.
"""

from collections import defaultdict
from collections.abc import Collection, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Literal

import numpy as np

from dqpaint.dq import Floats
from dqpaint.light.film import LOOKS
from dqpaint.light.images import LEGEND_EXPOSURE, contact_sheet
from dqpaint.metrics import all_columns
from dqpaint.settings import Settings
from dqpaint.studies.experiment.cells import Cell, listed_figures, split_label, spread_text
from dqpaint.studies.experiment.runs_table import gains_text
from dqpaint.studies.report.charts import MARKED, Line, Panel
from dqpaint.studies.report.over_runs import SAID, Arrays, Band, averaged
from dqpaint.studies.report.page import Charts, Pictured, Shot
from dqpaint.studies.report.step_charts import step_charts
from dqpaint.studies.runner.run_arrays import arrays_path, read_arrays

MOST_TOGETHER = 6  # cells of one overlay and one chart
DIM = 0.72  # of a hue on white paper
DECADES = 5  # of error: one that begins at 0 would take the whole chart
# Lines of a chart, the first of a small one, and the last, which do not hide the first.
THICK, THICKER, THIN = 3.6, 2.6, 1.2
WIDE = 20.0  # from a usual error to the largest: on an axis from 0 it could not be seen
ROOM = 1.3  # of an axis, above the largest error
ALIKE = "what all drew alike is white"


@dataclass(frozen=True)
class Group:
    """Cells that are shown together: a title, runs by the rest of their labels, their colours."""

    title: str
    members: Mapping[str, Arrays]
    colours: Mapping[str, contact_sheet.Colour]


def read_first_runs(found: Sequence[Cell], folder: Path) -> dict[str, Arrays]:
    """The arrays of the first runs by the labels of their cells, of those that have figures."""
    return {
        cell.label: read_arrays(folder, cell.results[0].key)
        for cell in found
        if cell.results[0].figures
    }


def groups(
    drawn: Mapping[str, Arrays], parts: Mapping[str, tuple[str, str]] | None = None
) -> list[Group]:
    """All of a few cells together; many by the first part of their labels, or each alone.

    Args:
        drawn: the arrays of cells by their labels.
        parts: what a panel and a line of it are called, by the label; None is `split_label`.
    """
    if parts is None and len(drawn) <= MOST_TOGETHER:
        colours = dict(zip(drawn, contact_sheet.hues(len(drawn)), strict=True))
        return [Group("", drawn, colours)]
    parts = parts or {label: split_label(label) for label in drawn}
    rests = list(dict.fromkeys(parts[label][1] for label in drawn))
    colours = dict(zip(rests, contact_sheet.hues(len(rests)), strict=True))
    members: dict[str, dict[str, Arrays]] = defaultdict(dict)
    for label, arrays in drawn.items():
        title, rest = parts[label]
        members[title][rest] = arrays
    return [Group(title, these, colours) for title, these in members.items()]


@dataclass(frozen=True)
class ChartChoice:
    """How curves over time are shown.

    Attributes:
        band: about the curve of several runs.
        scale: of the errors; `auto` is logarithmic where one from 0 would show too little.
        panels: the axis of which each value has charts of its own; None are those of many cells.
        span: of time that is shown [s]; None is all.
    """

    band: Band = "std"
    scale: Literal["auto", "linear", "log"] = "auto"
    panels: str | None = None
    span: tuple[float, float] | None = None


def pictures(
    found: Sequence[Cell], folder: Path, settings: Settings, choice: ChartChoice | None = None
) -> dict[str, Pictured]:
    """Contact sheet, overlay, errors over time, step responses; nothing if nothing was drawn.

    Pictures are those of first runs.

    Args:
        found: the cells; light and series of their first runs were kept.
        folder: of the study.
        settings: what all have in common.
        choice: how curves are shown.
    """
    drawn = read_first_runs(found, folder)
    if not drawn:
        return {}
    choice = choice or ChartChoice()
    parts = None if choice.panels is None else {c.label: _parts(c, choice.panels) for c in found}
    split = groups(drawn, parts)
    first = next(iter(drawn.values()))
    exposure = float(first["exposure"])  # one for all, or they could not be compared
    look = LOOKS[settings.look]
    by_label = {k: look(run["light"], exposure, settings.ev) for k, run in drawn.items()}
    images = [
        by_label[cell.label]
        if cell.label in by_label
        else contact_sheet.message_picture(cell.why, settings.height, settings.width)
        for cell in found
    ]
    seen = exposure * 2.0**settings.ev
    over = [
        look(
            contact_sheet.overlay(
                [run["light"] for run in group.members.values()], seen,
                [group.colours[name] for name in group.members],
            ),
            LEGEND_EXPOSURE, 0.0,
        )
        for group in split
    ]  # fmt: skip
    captions = [_caption(cell) for cell in found]
    labels = [cell.label for cell in found]
    window = contact_sheet.lit_window([*by_label.values(), *over])
    if len(split) > 1:
        images, over = ([one[window] for one in several] for several in (images, over))
        out = {id(drawn[label]) for label in without_result(found) if label in drawn}
        titles = [group.title + _told_apart(group, out) for group in split]
        most = min(len(split), MOST_TOGETHER)
        overlay = contact_sheet.sheet(over, titles, most)
        sheet = contact_sheet.sheet(images, captions, columns(labels))
    else:
        overlay, sheet = over[0], contact_sheet.sheet(images, captions)
    bad = without_result(found) if len(split) == 1 else set()
    key = contact_sheet.mixed_colours(
        {line_name(name, name in bad): hue for name, hue in split[0].colours.items()}
    )
    overlay = contact_sheet.with_key(overlay, key, settings.look)
    apart = "" if len(split) == 1 else ", within each picture"
    runs = read_runs(found, folder)
    made: dict[str, Pictured] = {
        "-sheet": Shot("All pictures, at one exposure", contact_sheet.encode_png(sheet)),
        "-overlay": Shot(
            f"Laid over each other{apart}: {ALIKE}", contact_sheet.encode_png(overlay)
        ),
        "-errors": errors(drawn, runs, choice, split, without_result(found)),
    }
    names = {label: line_name(label, label in without_result(found)) for label in drawn}
    hues = contact_sheet.hues(len(drawn))
    colours = {names[k]: on_paper(c) for k, c in zip(drawn, hues, strict=True)}
    steps = step_charts({names[label]: runs[label] for label in drawn}, colours, choice.band)
    return {**made, **({"-steps": steps} if steps else {})}


def without_result(found: Sequence[Cell]) -> set[str]:
    """The labels of cells of which no run is a result: their curves are shown, and named so."""
    return {cell.label for cell in found if not cell.done}


def line_name(label: str, bad: bool) -> str:
    """What a line is called in a legend."""
    return f"{label} ({MARKED})" if bad else label


def read_runs(found: Sequence[Cell], folder: Path) -> dict[str, list[Arrays]]:
    """The arrays of the runs that are results, by the labels of their cells; else of the first."""
    runs = {}
    for cell in found:
        keys = [one.key for one in cell.done if arrays_path(folder, one.key).is_file()]
        first = [cell.results[0].key] if cell.results[0].figures else []
        runs[cell.label] = [read_arrays(folder, key) for key in keys or first]
    return runs


def _parts(cell: Cell, axis: str) -> tuple[str, str]:
    """What the panel of a cell is called, and its line there."""
    rest = [value for name, value in cell.choice.items() if name != axis]
    return cell.choice[axis], ", ".join(rest)


def _caption(cell: Cell) -> str:
    """The choice, the law's gains, how far off the light was, and what runs are no results."""
    lines = [cell.label]
    if cell.runs and (gains := gains_text(cell.runs[0].settings)):
        lines.append(gains)
    rms = [
        f"{spread_text(cell.spread(figure))} {figure.unit}"
        for figure in listed_figures("error")
        if any("_rms_" in name for name in figure.names) and cell.spread(figure).n
    ]
    if rms:
        lines.append(f"rms {', '.join(rms)}")
    if cell.status != "done":
        lines.append(cell.status if cell.done else f"{MARKED}: {cell.status}")
    return "\n".join(lines)


def columns(labels: Sequence[str]) -> int | None:
    """How many pictures of a sheet stand beside each other, so that families lie in lines."""
    families = [split_label(label)[0] for label in labels]
    kinds = len(set(families))
    if families[:kinds] * (len(families) // kinds) == families:
        return kinds
    sizes = {families.count(one) for one in families}
    return sizes.pop() if len(sizes) == 1 and sizes != {1} else None


def errors(
    drawn: Mapping[str, Arrays],
    runs: Mapping[str, Sequence[Arrays]] | None = None,
    choice: ChartChoice | None = None,
    split: Sequence[Group] | None = None,
    bad: Collection[str] = (),
) -> Charts:
    """Errors over time, one below the other, a panel a group.

    Args:
        drawn: the first run of each choice, by its label.
        runs: all of its runs; None is the first alone.
        choice: how they are shown. On a logarithmic axis a band is one of quantiles: a mean less a
            standard deviation may be below 0.
        split: what stands together; None are `groups`.
        bad: labels of what is no result. A legend of one chart says so; where several share one,
            the title of each.
    """
    choice, split = choice or ChartChoice(), split or groups(drawn)
    every = runs or {label: [one] for label, one in drawn.items()}
    by_run = {id(run): every[label] for label, run in drawn.items()}
    out = {id(drawn[label]) for label in bad if label in drawn}
    panels: list[Panel] = []
    bands: set[Band] = set()
    for column in all_columns():
        name, title, scale = column.name, column.title, column.scale
        if column.study != "drawn" or any(name not in run for run in drawn.values()):
            continue
        values = [run[name] for run in drawn.values()]
        log = bool(0 < min(map(np.median, values)) < max(map(np.max, values)) / WIDE)
        log = log if choice.scale == "auto" else choice.scale == "log"
        span = None if len(split) == 1 else _span(scale * np.concatenate(values), log)
        for group in split:
            band: Band = "quantiles" if log and choice.band == "std" else choice.band
            small = len(split) > 1
            lines = _lines(group, name, scale, small, by_run, band, () if small else out)
            bands.add(band)
            head = f"{group.title}: {title}" if group.title else title
            head += _told_apart(group, out) if small else ""
            panels.append(
                Panel(
                    head, "time [s]", column.heading, lines, log_y=log, decades=DECADES,
                    span=span, x_span=choice.span,
                )
            )  # fmt: skip
    many = any(len(several) > 1 for several in every.values())
    told = "; ".join(SAID[band] for band in sorted(bands)) if many else "of the only run of each"
    title = f"Errors over time: {told}"
    return Charts(title, panels, shared=True, note=title if many else "")


def _told_apart(group: Group, out: Collection[int]) -> str:
    """What a title adds of the lines that are no results."""
    names = [name for name, run in group.members.items() if id(run) in out]
    if len(names) == len(group.members):
        return f"; {MARKED}"
    return f"; {MARKED}: {', '.join(names)}" if names else ""


def _lines(
    group: Group,
    name: str,
    scale: float,
    small: bool,
    by_run: Mapping[int, Sequence[Arrays]],
    band: Band,
    out: Collection[int],
) -> list[Line]:
    thick = THICKER if small else THICK
    widths = np.geomspace(thick, THIN, len(group.members)).tolist()
    lines = []
    for (label, run), width in zip(group.members.items(), widths, strict=True):
        runs = by_run[id(run)] or [run]
        y, low, high = (scale * part for part in averaged(runs, name, band))
        about = (low, high) if len(runs) > 1 and band != "none" else None
        said = line_name(label or group.title, id(run) in out)
        colour = on_paper(group.colours[label])
        lines.append(Line(run["t_s"], y, said, colour, band=about, width=width))
    return lines


def _span(values: Floats, log: bool) -> tuple[float, float]:
    """The ends of an axis for all."""
    top = ROOM * float(values.max())
    if not log:
        return 0.0, top or 1.0
    positive = values[values > 0]
    return max(float(np.quantile(positive, 0.001)) / ROOM, top * 10.0**-DECADES), top


def on_paper(colour: contact_sheet.Colour) -> str:
    """A hue as it can be read on white."""
    return "#" + "".join(f"{round(255 * DIM * part**0.6):02x}" for part in colour)

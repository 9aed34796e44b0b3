"""Pictures and errors of cells -> a contact sheet, an overlay, and errors over time.

A few share one chart and one overlay. Many are split by the first part of their names, such as the
law of `HIR, 20 %`: a panel each, all with the same axes, exposure and place.
"""

from collections import defaultdict
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from dqpaint.dq import Floats
from dqpaint.light import Picture
from dqpaint.light.film import LOOKS
from dqpaint.light.images import Legend, contact_sheet, with_legend
from dqpaint.metrics import all_columns
from dqpaint.settings import Settings
from dqpaint.studies.experiment.cells import Cell, split_label
from dqpaint.studies.report.charts import Line, Panel
from dqpaint.studies.report.page import Charts, Pictured, Shot
from dqpaint.studies.runner.run_arrays import read_arrays

Arrays = Mapping[str, NDArray[Any]]
MOST_TOGETHER = 6  # cells of one overlay and one chart
DIM = 0.72  # of a hue on white paper
DARKER = -2.0  # stops, so that a hue is seen and not burnt out
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


def groups(drawn: Mapping[str, Arrays]) -> list[Group]:
    """All of a few cells together; many by the first part of their labels, or each alone."""
    if len(drawn) <= MOST_TOGETHER:
        colours = dict(zip(drawn, contact_sheet.hues(len(drawn)), strict=True))
        return [Group("", drawn, colours)]
    rests = list(dict.fromkeys(split_label(label)[1] for label in drawn))
    colours = dict(zip(rests, contact_sheet.hues(len(rests)), strict=True))
    members: dict[str, dict[str, Arrays]] = defaultdict(dict)
    for label, arrays in drawn.items():
        title, rest = split_label(label)
        members[title][rest] = arrays
    return [Group(title, these, colours) for title, these in members.items()]


def pictures(found: Sequence[Cell], folder: Path, settings: Settings) -> dict[str, Pictured]:
    """Contact sheet, overlay and errors over time of first runs; nothing if none came to a picture.

    Args:
        found: the cells; light and series of their first runs were kept.
        folder: of the study.
        settings: what all have in common.
    """
    drawn = read_first_runs(found, folder)
    if not drawn:
        return {}
    first = next(iter(drawn.values()))
    exposure = float(first["exposure"])  # one for all, or they could not be compared

    def developed(light: NDArray[np.float32], ev: float) -> Picture:
        return LOOKS[settings.look](light, exposure, ev)

    by_label = {label: developed(run["light"], settings.ev) for label, run in drawn.items()}
    images = [
        by_label[cell.label]
        if cell.label in by_label
        else contact_sheet.message_picture(cell.why, settings.height, settings.width)
        for cell in found
    ]
    split = groups(drawn)
    over = [
        developed(
            contact_sheet.overlay(
                [run["light"] for run in group.members.values()],
                [group.colours[name] for name in group.members],
            ),
            settings.ev + DARKER,
        )
        for group in split
    ]
    labels = [_label(cell) for cell in found]
    if len(split) == 1:
        names = tuple(split[0].members)
        legend = Legend("laid over each other", names, tuple(split[0].colours.values()), False)
        overlay = with_legend(over[0], legend, settings.look)
        sheet = contact_sheet.sheet(images, labels)
    else:
        window = contact_sheet.lit_window([*by_label.values(), *over])
        sheet = contact_sheet.sheet([image[window] for image in images], labels, columns(labels))
        overlay = contact_sheet.sheet([image[window] for image in over], [g.title for g in split],
                                min(len(split), MOST_TOGETHER))  # fmt: skip
        overlay = contact_sheet.with_key(overlay, list(split[0].colours.items()), settings.look)
    apart = "" if len(split) == 1 else ", within each picture"
    return {
        "-sheet": Shot("All pictures, at one exposure", contact_sheet.encode_png(sheet)),
        "-overlay": Shot(
            f"Laid over each other{apart}: {ALIKE}", contact_sheet.encode_png(overlay)
        ),
        "-errors": errors(drawn),
    }


def columns(labels: Sequence[str]) -> int | None:
    """How many pictures of a sheet stand beside each other, so that families lie in lines."""
    families = [split_label(label)[0] for label in labels]
    kinds = len(set(families))
    if families[:kinds] * (len(families) // kinds) == families:
        return kinds
    sizes = {families.count(one) for one in families}
    return sizes.pop() if len(sizes) == 1 and sizes != {1} else None


def errors(drawn: Mapping[str, Arrays]) -> Charts:
    """Errors over time, one below the other, a panel a group."""
    split = groups(drawn)
    panels = []
    for column in all_columns():
        name, title, scale = column.name, column.title, column.scale
        if column.study != "drawn" or any(name not in run for run in drawn.values()):
            continue
        values = [run[name] for run in drawn.values()]
        log = bool(0 < min(map(np.median, values)) < max(map(np.max, values)) / WIDE)
        span = None if len(split) == 1 else _span(scale * np.concatenate(values), log)
        for group in split:
            lines = _lines(group, name, scale, len(split) > 1)
            head = f"{group.title}: {title}" if group.title else title
            panels.append(
                Panel(
                    head, "time [s]", column.heading, lines, log_y=log, decades=DECADES,
                    span=span,
                )
            )  # fmt: skip
    return Charts("Errors over time, of the first run of each", panels, shared=True)


def _lines(group: Group, name: str, scale: float, small: bool) -> list[Line]:
    thick = THICKER if small else THICK
    widths = np.geomspace(thick, THIN, len(group.members)).tolist()
    return [
        Line(
            run["t_s"], scale * run[name], label or group.title,
            on_paper(group.colours[label]), width=width,
        )
        for (label, run), width in zip(group.members.items(), widths, strict=True)
    ]  # fmt: skip


def _span(values: Floats, log: bool) -> tuple[float, float]:
    """The ends of an axis for all."""
    top = ROOM * float(values.max())
    if not log:
        return 0.0, top or 1.0
    positive = values[values > 0]
    return max(float(np.quantile(positive, 0.001)) / ROOM, top * 10.0**-DECADES), top


def _label(cell: Cell) -> str:
    status = cell.results[0].status
    return cell.label if status == "done" else f"{cell.label}: {status}"


def on_paper(colour: contact_sheet.Colour) -> str:
    """A hue as it can be read on white."""
    return "#" + "".join(f"{round(255 * DIM * part**0.6):02x}" for part in colour)

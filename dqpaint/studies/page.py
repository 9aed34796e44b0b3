"""What a study has to show -> one HTML file: pictures, tables, curves to point at; no network.

The file holds all it needs, its two scripts' worth of style and drawing code too, and says so: its
Content-Security-Policy lets no other code run and nothing be fetched. It has no date, so the same
study makes the same file.
"""

import base64
import hashlib
import json
from collections.abc import Sequence
from dataclasses import dataclass
from html import escape
from importlib.resources import files
from itertools import cycle
from typing import Any

import numpy as np

from dqpaint import __version__
from dqpaint.charts import COLOURS, HeatMap, Line, Panel, chart, heat_map
from dqpaint.dq import Floats
from dqpaint.settings import Settings
from dqpaint.studies.references import versions

MOST_POINTS = 1500  # of a line: two a pixel, the least and the largest of a stretch
DIGITS = 6
LONGEST, LONG = 36, ' class="long"'  # letters of a cell that stays on one line
HINT = (
    " Drag along a chart to zoom, double-click to see all again; names in a legend show and hide "
    "their lines."
)
BAD = (
    "unstable",
    "failed",
    "died",
    "differs",
    "fails",
)  # words of a row that is not as it should be


@dataclass(frozen=True)
class Words:
    """A paragraph."""

    text: str


@dataclass(frozen=True)
class Rows:
    """A table: headings and rows of text."""

    title: str
    lines: Sequence[Sequence[str]]


@dataclass(frozen=True)
class Shot:
    """A picture, a PNG file, and what it shows."""

    title: str
    png: bytes


@dataclass(frozen=True)
class Charts:
    """Curves beside each other."""

    title: str
    panels: Sequence[Panel]


@dataclass(frozen=True)
class Map:
    """A heat map."""

    title: str
    given: HeatMap


Block = Words | Rows | Shot | Charts | Map


@dataclass(frozen=True)
class Page:
    """A study as it is told.

    Attributes:
        title: of the page.
        blocks: what it shows, from the top.
        settings: what all runs have in common.
        text: of the drawing; empty where there are several.
        again: the command or call that makes it again.
    """

    title: str
    blocks: Sequence[Block]
    settings: Settings | None = None
    text: str = ""
    again: str = ""


def html(page: Page) -> bytes:
    """The page as one file."""
    script, style = (_source(name) for name in ("page.js", "page.css"))
    rules = (
        "default-src 'none'; img-src data:; base-uri 'none'; form-action 'none'; "
        f"script-src {_hash(script)}; style-src {_hash(style)}"
    )
    parts = [_block(block, str(i)) for i, block in enumerate([*page.blocks, *_about(page)])]
    said = " ".join(f"{name} {value}" for name, value in versions().items())
    hint = HINT if any(isinstance(block, Charts) for block in page.blocks) else ""
    return f"""<!doctype html>
<html lang="en">
<head>
<meta charset="utf-8">
<meta http-equiv="Content-Security-Policy" content="{rules}">
<meta name="viewport" content="width=device-width, initial-scale=1">
<title>{escape(page.title)}</title>
<style>{style}</style>
</head>
<body>
<h1>{escape(page.title)}</h1>
{"".join(parts)}
<footer>Made by dqpaint {escape(__version__)} with {escape(said)}.{hint}</footer>
<script>{script}</script>
</body>
</html>
""".encode()


def _about(page: Page) -> list[Block]:
    """The drawing, the settings, and how to run it again."""
    blocks: list[Block] = []
    if page.settings is not None:
        chosen = json.loads(page.settings.model_dump_json(exclude_defaults=True))
        rows = [[name, _said(value)] for name, value in chosen.items()]
        blocks.append(Rows("Settings of all runs; the others as usual", [["", ""], *rows]))
    if page.text:
        blocks.append(_Source("The drawing", page.text))
    if page.again:
        blocks.append(_Source("To run it again", page.again))
    return blocks


def _said(value: object) -> str:
    """A setting about as the command line has it: gains, and disturbances by their names."""
    if not isinstance(value, dict):
        return value if isinstance(value, str) else json.dumps(value)
    parts = {
        name: ",".join(f"{k}={v}" if k else f"{v}" for k, v in one.items())
        if isinstance(one, dict)
        else _said(one)
        for name, one in value.items()
    }
    return "  ".join(f"{name}={said}" for name, said in parts.items())


@dataclass(frozen=True)
class _Source(Words):
    source: str


def _source(name: str) -> str:
    return "\n" + files("dqpaint.studies").joinpath(name).read_text("utf-8")


def _hash(text: str) -> str:
    return f"'sha256-{base64.b64encode(hashlib.sha256(text.encode()).digest()).decode()}'"


def _block(block: Block, name: str) -> str:
    if isinstance(block, _Source):
        return f"<h2>{escape(block.text)}</h2>\n<pre>{escape(block.source)}</pre>\n"
    if isinstance(block, Words):
        return f"<p>{escape(block.text)}</p>\n"
    if isinstance(block, Rows):
        return f"<h2>{escape(block.title)}</h2>\n{_table(block.lines)}"
    if isinstance(block, Shot):
        return f"<h2>{escape(block.title)}</h2>\n{_image(block.png, block.title)}\n"
    if isinstance(block, Map):
        figure = _figure(block.given.title, f"heat-{name}", "heat", _map_data(block.given))
        without = _without(heat_map(block.given), block.title)
        return f"<h2>{escape(block.title)}</h2>\n{figure}{without}"
    figures = "".join(
        _figure(panel.title, f"curves-{name}-{i}", "curves", _panel_data(panel))
        for i, panel in enumerate(block.panels)
    )
    without = _without(chart(block.panels, 5.5 * len(block.panels), 4.2), block.title)
    return f'<h2>{escape(block.title)}</h2>\n<div class="beside">\n{figures}</div>\n{without}'


def _image(png: bytes, title: str) -> str:
    data = base64.b64encode(png).decode()
    return f'<img alt="{escape(title)}" src="data:image/png;base64,{data}">'


def _without(png: bytes, title: str) -> str:
    """What is seen where no script runs."""
    return f"<noscript>{_image(png, title)}</noscript>\n"


def _table(lines: Sequence[Sequence[str]]) -> str:
    head, *rows = lines
    kind = ' class="settings"' if not any(head) else ""
    made = [f'<div class="wide"><table{kind}>']
    if any(head):
        made.append(f"<tr>{''.join(f'<th>{escape(word)}</th>' for word in head)}</tr>")
    for row in rows:
        cells = "".join(
            f"<td{LONG if len(word) > LONGEST else ''}>{escape(word)}</td>" for word in row
        )
        made.append(f"<tr{_class(row)}>{cells}</tr>")
    return "\n".join([*made, "</table></div>\n"])


def _class(row: Sequence[str]) -> str:
    if row[0] == "best":
        return ' class="best"'
    words = row[-1].replace(",", " ").replace(":", " ").split()
    return ' class="bad"' if any(word in BAD for word in words) else ""


def _figure(title: str, name: str, kind: str, data: dict[str, Any]) -> str:
    text = json.dumps({"kind": kind, **data}, allow_nan=False, separators=(",", ":"))
    # within a script only these could end it, or begin another
    safe = text.replace("<", "\\u003c").replace(">", "\\u003e").replace("&", "\\u0026")
    return (
        f'<figure class="chart" id="{name}"><h3>{escape(title)}</h3></figure>\n'
        f'<script type="application/json" data-figure="{name}">{safe}</script>\n'
    )


def _panel_data(panel: Panel) -> dict[str, Any]:
    colours = cycle(COLOURS)
    lines = [_line_data(_thinned(line), next(colours)) for line in panel.lines]
    names = ("title", "x_label", "y_label", "log_x", "log_y", "decades", "bound", "wall")
    ticks = None if panel.ticks is None else list(panel.ticks)
    return {**{name: getattr(panel, name) for name in names}, "ticks": ticks, "lines": lines}


def _line_data(line: Line, following: str) -> dict[str, Any]:
    return {
        "label": line.label, "colour": line.colour or following, "width": line.width,
        "x": _numbers(line.x), "y": _numbers(line.y),
        "marks": None if line.marks is None else line.marks.tolist(),
        "bars": None if line.bars is None else _numbers(line.bars),
    }  # fmt: skip


def _thinned(line: Line) -> Line:
    """A line of few enough points; no peak is lost."""
    count = len(line.x)
    if count <= MOST_POINTS or line.marks is not None:
        return line
    edges = np.linspace(0, count, MOST_POINTS // 2 + 1).astype(int)
    kept = {0, count - 1}
    for low, high in zip(edges[:-1].tolist(), edges[1:].tolist(), strict=True):
        stretch = line.y[low:high]
        kept |= {low + int(np.argmin(stretch)), low + int(np.argmax(stretch))}
    at = np.array(sorted(kept))
    return Line(line.x[at], line.y[at], line.label, line.colour, width=line.width)


def _map_data(given: HeatMap) -> dict[str, Any]:
    return {
        "title": given.title, "x_label": given.x_label, "y_label": given.y_label,
        "x": list(given.x), "y": list(given.y), "log": given.log,
        "values": [_numbers(row) for row in given.values], "marked": given.marked.tolist(),
    }  # fmt: skip


def _numbers(values: Floats) -> list[float | None]:
    return [float(f"{v:.{DIGITS}g}") if np.isfinite(v) else None for v in values.tolist()]

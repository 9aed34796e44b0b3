"""Pictures, tables and charts of a study -> one HTML file that needs no network.

The file holds all it needs, its style and the scripts that draw its charts too, and says so: its
Content-Security-Policy lets no other code run and nothing be fetched. It has no date, so the same
study makes the same file.
"""

import base64
import hashlib
import json
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from importlib.resources import files
from typing import Any

from dqpaint import __version__
from dqpaint.core import library_versions
from dqpaint.settings import Settings
from dqpaint.studies.report import chart_data
from dqpaint.studies.report.charts import (
    HEIGHT,
    Form,
    HeatMap,
    Panel,
    beside,
    chart,
    heat_map,
)
from dqpaint.studies.report.html_tables import table
from dqpaint.studies.report.templates import render

SCRIPTS = "page.js", "curves.js", "heat.js", "tables.js"
WIDE = (7.0, 12.0, 15.0)  # of one chart, of two and of three beside each other [inches]
HINT = (
    "To read a chart, point at it or touch it; or choose it with the Tab key and go along it with "
    "the arrow keys. Drag along it, or spread two fingers, to zoom; a double click shows all "
    "again. A name above it hides and shows its line, a double click on one all others."
)


VECTORS: tuple[Form, ...] = ("pdf", "svg")
"""Forms of charts besides PNG."""


@dataclass(frozen=True)
class Words:
    """A paragraph."""

    text: str


@dataclass(frozen=True)
class Source:
    """A text that is shown as it stands."""

    title: str
    text: str


@dataclass(frozen=True)
class Rows:
    """A table: headings and rows of text; numbers of the columns `bars` are drawn, too."""

    title: str
    lines: Sequence[Sequence[str]]
    bars: tuple[int, ...] = ()
    note: str = ""


@dataclass(frozen=True)
class Tables:
    """Small tables beside each other."""

    title: str
    tables: Sequence[Rows]


@dataclass(frozen=True)
class Shot:
    """A picture, a PNG file, and what it shows."""

    title: str
    picture: bytes

    def encoded(self, form: Form = "png") -> bytes:
        """As a PNG file, of light as it was photographed; it has no other form."""
        return self.picture


@dataclass(frozen=True)
class Charts:
    """Curves beside each other; `note` is a line below them as a file, where no title is.

    If they are `shared`, lines of one name have one colour in all of them, and one legend: what is
    hidden in one is so in all, and those that are over the same thing are read and zoomed together.
    """

    title: str
    panels: Sequence[Panel]
    shared: bool = False
    note: str = ""

    columns: int | None = None

    @property
    def beside(self) -> int:
        """How many panels stand beside each other."""
        return self.columns or beside(len(self.panels))

    def encoded(self, form: Form = "png") -> bytes:
        """As a file."""
        width = WIDE[self.beside - 1]
        return chart(
            self.panels, width, HEIGHT, self.shared, form, self.columns, self.note
        )  # fmt: skip


@dataclass(frozen=True)
class Map:
    """A heat map."""

    title: str
    given: HeatMap

    def encoded(self, form: Form = "png") -> bytes:
        """As a file."""
        width, height = 1.0 + 0.9 * len(self.given.x), 1.2 + 0.55 * len(self.given.y)
        return heat_map(self.given, min(max(7.0, width), 24.0), min(max(5.0, height), 18.0), form)


Pictured = Shot | Charts | Map
Block = Words | Source | Rows | Tables | Pictured


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


def files_of(shown: Mapping[str, Pictured], forms: Sequence[str] = ()) -> dict[str, bytes]:
    """PNG files by the ends of their names, and charts and maps in other forms, too."""
    made = {f"{end}.png": one.encoded() for end, one in shown.items()}
    for end, one in shown.items():
        if not isinstance(one, Shot):
            made |= {f"{end}.{form}": one.encoded(form) for form in VECTORS if form in forms}
    return made


def html(page: Page) -> bytes:
    """The page as one file."""
    script, style = _source(*SCRIPTS), _source("page.css")
    rules = (
        "default-src 'none'; img-src data:; base-uri 'none'; form-action 'none'; "
        f"script-src {_hash(script)}; style-src {_hash(style)}"
    )
    blocks = [*page.blocks, *_about(page)]
    return render(
        "page.html",
        title=page.title, rules=rules, style=style, script=script, hint=HINT, table=table,
        blocks=[(type(block).__name__, block) for block in blocks],
        of_panel=_of_panel, of_map=chart_data.of_map, beside=beside, version=__version__,
        libraries=" ".join(f"{name} {value}" for name, value in library_versions().items()),
    ).encode()  # fmt: skip


def _of_panel(panel: Panel, columns: int) -> dict[str, Any]:
    return chart_data.of_panel(panel, chart_data.MOST_POINTS // (2 if columns > 2 else 1))


def _about(page: Page) -> list[Block]:
    """The drawing, the settings, and how to run it again."""
    blocks: list[Block] = []
    if page.settings is not None:
        chosen = json.loads(page.settings.model_dump_json(exclude_defaults=True))
        rows = [[name, _said(value)] for name, value in chosen.items()]
        blocks.append(Rows("Settings of all runs; the others as usual", [["", ""], *rows]))
    if page.text:
        blocks.append(Source("The drawing", page.text))
    if page.again:
        blocks.append(Source("To run it again", page.again))
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


def _source(*names: str) -> str:
    folder = files("dqpaint.studies.report")
    return "".join("\n" + folder.joinpath(name).read_text("utf-8") for name in names)


def _hash(text: str) -> str:
    return f"'sha256-{base64.b64encode(hashlib.sha256(text.encode()).digest()).decode()}'"

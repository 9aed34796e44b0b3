"""The curves of runs over time, on the page: one quantity at a time, runs over each other."""

import base64
import csv
import io
from collections.abc import Callable, Mapping, Sequence

import numpy as np
from nicegui import events, ui

from dqpaint.studio.work.messages import Curve, Run

COLOURS = ("#56b4e9", "#e69f00", "#009e73", "#f0e442", "#cc79a7", "#d55e00", "#0072b2")
STYLES = ("solid", "dashed", "dotted")
AXES = {"axisLabel": {"color": "#aab4c4"}, "splitLine": {"lineStyle": {"color": "#232a36"}}}


class Charts:
    """The chart of one page.

    Args:
        pointed: called with the time that was clicked [s].
    """

    def __init__(self, pointed: Callable[[float], None]) -> None:
        self._runs: dict[str, Run] = {}
        self._title = ""
        with ui.row().classes("items-center w-full no-wrap"):
            self._choice = (
                ui.select([], label="quantity", on_change=lambda event: self._choose(event.value))
                .props("dense outlined options-dense")
                .classes("grow")
            )
            save = ui.button(icon="download").props("flat dense").tooltip("save the curves")
            with save, ui.menu():
                ui.menu_item("CSV", self._save_csv)
                ui.menu_item("PNG", self._save_png)
                ui.menu_item("SVG", self._save_svg)
        self._pointed = pointed
        self.chart = ui.echart(_empty(), on_point_click=self._clicked, renderer="svg").classes(
            "curves"
        )

    def show(self, runs: Mapping[str, Run]) -> None:
        """Show the curves of some runs, by their names."""
        self._runs = dict(runs)
        titles = list(dict.fromkeys(c.title for run in runs.values() for c in run.curves))
        title = self._title if self._title in titles else (titles[0] if titles else "")
        self._choice.set_options(titles, value=title or None)
        self._choose(title)

    def set_time(self, seconds: float) -> None:
        """Move the cursor."""
        line = {"color": "#ffffff", "type": "solid"}
        mark = {"silent": True, "symbol": "none", "animation": False, "label": {"show": False},
                "lineStyle": line, "data": [{"xAxis": seconds}]}  # fmt: skip
        if self._runs:
            self.chart.run_chart_method(
                "setOption", {"series": [{"id": "cursor", "markLine": mark}]}
            )

    def _choose(self, title: str | None) -> None:
        self._title = title or ""
        self.chart.options.clear()
        self.chart.options.update(options(self._runs, self._title))
        self.chart.update()

    def _clicked(self, event: events.EChartPointClickEventArguments) -> None:
        if isinstance(event.value, list):
            self._pointed(float(event.value[0]))

    def _save_csv(self) -> None:
        ui.download.content(table(self._runs, self._title), f"{self._title or 'curves'}.csv")

    async def _save_svg(self) -> None:
        script = f"return getElement({self.chart.id}).chart.renderToSVGString()"
        text = await ui.run_javascript(script, timeout=5)
        ui.download.content(text, f"{self._title}.svg", "image/svg+xml")

    async def _save_png(self) -> None:
        script = PNG_OF_SVG.replace("SVG_ID", str(self.chart.id))
        data = await ui.run_javascript(script, timeout=8)
        ui.download.content(base64.b64decode(data), f"{self._title}.png", "image/png")


PNG_OF_SVG = """
const svg = getElement(SVG_ID).chart.renderToSVGString();
const image = new Image();
const url = URL.createObjectURL(new Blob([svg], {type: 'image/svg+xml'}));
await new Promise((done, failed) => {
  image.onload = done; image.onerror = failed; image.src = url;
});
const canvas = document.createElement('canvas');
canvas.width = 2 * image.width; canvas.height = 2 * image.height;
const pen = canvas.getContext('2d');
pen.fillStyle = '#12151c'; pen.fillRect(0, 0, canvas.width, canvas.height);
pen.drawImage(image, 0, 0, canvas.width, canvas.height);
return canvas.toDataURL('image/png').split(',')[1];
"""


def _empty() -> dict[str, object]:
    return {"xAxis": {"type": "value"}, "yAxis": {"type": "value"}, "series": []}


def options(runs: Mapping[str, Run], title: str) -> dict[str, object]:
    """The chart of one quantity: a colour for each part, a line style for each run."""
    series: list[dict[str, object]] = [{"id": "cursor", "type": "line", "data": []}]
    unit = ""
    for style, (name, run) in zip(_styles(len(runs)), runs.items(), strict=True):
        curve = next((one for one in run.curves if one.title == title), None)
        if curve is None:
            continue
        unit = curve.unit
        series += _series(name if len(runs) > 1 else "", run, curve, style)
    return {
        "animation": False,
        "backgroundColor": "transparent",
        "grid": {"left": 58, "right": 14, "top": 34, "bottom": 34},
        "legend": {"type": "scroll", "textStyle": {"color": "#d5dbe6"}, "top": 2},
        "tooltip": {"trigger": "axis", "valueFormatter": None, "confine": True},
        "xAxis": {"type": "value", "name": "s", "min": "dataMin", "max": "dataMax", **AXES},
        "yAxis": {"type": "value", "name": unit, "scale": True, "nameTextStyle":
                  {"color": "#aab4c4"}, **AXES},
        "dataZoom": [{"type": "inside"}],
        "series": series,
    }  # fmt: skip


def _styles(count: int) -> list[str]:
    return [STYLES[i % len(STYLES)] for i in range(count)]


def _series(name: str, run: Run, curve: Curve, style: str) -> list[dict[str, object]]:
    found: list[dict[str, object]] = []
    for i, (part, values) in enumerate(zip(curve.names, curve.values.T, strict=True)):
        colour = COLOURS[i % len(COLOURS)]
        asked = part.endswith("asked")
        one: dict[str, object] = {
            "name": f"{part}, {name}" if name else part,
            "type": "line",
            "showSymbol": False,
            "data": np.stack([run.time, values], 1).round(6).tolist(),
            "lineStyle": {"width": 1 if asked else 1.6, "type": "dotted" if asked else style},
            "itemStyle": {"color": colour},
        }
        if curve.limits is not None and np.abs(values).max() > 0.7 * curve.limits[i]:
            limit = float(curve.limits[i])
            one["markLine"] = {
                "silent": True, "symbol": "none", "lineStyle": {"color": colour, "opacity": 0.6},
                "label": {"formatter": f"limit of {part}", "color": colour},
                "data": [{"yAxis": limit if values.max() >= -values.min() else -limit}],
            }  # fmt: skip
        found.append(one)
    return found


def table(runs: Mapping[str, Run], title: str) -> str:
    """The curves of a quantity as CSV: a row a time, of each run in turn."""
    stream = io.StringIO()
    writer = csv.writer(stream, lineterminator="\n")
    chosen = [(name, run, curve) for name, run in runs.items() for curve in run.curves
              if curve.title == title]  # fmt: skip
    names: Sequence[str] = chosen[0][2].names if chosen else ()
    unit = chosen[0][2].unit if chosen else ""
    writer.writerow(["run", "t_s", *(f"{title}: {name} [{unit}]" for name in names)])
    for name, run, curve in chosen:
        for seconds, values in zip(run.time.tolist(), curve.values.tolist(), strict=True):
            writer.writerow([name, f"{seconds:.6g}", *(f"{one:.9g}" for one in values)])
    return stream.getvalue()

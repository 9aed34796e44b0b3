"""One open page: text on one side; picture, arm, curves and figures on the other; time below."""

import asyncio
import base64
import itertools
from collections.abc import Mapping
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
from nicegui import events, ui

from dqpaint.studio import choices as chosen
from dqpaint.studio import sharing
from dqpaint.studio.page.charts import Charts
from dqpaint.studio.page.comparison import ComparisonView
from dqpaint.studio.page.editor import Editor
from dqpaint.studio.page.findings import FindingList
from dqpaint.studio.page.knobs import Knobs
from dqpaint.studio.page.panel import Panel
from dqpaint.studio.page.time_bar import TimeBar
from dqpaint.studio.page.top_bar import TopBar
from dqpaint.studio.page.view3d import FAINT, View3D
from dqpaint.studio.shared import Studio
from dqpaint.studio.work.mesh_files import line_glb
from dqpaint.studio.work.messages import (
    Answer,
    ArmShapes,
    Failure,
    Finding,
    Forecast,
    Frame,
    Progress,
    Reading,
    Request,
    Run,
    RunPage,
    Shown,
    Verdict,
    Want,
)

WIDTH, HEIGHT = 640, 360  # px of the picture
RUN_PAUSE = 0.35  # [s] without a key before an arm runs
MOST_KEPT = 4
FIT_PAUSE = 0.3  # [s] until the page is laid out
_numbers = itertools.count(1)


class Page:
    """The page and its state.

    Args:
        studio: what all pages share.
        name: of the drawing.
        text: of it.
        choices: of the run.
        present: whether it is for a lecture hall: large, read-only, page by page.
    """

    def __init__(
        self,
        studio: Studio,
        name: str,
        text: str,
        choices: Mapping[str, Any],
        present: bool = False,
    ) -> None:
        self.key = f"page-{next(_numbers)}"
        self._studio = studio
        self.name = name
        self._present = present
        self._findings: tuple[Finding, ...] = ()
        self._forecast: tuple[Finding, ...] = ()
        self._shown: Shown | None = None
        self._runs: dict[str, Run] = {}  # by tier, of the text as it is
        self._kept: dict[str, Run] = {}
        self._keeps = itertools.count(1)
        self._frames: dict[int, bytes] = {}
        self._timer: asyncio.TimerHandle | None = None
        self._closed = False
        self._asked: Request | None = None  # of the run that is shown
        self._requests: dict[str, Request] = {}  # of the runs that were kept
        self.client = ui.context.client
        self._build(text, choices)

    # What is seen.

    def _build(self, text: str, choices: Mapping[str, Any]) -> None:
        ui.dark_mode(True)
        if self._present:
            ui.query("body").classes("present")
        with ui.header().classes("bar items-center no-wrap"):
            self._bar = TopBar(self, self._studio, self._present)
        with ui.splitter(value=40, limits=(20, 75), on_change=lambda _event: self._fit()).classes(
            "body"
        ) as splitter:
            with splitter.before, ui.column().classes("left no-wrap gap-0"):
                self.editor = Editor(
                    text, self._edited, self.go_to_line, lambda: self._bar.save(), self._present
                )
                self._messages = FindingList(self.editor)
                self._knobs = Knobs(self.editor)
            with splitter.after, ui.column().classes("right no-wrap gap-0"):
                self._build_picture()
                self._build_tabs(choices)
        with ui.footer().classes("bar items-center no-wrap"):
            self._time = TimeBar(self._scrubbed)
        ui.timer(FIT_PAUSE, self._fit, once=True)
        self.submit()

    def _fit(self) -> None:
        """Have the 3-D view and the chart take the room that they have."""
        ui.run_javascript("window.dispatchEvent(new Event('resize'))")

    def _build_picture(self) -> None:
        with ui.element("div").classes("stage"):
            self._picture = ui.interactive_image(
                on_mouse=self._picked, events=["mousedown"], cross=False
            ).classes("picture")
            self._about = ui.label("").classes("about")
            self._progress = ui.linear_progress(value=0, show_value=False, size="3px").classes(
                "progress"
            )
        self._progress.visible = False

    def _build_tabs(self, choices: Mapping[str, Any]) -> None:
        with ui.tabs().props("dense inline-label no-caps").classes("tabs") as tabs:
            for name, icon in (("Arm", "precision_manufacturing"), ("Curves", "show_chart"),
                               ("Figures", "table_rows"), ("Choices", "tune"),
                               ("Compare", "compare")):  # fmt: skip
                ui.tab(name, icon=icon)
        with ui.tab_panels(tabs, value="Arm", keep_alive=True).classes("panels"):
            with ui.tab_panel("Arm").classes("p-0 fill"):
                self._view = View3D()
            with ui.tab_panel("Curves").classes("fill"):
                self._charts = Charts(self.go_to_time)
            with ui.tab_panel("Figures").classes("fill scroll"):
                self._figures = ui.column().classes("w-full gap-1")
            with ui.tab_panel("Choices").classes("fill scroll"):
                self._command = ui.code("", language="bash").classes("w-full command")
                self.panel = Panel(choices, self._studio.laws, lambda _choices: self.submit())
            with ui.tab_panel("Compare").classes("fill scroll"):
                self._comparison = ComparisonView(self.keep, self._charts.show, self._judge)

    # What is asked of the workers.

    def submit(self, run: bool = True) -> None:
        """Ask for the picture of the text as it is, and after a pause for its runs."""
        request = self._request("picture")
        self._command.set_content(chosen.command(self.name, self.panel.choices))
        self._studio.reader.submit(self.key, request, self._answer)
        if self._timer is not None:
            self._timer.cancel()
        self._studio.runner.forget(self.key)
        self._progress.visible = False
        if run:
            loop = asyncio.get_running_loop()
            self._timer = loop.call_later(RUN_PAUSE, self._submit_run)

    def _submit_run(self) -> None:
        if not any(one.is_error for one in self._findings):
            self._asked = self._request("run")
            self._studio.runner.submit(self.key, self._asked, self._answer)

    def _request(self, want: Want) -> Request:
        path = str(self._studio.folder.root / self.name)
        return Request(self.editor.text, path, dict(self.panel.choices), WIDTH, HEIGHT, want)

    def _edited(self, _text: str) -> None:
        self._knobs.fill()
        self.submit()

    # What the workers answer.

    def _answer(self, answer: Answer) -> None:
        if not self._closed:
            with self.client:
                self._show(answer)

    def _show(self, answer: Answer) -> None:
        match answer:
            case Reading():
                self._show_reading(answer)
            case Shown():
                self._show_sketch(answer)
            case Forecast():
                self._forecast = answer.findings
                self._show_findings(None)
            case ArmShapes():
                self._studio.keep_shapes(answer)
            case Progress():
                self._progress.visible = True
                self._progress.set_value(answer.share)
            case Run():
                self._show_run(answer)
            case Frame():
                self._frames[answer.index] = answer.image
                if answer.index == self._time.index:
                    self._set_image(answer.image)
            case RunPage():
                self._progress.visible = False
                ui.download.content(answer.html, f"{Path(self.name).stem}-scene.html")
            case Verdict():
                self._progress.visible = False
                self._comparison.show_verdict(answer.says)
            case Failure():
                self._progress.visible = False
                self._fill_figures(answer.reason)

    def _show_reading(self, reading: Reading) -> None:
        self._findings = reading.findings
        self._forecast = ()
        wrong = bool(reading.fault) or any(one.is_error for one in reading.findings)
        self._picture.classes(add="old" if wrong else "", remove="" if wrong else "old")
        self._bar.show_live(wrong)
        if reading.fault:
            self._about.text = reading.fault
        self._show_findings(None if wrong else dict(reading.lines))

    def _show_findings(self, lines: dict[int, str] | None) -> None:
        found = [*self._findings, *self._forecast]
        self.editor.show_findings(found, lines)
        self._messages.show(found)

    def _show_sketch(self, shown: Shown) -> None:
        moment = self._moment
        self._shown = shown
        self._runs.clear()
        self._frames.clear()
        self._set_image(shown.image)
        self._about.text = f"asked: {shown.about}"
        self._show_paths()
        self._set_times(moment)

    def _show_paths(self) -> None:
        if self._shown is None:
            return
        lit = self._shown.colours.max(axis=1, keepdims=True)
        shades = np.where(lit > 0, self._shown.colours / np.maximum(lit, 1e-9), FAINT)
        lines = [line_glb(self._shown.points, shades)]
        run = self._run
        if run is not None:
            lines.append(line_glb(run.points, np.ones_like(run.points)))
        self._view.show_paths(self._studio.serve_paths(self.key, lines))

    @property
    def _run(self) -> Run | None:
        """The best run of the text as it is."""
        return self._runs.get("physics") or self._runs.get("ideal")

    def _show_run(self, run: Run) -> None:
        moment = self._moment
        self._runs[run.tier] = run
        self._frames.clear()
        self._progress.visible = False
        self._set_image(run.image)
        self._about.text = f"{run.title}, computed in {run.seconds:.2f} s"
        self._view.show_arm(run.robot, self._studio.shape_urls(run.robot))
        self._view.set_motion(run.links)
        self._fit()
        self._show_paths()
        self._charts.show({**self._kept, run.title: run})
        self._comparison.set_runs({**self._kept, "now": run})
        self._fill_figures("")
        self._set_times(moment)

    def _fill_figures(self, reason: str) -> None:
        self._figures.clear()
        with self._figures:
            if reason:
                ui.label(reason).classes("no-result")
            for tier, run in self._runs.items():
                ui.label(f"{tier}: {run.title}").classes("heading")
                for fault in run.faults:
                    ui.label(f"no result: {fault}").classes("no-result")
                with ui.grid(columns="auto 1fr").classes("figures"):
                    for one in run.figures:
                        ui.label(one.title)
                        ui.label(f"{one.value:.4g} {one.unit}")
                for note in run.notes:
                    ui.label(note).classes("note")

    def _set_image(self, image: bytes) -> None:
        kind = "png" if image[:4] == b"\x89PNG" else "jpeg"
        self._picture.set_source(f"data:image/{kind};base64,{base64.b64encode(image).decode()}")

    # Time.

    def go_to_line(self, line: int) -> None:
        """Go to the middle of what a line draws, and mark it in the picture."""
        if self._shown is None:
            return
        rows = np.flatnonzero(self._shown.line == line)
        if len(rows):
            self.go_to_time(float(self._shown.time[rows[len(rows) // 2]]))
            self._mark_stroke(rows)

    def go_to_time(self, seconds: float) -> None:
        """Show the moment of a time of the drawing [s]."""
        self._time.go_to(seconds)

    @property
    def _moment(self) -> tuple[int, float] | None:
        """The line that is being drawn and the share of it that is; None is the end of all."""
        if self._shown is None or self._time.is_end:
            return None
        at = self._row_at(self._time.times[self._time.index])
        rows = np.flatnonzero(self._shown.line == self._shown.line[at])
        return int(self._shown.line[at]), float((rows < at).mean())

    def _set_times(self, moment: tuple[int, float] | None) -> None:
        """Begin the time axis of what is shown now, at the same moment of the drawing."""
        run, shown = self._run, self._shown
        times = run.frame_time if run is not None else np.zeros(1) if shown is None else shown.time
        index = len(times) - 1
        if moment is not None and shown is not None:
            rows = np.flatnonzero(shown.line == moment[0])
            if len(rows):
                row = rows[min(int(moment[1] * len(rows)), len(rows) - 1)]
                index = int(np.argmin(np.abs(times - shown.time[row])))
        self._time.set_times(times, index)

    def _row_at(self, seconds: float) -> int:
        """The row of the sketch at a time."""
        assert self._shown is not None
        return int(np.argmin(np.abs(self._shown.time - seconds)))

    def _scrubbed(self, index: int) -> None:
        """Show a moment everywhere: picture, arm, curves, text."""
        run, shown, ended = self._run, self._shown, self._time.is_end
        if run is not None:
            image = run.image if ended else self._frames.get(index)
            if image is not None:
                self._set_image(image)
        seconds = float(self._time.times[index])
        self._charts.set_time(seconds)
        if shown is None:
            return
        at = self._row_at(seconds)
        self.editor.mark_line(0 if ended else int(shown.line[at]))
        x, y = shown.pixels[at]
        self._picture.content = "" if ended else _dot(x, y)
        point = shown.points[at]
        if run is not None:
            point = run.points[int(np.argmin(np.abs(run.time - seconds)))]
        self._view.show(index, point, shown.colours[at])

    def _mark_stroke(self, rows: Any) -> None:
        assert self._shown is not None
        points = " ".join(f"{x:.1f},{y:.1f}" for x, y in self._shown.pixels[rows])
        self._picture.content = f'<polyline points="{points}" class="stroke"/>'

    def _picked(self, event: events.MouseEventArguments) -> None:
        """Go to the moment of the stroke that was clicked."""
        if self._shown is None:
            return
        away = np.linalg.norm(self._shown.pixels - [event.image_x, event.image_y], axis=1)
        away = np.where(self._shown.colours.max(axis=1) > 0, away, np.inf)
        at = int(np.argmin(away))
        if away[at] < 30:
            self.go_to_time(float(self._shown.time[at]))
            self.editor.reveal(max(1, int(self._shown.line[at])))

    def set_drawing(self, shared: sharing.Shared) -> None:
        """Show another drawing; its choices replace those there are, where it has any."""
        self.name = shared.name
        if shared.choices:
            self.panel.set_choices(shared.choices)
        self.editor.replace(shared.text)
        self._edited(shared.text)

    @property
    def choices(self) -> dict[str, Any]:
        """The choices of the run."""
        return dict(self.panel.choices)

    # Sharing and keeping.

    def keep(self) -> None:
        """Keep the run that is shown, for comparisons."""
        run = self._run
        if run is None:
            ui.notify("There is no run to keep yet.", type="warning")
            return
        while len(self._kept) >= MOST_KEPT:
            self._kept.pop(next(iter(self._kept)))
        name = f"{next(self._keeps)}: {run.title}"
        self._kept[name] = run
        if self._asked is not None:
            self._requests[name] = self._asked
        self._comparison.set_runs({**self._kept, "now": run})

    def ask_page(self) -> None:
        """Make the run a page of its own."""
        self._studio.runner.submit(self.key, self._request("page"), self._answer)
        ui.notify("The page is being made.")

    def _judge(self, one: str, other: str) -> None:
        """Ask whether two runs differ by more than their spread."""
        first, second = (self._requests.get(name, self._asked) for name in (one, other))
        if first is None or second is None or first is second:
            ui.notify("Keep a run, change something, and choose both.", type="warning")
            return
        request = replace(first, want="verdict", other=(second.text, second.choices))
        self._studio.runner.submit(self.key, request, self._answer)

    def close(self) -> None:
        """Forget what the workers were asked, and what was served."""
        self._closed = True
        if self._timer is not None:
            self._timer.cancel()
        self._studio.forget(self.key)


def _dot(x: float, y: float) -> str:
    return f'<circle cx="{x:.1f}" cy="{y:.1f}" r="5" class="dot"/>'

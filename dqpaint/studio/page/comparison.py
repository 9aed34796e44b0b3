"""Runs that were kept -> side by side: a wipe between pictures, the difference, their figures."""

import base64
from collections.abc import Callable, Mapping

import cv2
import numpy as np
from nicegui import ui
from numpy.typing import NDArray

from dqpaint.studio.work.messages import Run

GREATEST = 16  # times the difference


class ComparisonView:
    """The comparison of one page.

    Args:
        keep: keeps the run that is shown.
        curves: shows the curves of some runs over each other.
        judge: asks whether two of them, by their names, differ by more than their spread.
    """

    def __init__(
        self,
        keep: Callable[[], None],
        curves: Callable[[Mapping[str, Run]], None],
        judge: Callable[[str, str], None],
    ) -> None:
        self._runs: dict[str, Run] = {}
        self._curves = curves
        with ui.row().classes("w-full items-center no-wrap"):
            ui.button("keep this run", icon="push_pin", on_click=keep).props("dense no-caps flat")
            self._first = ui.select([], label="left", on_change=self._show).props("dense outlined")
            self._second = ui.select([], label="right", on_change=self._show).props(
                "dense outlined"
            )
        with ui.element("div").classes("wipe") as self._wipe:
            self._left = ui.image().classes("wipe-left")
            self._right = ui.image().classes("wipe-right")
        self._slider = ui.slider(min=0, max=100, value=50, on_change=self._cut).props(
            'aria-label="wipe between the pictures"'
        )
        ui.label("their difference, magnified").classes("note")
        self._difference = ui.image().classes("difference")
        self._times = ui.label().classes("note")
        ui.button(
            "is it more than noise?", icon="casino",
            on_click=lambda: judge(self._first.value, self._second.value),
        ).props("dense no-caps flat")  # fmt: skip
        self._verdict = ui.label().classes("verdict")
        self._table = ui.grid(columns="auto auto auto auto").classes("figures")

    def set_runs(self, runs: Mapping[str, Run]) -> None:
        """The runs that may be compared, by their names."""
        self._runs = dict(runs)
        names = list(runs)
        first = self._first.value if self._first.value in runs else names[0]
        second = self._second.value if self._second.value in runs else names[-1]
        self._first.set_options(names, value=first)
        self._second.set_options(names, value=second)
        self._show()

    def show_verdict(self, text: str) -> None:
        """Say whether they differ."""
        self._verdict.text = text

    def _show(self) -> None:
        one, two = self._runs.get(self._first.value), self._runs.get(self._second.value)
        if one is None or two is None:
            return
        self._verdict.text = ""
        self._left.set_source(_url(one.image))
        self._right.set_source(_url(two.image))
        times, image = difference(one.image, two.image)
        self._difference.set_source(_url(image))
        self._times.text = f"{times:g} times as large; black: the same" if times else "the same"
        self._curves({self._first.value: one, self._second.value: two})
        self._fill_table(one, two)

    def _fill_table(self, one: Run, two: Run) -> None:
        self._table.clear()
        others = {figure.name: figure for figure in two.figures}
        with self._table:
            for text in ("", "left", "right", "right / left"):
                ui.label(text).classes("heading")
            for figure in one.figures:
                other = others.get(figure.name)
                if other is None:
                    continue
                ui.label(f"{figure.title} [{figure.unit}]" if figure.unit else figure.title)
                ui.label(f"{figure.value:.4g}")
                ui.label(f"{other.value:.4g}")
                ui.label(f"{other.value / figure.value:.3g}" if figure.value else "")
            for name, run in (("left", one), ("right", two)):
                if run.faults:
                    ui.label(f"{name} is no result").classes("no-result")

    def _cut(self) -> None:
        self._wipe.style(f"--cut: {self._slider.value}%")


def difference(one: bytes, two: bytes) -> tuple[float, bytes]:
    """How much the difference of two pictures was magnified, and its picture, PNG.

    Args:
        one: PNG.
        two: PNG of the same size.
    """
    first, second = _decoded(one), _decoded(two)
    if first.shape != second.shape:
        second = np.asarray(cv2.resize(second, (first.shape[1], first.shape[0])), np.uint8)
    away = np.abs(first.astype(np.int16) - second)
    largest = int(away.max())
    times = 0.0 if not largest else float(min(GREATEST, max(1.0, 255 / largest)))
    shown = np.clip(times * away, 0, 255).astype(np.uint8)
    return times, cv2.imencode(".png", shown)[1].tobytes()


def _decoded(image: bytes) -> NDArray[np.uint8]:
    return np.asarray(cv2.imdecode(np.frombuffer(image, np.uint8), cv2.IMREAD_COLOR), np.uint8)


def _url(image: bytes) -> str:
    return f"data:image/png;base64,{base64.b64encode(image).decode()}"

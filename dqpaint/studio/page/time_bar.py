"""The bar below the page: a moment of the drawing, chosen or played."""

from collections.abc import Callable

import numpy as np
from nicegui import ui

from dqpaint.dq import Floats

PLAY_RATE = 25  # frames a second
SECONDS_SHOWN = 10.0  # a longer drawing is played faster


class TimeBar:
    """A slider over some times, and a button that plays them.

    Args:
        changed: called with the index of a time.
    """

    def __init__(self, changed: Callable[[int], None]) -> None:
        self._changed = changed
        self.times: Floats = np.zeros(1)
        self._button = ui.button(icon="play_arrow", color=None, on_click=self.play).props(
            'flat dense aria-label="play"'
        )
        self._slider = ui.slider(
            min=0, max=1, step=1, value=0, on_change=lambda event: self._move(event.value)
        ).props('aria-label="time"')
        self._clock = ui.label("").classes("clock")
        self._player = ui.timer(1 / PLAY_RATE, self._tick, active=False)

    @property
    def index(self) -> int:
        """Of the time that is shown."""
        return min(int(self._slider.value or 0), len(self.times) - 1)

    @property
    def is_end(self) -> bool:
        """Whether the whole drawing is shown."""
        return self.index >= len(self.times) - 1

    def set_times(self, times: Floats, index: int) -> None:
        """Begin another axis of times (F,) [s], at one of them."""
        self.times = times
        self._slider.props(f"max={len(times) - 1}")
        same = self._slider.value == index
        self._slider.value = index
        if same:
            self._move(index)

    def go_to(self, seconds: float) -> None:
        """Show the time nearest to one [s]."""
        self._slider.value = int(np.argmin(np.abs(self.times - seconds)))

    def play(self) -> None:
        """Play from where it is, from the begin if that is the end; or stop."""
        if self._player.active:
            self._player.deactivate()
        else:
            if self.is_end:
                self._slider.value = 0
            self._player.activate()
        self._button.props(f"icon={'pause' if self._player.active else 'play_arrow'}")

    def _tick(self) -> None:
        frames = PLAY_RATE * min(float(self.times[-1]), SECONDS_SHOWN)
        step = max(1, round(len(self.times) / max(frames, 1.0)))
        self._slider.value = min(self.index + step, len(self.times) - 1)
        if self.is_end:
            self.play()

    def _move(self, _value: float) -> None:
        self._clock.text = f"{self.times[self.index]:6.2f} s"
        self._changed(self.index)

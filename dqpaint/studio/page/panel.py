"""The choices of a run as controls: law, gains, plant, arm, disturbances, view, exposure, brush."""

import math
from collections.abc import Callable, Mapping, Sequence
from typing import Any

from nicegui import ui

from dqpaint.settings import DEFAULT_CONTROLLER
from dqpaint.studio.choices import Control, Gain, controls, gains_of

FIRST_PANELS = ("Control", "Arm")
GAIN_SPAN = 8.0  # a slider goes from an eighth of the usual value to eight times of it
SLIDER_STEPS = 200


class Panel:
    """The controls of one page.

    Args:
        choices: to begin with, by their names in Python.
        laws: files of laws that the command line named.
        changed: called with what was chosen, each time.
    """

    def __init__(
        self,
        choices: Mapping[str, Any],
        laws: Sequence[str],
        changed: Callable[[dict[str, Any]], None],
    ) -> None:
        self.choices: dict[str, Any] = dict(choices)
        self._changed = changed
        self._laws = laws
        self._column = ui.column().classes("w-full gap-0")
        self._fill()

    def set_choices(self, choices: Mapping[str, Any]) -> None:
        """Make other choices."""
        self.choices = dict(choices)
        self._fill()

    def _fill(self) -> None:
        self._column.clear()
        with self._column:
            for panel, group in controls(self._laws).items():
                with ui.expansion(panel, value=panel in FIRST_PANELS).classes("w-full panel"):
                    for control in group:
                        self._add(control)

    def _add(self, control: Control) -> None:
        if control.keyword == "gains":
            self._gains = ui.column().classes("w-full gap-1 gains")
            self._fill_gains()
            return
        option, keyword = control.setting.option, control.keyword
        value = self.choices.get(keyword, None)
        label = control.setting.name
        if control.kind == "switch":
            made: Any = ui.switch(label, value=bool(value))
        elif control.kind == "number":
            usual = control.setting.default
            made = ui.number(label, value=value, placeholder=_text(usual))
        elif control.kind in ("choice", "names"):
            usual = option.unsaid or _text(control.setting.default)
            several = option.many
            made = ui.select(
                list(dict.fromkeys([*control.names, *_values(value)])),
                label=f"{label} ({usual})" if usual and not several else label,
                value=_values(value) if several else value,
                with_input=True, clearable=True, multiple=several,
                new_value_mode="add-unique" if control.kind == "names" else None,
            ).props("use-chips" if several else "")  # fmt: skip
        else:
            made = ui.input(label, value=value or "", placeholder=option.unsaid or "")
        if control.kind != "switch":
            made.props("dense outlined options-dense debounce=300").classes("w-full")
        made.tooltip(option.help)
        made.on_value_change(lambda event: self._set(keyword, event.value))

    def _set(self, keyword: str, value: Any) -> None:
        if value in (None, "", [], False):
            self.choices.pop(keyword, None)
        else:
            whole = isinstance(value, float) and value.is_integer()
            self.choices[keyword] = int(value) if whole else value
        if keyword == "controller":
            self.choices.pop("gains", None)
            self._fill_gains()
        self._changed(self.choices)

    def _fill_gains(self) -> None:
        self._gains.clear()
        with self._gains:
            for gain in gains_of(str(self.choices.get("controller", DEFAULT_CONTROLLER))):
                if gain.default > 0:
                    self._add_gain(gain)

    def _add_gain(self, gain: Gain) -> None:
        """A slider over the logarithm of a gain."""
        value = float(self.choices.get("gains", {}).get(gain.name, gain.default))
        with ui.row().classes("w-full no-wrap items-center gap-2"):
            ui.label(gain.name).classes("gain-name").tooltip(gain.about)
            reach = math.log(GAIN_SPAN)
            at = min(reach, max(-reach, math.log(value / gain.default)))
            slider = ui.slider(min=-reach, max=reach, step=2 * reach / SLIDER_STEPS, value=at)
            slider.props(f'aria-label="gain {gain.name}"')
            shown = ui.label(f"{value:.3g}").classes("gain-value")

        def change(event: Any) -> None:
            new = float(f"{gain.default * math.exp(event.value):.3g}")
            shown.text = f"{new:.3g}"
            gains = {**self.choices.get("gains", {}), gain.name: new}
            if new == gain.default:
                del gains[gain.name]
            self._set("gains", gains or None)

        slider.on_value_change(change)


def _text(value: object) -> str:
    return "" if value is None or value == {} else str(value)


def _values(value: object) -> list[str]:
    if value is None:
        return []
    if isinstance(value, Mapping):
        return [f"{name}:{one}" for name, one in value.items()]
    return [str(one) for one in value] if isinstance(value, list | tuple) else [str(value)]

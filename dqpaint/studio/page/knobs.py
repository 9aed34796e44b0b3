"""The numbers of a drawing that have names -> a slider for each."""

from typing import Any

from nicegui import ui

from dqpaint.studio.page import colours
from dqpaint.studio.page.editor import Editor

MOST_KNOBS = 12
SPAN = 3.0  # times the number, to which its slider goes


class Knobs:
    """The sliders below the text: one for each `let` with a number.

    Args:
        editor: whose text they change.
    """

    def __init__(self, editor: Editor) -> None:
        self._editor = editor
        self._names: tuple[str, ...] = ()
        self._column = ui.column().classes("knobs gap-0")
        self.fill()

    def fill(self) -> None:
        """Make the sliders anew, if the text has other names."""
        found = [one for one in colours.numbers(self._editor.text) if one.name][:MOST_KNOBS]
        names = tuple(one.name for one in found)
        if names == self._names:
            return
        self._names = names
        self._column.clear()
        with self._column:
            for one in found:
                self._add(one)

    def _add(self, number: colours.Number) -> None:
        written = number.span.text_in(self._editor.text)
        reach = SPAN * (abs(number.value) or 1.0)
        with ui.row().classes("knob no-wrap items-center"):
            ui.label(number.name).classes("gain-name")
            slider = ui.slider(
                min=0.0 if number.value >= 0 else -reach,
                max=reach,
                step=colours.step_of(written),
                value=number.value,
            )
            slider.props(f'aria-label="{number.name}"')
            ui.label(number.unit).classes("gain-value")

        def change(event: Any) -> None:
            numbers = colours.numbers(self._editor.text)
            now = next((one for one in numbers if one.name == number.name), None)
            if now is not None and now.value != event.value:
                self._editor.set_number(now, float(event.value), written)

        slider.on_value_change(change)

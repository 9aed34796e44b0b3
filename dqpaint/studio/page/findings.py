"""Diagnostics -> a list below the text, with their help, and their fixes to click."""

from collections.abc import Sequence

from nicegui import ui

from dqpaint.studio.page.editor import Editor
from dqpaint.studio.work.messages import Finding

MOST_SHOWN = 20


class FindingList:
    """The list of one page.

    Args:
        editor: whose text they are about.
    """

    def __init__(self, editor: Editor) -> None:
        self._editor = editor
        self._column = ui.column().classes("messages gap-0")

    def show(self, findings: Sequence[Finding]) -> None:
        """Show these."""
        self._column.clear()
        with self._column:
            for one in findings[:MOST_SHOWN]:
                self._add(one)

    def _add(self, found: Finding) -> None:
        kind = "message-error" if found.is_error else "message-warning"
        with ui.row().classes(f"message {kind} no-wrap items-start"):
            ui.label(f"{found.line}").classes("place").on(
                "click", lambda: self._editor.reveal(found.line)
            )
            with ui.column().classes("gap-0 grow"):
                ui.label(f"{found.code}: {found.message}")
                if found.help:
                    ui.label(found.help).classes("help")
            if found.fix is not None:
                fix = found.fix
                ui.button(fix[0], on_click=lambda: self._editor.apply_fix(fix)).props(
                    "dense flat no-caps size=sm"
                ).classes("fix")

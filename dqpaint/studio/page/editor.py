"""The text of the page: colours, messages with their fixes, completion, hover, numbers to drag."""

from collections.abc import Callable, Sequence

from nicegui import events, ui

from dqpaint.editors import completion
from dqpaint.language import ScriptError
from dqpaint.language.writing import formatter
from dqpaint.studio.page import colours
from dqpaint.studio.work.messages import Finding

MARGIN = 60  # lines above and below the visible ones that are coloured
FIRST_LINES = 120
HOVER_PAUSE = 0.15  # [s]
LONGEST_ANSWER = 5.0  # [s] of the page
MOST_WORDS = 60  # of a completion
# The offset in the text of the cursor or the mouse, and its place on the page.
CURSOR = """
const view = getElement({id}).editor, head = view.state.selection.main.head;
const at = view.coordsAtPos(head) || {{left: 0, bottom: 0}};
return [head, at.left, at.bottom, view.state.doc.toString()];
"""
SELECT = """
const view = getElement({id}).editor;
view.dispatch({{selection: {{anchor: {anchor}}}}});
view.focus();
"""
UNDO = """
const view = getElement({id}).editor;
view.focus();
view.contentDOM.dispatchEvent(new KeyboardEvent("keydown",
  {{key: "z", code: "KeyZ", keyCode: 90, ctrlKey: true, bubbles: true, cancelable: true}}));
"""
# The editor keeps this key to itself, so it cannot be in the table of keys.
ON_COMPLETION = "(event) => { if (event.ctrlKey && event.code === 'Space') emit({}); }"
UNDER_MOUSE = """(event) => {{
  const view = getElement({id}).editor;
  const at = view && view.posAtCoords({{x: event.clientX, y: event.clientY}});
  emit({{at: at === null ? -1 : at, x: event.clientX, y: event.clientY,
        alt: event.altKey, buttons: event.buttons}});
}}"""


class Editor:
    """The text, and what is known of it.

    Args:
        text: to begin with.
        changed: called with each new text.
        pointed: called with the line that was clicked.
        saved: called with Ctrl-S.
        read_only: whether it cannot be changed.
    """

    def __init__(
        self,
        text: str,
        changed: Callable[[str], None],
        pointed: Callable[[int], None],
        saved: Callable[[], None],
        read_only: bool = False,
    ) -> None:
        self._changed = changed
        self._pointed = pointed
        self._findings: Sequence[Finding] = ()
        self._lines: dict[int, str] = {}
        self._current = 0
        self._visible = (1, FIRST_LINES)
        self._drag: tuple[colours.Number, str, float] | None = None
        self.view = ui.codemirror(
            text,
            on_change=lambda _event: self._edited(),
            theme="vscodeDark",
            indent="  ",
            on_viewport_change=self._scrolled,
            keymap={
                "Shift-Alt-f": lambda _event: self.format(),
                "Mod-s": lambda _event: saved(),
            },
        ).classes("editor")
        if read_only:
            self.view.disable()
        under_mouse = UNDER_MOUSE.format(id=self.view.id)
        self.view.on("mousemove", self._moved, throttle=HOVER_PAUSE, js_handler=under_mouse)
        self.view.on("click", self._clicked, js_handler=under_mouse)
        self.view.on("keydown", self.complete, js_handler=ON_COMPLETION)
        with ui.card().classes("hover-card") as self._card:
            self._hover = ui.markdown("")
        with ui.card().classes("completion-card") as self._menu:
            self._words = ui.list().props("dense role=listbox")
        self._card.visible = self._menu.visible = False
        self.show()

    @property
    def text(self) -> str:
        """The text."""
        return str(self.view.value or "")

    def replace(self, text: str) -> None:
        """Set another text; undo takes it back."""
        self.view.value = text

    def show_findings(self, findings: Sequence[Finding], lines: dict[int, str] | None) -> None:
        """Underline what diagnostics are about; `lines` says what each line draws."""
        self._findings = findings
        if lines is not None:
            self._lines = lines
        self.show()

    def mark_line(self, line: int) -> None:
        """Mark the line of the moment that is shown; 0 is none."""
        if line != self._current:
            self._current = line
            self.show()

    def reveal(self, line: int) -> None:
        """Scroll to a line."""
        self.view.reveal_line(line)

    def show(self) -> None:
        """Draw colours, underlines and the marked line over the text."""
        text = self.text
        first, last = self._visible
        size, count = len(text), text.count("\n") + 1
        marks = list(colours.marks(text, max(1, first - MARGIN), last + MARGIN))
        marks += colours.underlines(self._findings, text)
        marks += [
            colours.line_mark(finding.line, "l-error" if finding.is_error else "l-warning")
            for finding in self._findings
            if finding.here and finding.line <= count
        ]
        if 0 < self._current <= count:
            marks.append(colours.line_mark(self._current, "l-now"))
        # not as a property: with each of these the text goes along, as the server knows it, and
        # what was typed meanwhile would be lost
        fitting = [one for one in marks if one.get("to", 0) <= size]
        self.view.run_method("setDecorations", fitting)

    def undo(self) -> None:
        """Take the last change back."""
        ui.run_javascript(UNDO.format(id=self.view.id))

    def format(self) -> None:
        """Lay the text out anew."""
        try:
            self.replace(formatter.formatted(self.text))
        except ScriptError:
            ui.notify("A text with an error cannot be formatted.", type="warning")

    async def complete(self) -> None:
        """Offer what may follow at the cursor."""
        script = CURSOR.format(id=self.view.id)
        at, left, bottom, text = await ui.run_javascript(script, timeout=LONGEST_ANSWER)
        start = at
        while start > 0 and (text[start - 1].isalnum() or text[start - 1] == "_"):
            start -= 1
        begun = text[start:at].lower()
        found = [
            one for one in completion.completions(text, at) if one.word.lower().startswith(begun)
        ]
        self._words.clear()
        with self._words:
            for one in found[:MOST_WORDS]:
                with ui.item(
                    on_click=lambda one=one: self._insert(text, start, at, one.word)
                ).props("tabindex=0 role=option"):
                    ui.label(one.word).classes("word")
                    ui.label(one.meaning).classes("meaning")
        if not found:
            ui.notify("Nothing can follow here.", timeout=1500)
            return
        self._menu.style(f"left: {left}px; top: {bottom}px")
        self._menu.visible = True
        await ui.run_javascript(
            f"setTimeout(() => document.querySelector('#c{self._words.id} .q-item')?.focus(), 50)"
        )

    def close_menu(self) -> None:
        """Close the completion."""
        self._menu.visible = False

    def _insert(self, text: str, start: int, end: int, word: str) -> None:
        self.close_menu()
        self.replace(text[:start] + word + text[end:])
        ui.run_javascript(SELECT.format(id=self.view.id, anchor=start + len(word)))

    def _edited(self) -> None:
        self.close_menu()
        self.show()
        self._changed(self.text)

    def _scrolled(self, event: events.CodeMirrorViewportChangeEventArguments) -> None:
        self._visible = event.from_line, event.to_line
        self.show()

    def _clicked(self, event: events.GenericEventArguments) -> None:
        at = int(event.args["at"])
        self._card.visible = False
        self.close_menu()
        if at >= 0:
            self._pointed(self.text.count("\n", 0, at) + 1)

    def _moved(self, event: events.GenericEventArguments) -> None:
        """Say what the word under the mouse means, and drag the number that Alt holds."""
        at, x = int(event.args["at"]), float(event.args["x"])
        if event.args["buttons"] and (event.args["alt"] or self._drag):
            self._dragged(at, x)
            return
        self._drag = None
        found = self._meaning(at) if at >= 0 else ""
        self._card.visible = bool(found)
        if found:
            self._hover.set_content(found)
            self._card.style(f"left: {x + 12}px; top: {float(event.args['y']) + 18}px")

    def _meaning(self, at: int) -> str:
        text = self.text
        for finding in self._findings:
            if finding.here and finding.start <= at <= finding.end:
                help_text = f"\n\n*{finding.help}*" if finding.help else ""
                return f"**{finding.code}** {finding.message}{help_text}"
        found = completion.meaning_at(text, at)
        if found is None:
            return ""
        entry, _ = found
        parts = [f"**{entry.word}**: {entry.meaning}", f"`{entry.example}`"]
        line = self._lines.get(text.count("\n", 0, at) + 1)
        return "\n\n".join(([line] if line else []) + parts)

    def _dragged(self, at: int, x: float) -> None:
        """Change the number that the drag began on, by the way the mouse went."""
        if self._drag is None:
            number = colours.number_at(self.text, at)
            if number is not None:
                self._drag = number, number.span.text_in(self.text), x
            return
        first, written, begin = self._drag
        number = colours.number_at(self.text, first.span.start) or first
        self.set_number(number, first.value + (x - begin) * colours.step_of(written), written)

    def set_number(self, number: colours.Number, value: float, like: str) -> None:
        """Write another value in the place of a number."""
        text, span = self.text, number.span
        self.replace(text[: span.start] + colours.spelled(value, like) + text[span.end :])

    def apply_fix(self, fix: tuple[str, int, int, str]) -> None:
        """Make the edit that a diagnostic offers."""
        _, start, end, new = fix
        text = self.text
        self.replace(text[:start] + new + text[end:])

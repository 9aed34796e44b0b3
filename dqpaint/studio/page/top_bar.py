"""The bar above the page: the drawing's file, its layout, and what is passed on to others."""

from pathlib import Path
from typing import Any, Protocol

from nicegui import events, ui

from dqpaint.core import example_names
from dqpaint.errors import DqpaintError
from dqpaint.studio import sharing
from dqpaint.studio.folder import NEW, read_example
from dqpaint.studio.page.editor import Editor
from dqpaint.studio.shared import Studio

FLAT = "flat dense"
LARGEST_UPLOAD = 3_000_000  # bytes


class Host(Protocol):
    """The page, as the bar knows it."""

    editor: Editor
    name: str

    @property
    def choices(self) -> dict[str, Any]:
        """The choices of the run."""

    def set_drawing(self, shared: sharing.Shared) -> None:
        """Show another drawing."""

    def ask_page(self) -> None:
        """Make the run a page of its own."""


class TopBar:
    """The bar of one page.

    Args:
        page: that it stands above.
        studio: what all pages share.
        present: whether it only turns the pages.
    """

    def __init__(self, page: Host, studio: Studio, present: bool) -> None:
        self._page, self._studio, self._present = page, studio, present
        ui.label("dqpaint").classes("brand")
        if present:
            self._turner(-1, "chevron_left", "the drawing before")
            self._title = ui.input(value=page.name).props("dense borderless readonly")
            self._turner(1, "chevron_right", "the next drawing")
        else:
            self._build_files()
        ui.space()
        self._lamp = ui.label("live").classes("lamp lamp-live")
        if not present:
            self._build_share()
        ui.keyboard(self._key)

    def show_live(self, wrong: bool) -> None:
        """Say whether the picture is that of the text."""
        self._lamp.text = "an error: the last good picture" if wrong else "live"
        name = "lamp-error" if wrong else "lamp-live"
        self._lamp.classes(add=name, remove="lamp-live lamp-error")

    def turn(self, by: int) -> None:
        """Go to another drawing of the folder."""
        names = self._studio.folder.names()
        if names:
            at = names.index(self._page.name) if self._page.name in names else 0
            self._open(names[(at + by) % len(names)])

    def save(self) -> None:
        """Write the text into its file."""
        try:
            self._studio.folder.save(self._page.name, self._page.editor.text)
        except DqpaintError as problem:
            ui.notify(str(problem), type="negative")
            return
        ui.notify(f"saved {self._page.name}", type="positive", timeout=1500)

    def _turner(self, by: int, icon: str, label: str) -> None:
        button = ui.button(icon=icon, color=None, on_click=lambda: self.turn(by))
        button.props(f'{FLAT} aria-label="{label}"')

    def _build_files(self) -> None:
        opened = ui.button(icon="folder_open", color=None).props(FLAT).tooltip("open")
        with opened, ui.menu().props("max-height=70vh"):
            for name in self._studio.folder.names():
                ui.menu_item(name, lambda name=name: self._open(name))
            ui.separator()
            for name in example_names():
                ui.menu_item(f"{name}, an example", lambda name=name: self._open_example(name))
            ui.separator()
            ui.upload(
                label="a shared file", auto_upload=True, max_file_size=LARGEST_UPLOAD,
                on_upload=self._upload,
            ).props("flat dense accept=.json")  # fmt: skip
        self._title = ui.input(value=self._page.name, on_change=self._rename).props(
            'dense borderless aria-label="name of the drawing"'
        )
        self._title.classes("title")
        for icon, tip, action in (
            ("save", "save (Ctrl-S)", self.save),
            ("notes", "format (Shift-Alt-F)", lambda: self._page.editor.format()),
            ("undo", "undo (Ctrl-Z)", lambda: self._page.editor.undo()),
        ):
            ui.button(icon=icon, color=None, on_click=action).props(FLAT).tooltip(tip)

    def _build_share(self) -> None:
        share = ui.button(icon="share", color=None).props(FLAT).tooltip("share")
        with share, ui.menu():
            ui.menu_item("copy a link", self._copy_link)
            ui.menu_item("a file with text and choices", self._download)
            ui.menu_item("the run as one page in 3-D (HTML)", self._page.ask_page)

    def _rename(self, event: events.ValueChangeEventArguments[str | None]) -> None:
        self._page.name = event.value or NEW

    def _open(self, name: str) -> None:
        try:
            text = self._studio.folder.read(name)
        except DqpaintError as problem:
            ui.notify(str(problem), type="negative")
            return
        self._show(sharing.Shared(name, text))

    def _open_example(self, name: str) -> None:
        self._show(sharing.Shared(f"{name}.traj", read_example(name)))

    async def _upload(self, event: events.UploadEventArguments) -> None:
        try:
            shared = sharing.from_json(await event.file.read(), self._studio.laws)
        except DqpaintError as problem:
            ui.notify(str(problem), type="negative")
            return
        self._show(shared)

    def _show(self, shared: sharing.Shared) -> None:
        self._title.value = shared.name
        self._page.set_drawing(shared)

    def _key(self, event: events.KeyEventArguments) -> None:
        if not event.action.keydown:
            return
        turning = {"ArrowLeft": -1, "PageUp": -1, "ArrowRight": 1, "PageDown": 1}
        if self._present and str(event.key) in turning:
            self.turn(turning[str(event.key)])
        elif event.key == "s" and event.modifiers.ctrl and not self._present:
            self.save()
        elif event.key == "Escape":
            self._page.editor.close_menu()

    def _shared(self) -> sharing.Shared:
        return sharing.Shared(self._page.name, self._page.editor.text, self._page.choices)

    def _copy_link(self) -> None:
        try:
            link = sharing.to_link(self._shared())
        except DqpaintError as problem:
            ui.notify(str(problem), type="warning")
            return
        ui.run_javascript(f"navigator.clipboard.writeText(location.origin + '/?z={link}')")
        ui.notify("The link is copied: who opens it needs a studio on the same port.")

    def _download(self) -> None:
        name = f"{Path(self._page.name).stem}.dqstudio.json"
        ui.download.content(sharing.to_json(self._shared()), name)

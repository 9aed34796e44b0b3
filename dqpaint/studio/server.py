"""A folder and a drawing -> the studio: a server on this machine alone, until Ctrl-C."""

import asyncio
import contextlib
import socket
import webbrowser
from collections.abc import AsyncIterator, Callable, Sequence
from pathlib import Path

import uvicorn
from fastapi import FastAPI, Response
from nicegui import ui

from dqpaint.core import find_drawing
from dqpaint.errors import DqpaintError, UsageError
from dqpaint.studio import sharing
from dqpaint.studio.folder import NEW
from dqpaint.studio.guard import Guard, new_token
from dqpaint.studio.page.live_page import Page
from dqpaint.studio.shared import MOST_PAGES, Studio

ADDRESS = "127.0.0.1"
LARGEST_MESSAGE = 8_000_000  # bytes of one message of a page
FIRST_TEXT = """# A line of light: change a number, and see.
speed 120 mm/s
let r = 70 mm

move to polar(r, 90 deg)
repeat i from 1 to 5
  line to polar(r, 90 deg + i*144 deg) light hsv(i*72 deg)
end
"""


def make_app(studio: Studio, present: bool = False) -> FastAPI:
    """The pages of a studio, not guarded yet; `present` for a lecture hall."""

    @contextlib.asynccontextmanager
    async def life(_app: FastAPI) -> AsyncIterator[None]:
        studio.start()
        yield
        studio.close()

    app = FastAPI(lifespan=life, docs_url=None, redoc_url=None, openapi_url=None)

    @app.get("/arm/{arm}/{index}.stl")
    def shape(arm: int, index: int) -> Response:
        return _file(studio.shape(arm, index), "model/stl")

    @app.get("/path/{page}/{index}.glb")
    def path(page: str, index: int) -> Response:
        return _file(studio.path(page, index), "model/gltf-binary")

    style = (Path(__file__).parent / "page" / "style.css").read_text()

    @ui.page("/", title="dqpaint studio")
    async def start(file: str = "", z: str = "") -> None:
        ui.add_css(style)
        if studio.pages >= MOST_PAGES:
            ui.label(f"{MOST_PAGES} pages of this studio are open: close one, and load this again")
            return
        try:
            shared = _first(studio, file, z, present)
        except DqpaintError as problem:
            ui.label(str(problem)).classes("no-result p-8")
            return
        studio.pages += 1
        page = Page(studio, shared.name, shared.text, shared.choices, present)

        def left() -> None:
            studio.pages -= 1
            page.close()

        ui.context.client.on_delete(left)

    ui.run_with(app, dark=True, reconnect_timeout=3.0, show_welcome_message=False)
    return app


def _first(studio: Studio, file: str, z: str, present: bool) -> sharing.Shared:
    if z:
        return sharing.from_link(z, studio.laws)
    if file:
        return sharing.Shared(file, studio.folder.read(file))
    names = studio.folder.names() if present else []
    if names:
        return sharing.Shared(names[0], studio.folder.read(names[0]))
    return sharing.Shared(NEW, FIRST_TEXT)


def _file(data: bytes | None, kind: str) -> Response:
    return Response(status_code=404) if data is None else Response(data, media_type=kind)


def run(
    file: str | None,
    port: int,
    laws: Sequence[str],
    opened: bool,
    present: bool,
    tell: Callable[[str], None],
) -> None:
    """Serve until Ctrl-C; arguments and errors as those of `dqpaint.studio.serve`."""
    root, name = _root(file)
    listener = _listen(port)
    port = listener.getsockname()[1]
    token = new_token()
    app = make_app(Studio(root, laws), present)
    guarded = Guard(app, token, port)
    address = f"http://{ADDRESS}:{port}/?token={token}" + (f"&file={name}" if name else "")
    settings = uvicorn.Config(
        guarded, log_level="warning", access_log=False, ws_max_size=LARGEST_MESSAGE,
        timeout_graceful_shutdown=1,
    )  # fmt: skip
    tell(address)
    if opened:
        webbrowser.open(address)
    with contextlib.suppress(KeyboardInterrupt):
        asyncio.run(uvicorn.Server(settings).serve(sockets=[listener]))


def _root(file: str | None) -> tuple[Path, str]:
    path = Path(file or ".")
    if path.is_dir():
        return path, ""
    path = find_drawing(str(path))
    return path.parent, path.name


def _listen(port: int) -> socket.socket:
    listener = socket.socket(socket.AF_INET, socket.SOCK_STREAM)
    listener.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
    try:
        listener.bind((ADDRESS, port))
    except OSError as problem:
        listener.close()
        raise UsageError(
            f"port {port} cannot be used ({problem.strerror}): choose another with --port"
        ) from None
    listener.listen(64)
    return listener

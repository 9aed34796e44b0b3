"""The command's choices -> the studio, served until Ctrl-C; its parts are loaded when it starts."""

import importlib.util
from collections.abc import Callable, Sequence

from dqpaint.errors import UsageError

DEFAULT_PORT = 8470


def serve(
    file: str | None,
    port: int = DEFAULT_PORT,
    laws: Sequence[str] = (),
    opened: bool = True,
    present: bool = False,
    tell: Callable[[str], None] = print,
) -> None:
    """Serve until Ctrl-C.

    Args:
        file: a drawing, or a folder; None is the folder of this process.
        port: to listen at; 0 chooses a free one.
        laws: files of laws that may be chosen.
        opened: whether to open the page in the browser.
        present: whether the pages are for a lecture hall: large, read-only.
        tell: called with the address.

    Raises:
        UsageError: the port is taken, the file is not there, or what serves pages is not installed.
    """
    if importlib.util.find_spec("nicegui") is None:
        raise UsageError("the studio needs: pip install 'dqpaint[studio]'")
    from dqpaint.studio.server import run

    run(file, port, laws, opened, present, tell)

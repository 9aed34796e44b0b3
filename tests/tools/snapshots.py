"""The wording of messages and commands, once: `python -m tests.tools.snapshots` writes it anew."""

import contextlib
import io
import os
import re
import sys
import tempfile
from collections.abc import Iterator
from pathlib import Path
from unittest import mock

from tests.support.commands import DRAWINGS, SHOWN, WRONG
from tests.support.wrong_drawings import ENTRIES, LARGE, OF_FILES, found, text_and_path, write

FOLDER = Path(__file__).parents[1] / "snapshots"
COMMAND = "python -m tests.tools.snapshots"
HEAD = f"Written by {COMMAND}; a test compares it with what is said now.\n\n"
FIGURE = re.compile(r"(?<![\w.])-?\d+(,\d{3})*(\.\d+)?(e[+-]?\d+)?(?!\w)")
OF_OTHERS = re.compile(
    r"\b(known|its gains|its values|the examples|near it|without one|cannot be (?:read|written))"
    r": [^\n]*"
)
WIDEST = 72  # of the heads


def messages() -> str:
    """Every message about a drawing, as a person reads it."""
    from dqpaint.language import ScriptError, read, render

    parts = []
    for entry in ENTRIES:
        text, path = text_and_path(entry)
        told = [render(d, "a.traj", text) for d in found(text, path)]
        parts.append((entry[0], "\n".join(told)))
    for name, (text, _, _) in LARGE.items():
        parts.append((f"too much: {name}", render(found(text)[0], "a.traj", text)))
    for code, files, _, caret in OF_FILES:
        with tempfile.TemporaryDirectory() as folder:
            try:
                read(write(Path(folder), files))
            except ScriptError as error:
                parts.append((f"{code} of files, at {caret}", str(error).replace(folder, "...")))
    return laid_out(parts)


def commands() -> str:
    """What commands say, figures left out: those that do something, and those that refuse to."""
    parts = []
    with mock.patch.dict(os.environ, {"COLUMNS": "100", "NO_COLOR": "1"}), drawings():
        for words in SHOWN:
            parts.append((" ".join(words), masked(answer(*words))))
    for words, _, _ in WRONG:
        with drawings():
            said = answer(*words)
        if not said.startswith("Usage:"):  # the words of the library that reads the options
            parts.append((" ".join(words), without_lists(said)))
    return laid_out(parts)


SNAPSHOTS = {"messages.txt": messages, "commands.txt": commands}


def answer(*words: str) -> str:
    """What a command says on both streams, in this process."""
    from dqpaint.cli import main

    out, err = (io.TextIOWrapper(io.BytesIO(), "utf-8") for _ in range(2))
    with (
        mock.patch.object(sys, "argv", ["dqpaint", *words]),
        contextlib.redirect_stdout(out),
        contextlib.redirect_stderr(err),
        contextlib.suppress(SystemExit),
    ):
        main.run()
    texts = []
    for stream in (out, err):
        stream.flush()
        texts.append(stream.buffer.getvalue().decode().rstrip())
    return "\n--\n".join(filter(None, texts))


@contextlib.contextmanager
def drawings() -> Iterator[None]:
    """A new folder with the drawings that commands are given, to be in."""
    with tempfile.TemporaryDirectory() as folder, contextlib.chdir(folder):
        for name, text in DRAWINGS.items():
            Path(name).write_text(text, "utf-8")
        yield


def masked(text: str) -> str:
    """A text without its figures, and without the blanks that depend on their width."""
    return re.sub(" {2,}", "  ", FIGURE.sub("#", text))


def without_lists(text: str) -> str:
    """A text without what a new law, gain or example would change, and the system's own words."""
    return OF_OTHERS.sub(r"\1: …", text)


def laid_out(parts: list[tuple[str, str]]) -> str:
    return HEAD + "".join(f">>> {shortened(head)}\n{body}\n\n" for head, body in parts)


def shortened(head: str) -> str:
    return head if len(head) <= WIDEST else f"{head[: WIDEST - 1]}…"


if __name__ == "__main__":
    FOLDER.mkdir(exist_ok=True)
    for name, make in SNAPSHOTS.items():
        (FOLDER / name).write_text(make(), "utf-8")

"""-q and -v among a command's words -> what is said on which stream.

Results go to standard output; notes, warnings and what is logged to standard error. `-q` leaves
warnings and errors, `-v` adds what happens as it happens, from the loggers below `dqpaint`.
"""

import sys
from collections.abc import Iterable, Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, TextIO

from dqpaint.cli.front.colours import Painter, findings, labels, show
from dqpaint.errors import UnknownNameError, UsageError

if TYPE_CHECKING:
    from dqpaint.diagnostics import Annotation

QUIET, VERBOSE = ("-q", "--quiet"), ("-v", "--verbose")
MANY = "-vv"
TO_STDOUT = "-"
FORMATS = ("text", "json", "github", "sarif")
"""Of findings."""
USUAL_SAVE = "png,csv,json"
FORMAT = "%(relativeCreated)6.0f ms  %(name)s: %(message)s"
_said: dict[str, bool] = {"quiet": False, "verbose": False}


def take_words(words: Sequence[str]) -> list[str]:
    """The words of a command without -q and -v, which are obeyed; those after `--` are data."""
    end = words.index("--") if "--" in words else len(words)
    head = list(words[:end])
    if any(word in QUIET for word in head):
        _said["quiet"] = True
    if depth := sum(word in VERBOSE for word in head) + 2 * head.count(MANY):
        _said["verbose"] = True
        _log_to_stderr(depth)
    return [w for w in head if w not in (*QUIET, *VERBOSE, MANY)] + list(words[end:])


def reset() -> None:
    """Say what is usual again."""
    _said.update(quiet=False, verbose=False)


def is_quiet() -> bool:
    """Whether only warnings and errors are wanted."""
    return _said["quiet"]


def is_talkative() -> bool:
    """Whether what happens is logged on standard error, where a bar would be in its way."""
    return _said["verbose"]


def tell_result(text: str, painter: Painter = labels, stream: TextIO | None = None) -> None:
    """Print what a command has found, unless only warnings and errors are wanted."""
    if not is_quiet():
        show(text, stream, painter)


def note(text: str) -> None:
    """Print a note on standard error, unless only warnings and errors are wanted."""
    if not is_quiet():
        show(text if text.startswith("note: ") else f"note: {text}", sys.stderr)


def remarks(texts: Iterable[str]) -> None:
    """Print warnings and notes on standard error; a text that begins with `note: ` is a note."""
    for text in texts:
        if text.startswith("note: "):
            note(text)
        else:
            show(text, sys.stderr, findings)


def check_stdout() -> None:
    """Refuse to write bytes to a terminal.

    Raises:
        UsageError: standard output is one.
    """
    if sys.stdout.isatty():
        raise UsageError(
            "--out - writes the file's bytes to standard output, which is a terminal: add "
            "> star.png, or give --out a name"
        )


def one_format(save: str, as_json: bool = False) -> str:
    """The format that --out - writes: the picture, or the one that --save names.

    Raises:
        UsageError: there are several, or the summary is to be printed there, too.
    """
    if as_json:
        raise UsageError("--out - and --json both write to standard output: give one of them")
    check_stdout()
    save = "png" if save == USUAL_SAVE else save
    if "," in save:
        raise UsageError(f"--out - writes one file, not '{save}': give --save one format")
    return save


def send_one(made: Mapping[str, bytes]) -> list[Path]:
    """Write the one file there is to standard output; the list of files written is empty.

    Raises:
        UsageError: there are several.
    """
    if len(made) != 1:
        several = ", ".join(made)
        raise UsageError(f"--out - writes one file, and here are {len(made)}: {several}")
    sys.stdout.flush()
    sys.stdout.buffer.write(next(iter(made.values())))
    sys.stdout.buffer.flush()
    return []


def choose_format(form: str) -> str:
    """The form in which findings are printed.

    Raises:
        UnknownNameError: there is none of that name.
    """
    if form not in FORMATS:
        raise UnknownNameError("format", form, FORMATS)
    return form


def tell_annotations(found: "Sequence[Annotation]", form: str) -> None:
    """Print findings as GitHub's commands or as SARIF."""
    from dqpaint.diagnostics import github_commands, sarif_log

    if form == "github":
        if found:
            print(github_commands(found))
        return
    import json

    from dqpaint import __version__
    from dqpaint.diagnostics import catalogue

    about = catalogue.explanations()
    rules = {one.code: about[one.code].title for one in found if one.code in about}
    print(json.dumps(sarif_log(found, rules, __version__), indent=2))


def _log_to_stderr(depth: int) -> None:
    import logging

    logger = logging.getLogger("dqpaint")
    logger.setLevel(logging.DEBUG if depth > 1 else logging.INFO)
    if not logger.handlers:
        handler = logging.StreamHandler(sys.stderr)
        handler.setFormatter(logging.Formatter(FORMAT))
        logger.addHandler(handler)

"""File or text -> Program."""

import gc
import re
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from pathlib import Path

from dqpaint.core import log
from dqpaint.diagnostics import Diagnostic, DiagnosticCollector, ErrorLimitError, ScriptError, Span
from dqpaint.language.expansion.expander import Expander
from dqpaint.language.expansion.includes import MOST_LINES, Loader
from dqpaint.language.syntax.source import MOST_BYTES, STDIN_NAME, decoded, load, load_input
from dqpaint.program import Program

_SVG = re.compile(r"\s*(<\?xml|<svg|<!DOCTYPE svg|<!--)", re.IGNORECASE)


def read(path: str | Path) -> Program:
    """The drawing in a file.

    Raises:
        DqpaintError: the file can't be read as text.
        ScriptError: the text is not a drawing.
    """
    return parse(_text_of(Path(path)), str(path), Path(path))


def read_input() -> Program:
    """The drawing on standard input; the files it names are relative to the working folder.

    Raises:
        DqpaintError: it can't be read as text.
        ScriptError: the text is not a drawing.
    """
    return parse(decoded(load_input(), STDIN_NAME), STDIN_NAME, Path(STDIN_NAME))


def _text_of(path: Path) -> str:
    return decoded(load(path), str(path))


def parse(text: str, name: str = "<text>", path: Path | None = None) -> Program:
    """The drawing in a text; `name` stands for it in messages.

    `path` is the file of the text, relative to which it includes and reads others.

    Raises:
        ScriptError: with every mistake that was found, in the order of the text.
    """
    findings = DiagnosticCollector()
    loader = Loader(text, path, _text_of, findings)
    expander: Expander | None = None
    fault: Exception | None = None
    program: Program | None = None
    try:
        if _fits(text, findings):
            with _collector_at_rest():
                statements = loader.statements()
                expander = Expander(name, loader.source, findings, path)
                program = expander.program(statements)
    except ErrorLimitError:
        pass
    except (OSError, MemoryError):  # of the machine
        raise
    except Exception as unexpected:
        fault = unexpected
        _add(findings, _internal(unexpected, expander.at if expander else None))
    log(
        "language",
        "read %s: %d characters and %d included files",
        name,
        len(text),
        len(loader.source.included),
    )
    if findings.errors or program is None:
        raise ScriptError(name, loader.source, findings.ordered()) from fault
    return program


@contextmanager
def _collector_at_rest() -> Iterator[None]:
    """Without the garbage collector: trees and strokes have no cycles, and it costs 60 %.

    For callers from Python; the command line has it off.
    """
    was_on = gc.isenabled()
    gc.disable()
    try:
        yield
    finally:
        if was_on:
            if not gc.get_freeze_count():  # what was made is old at once, so that the next
                gc.freeze()  # collection of the young leaves it out; without, 1.2 times as long
                gc.unfreeze()
            gc.enable()


def _fits(text: str, findings: DiagnosticCollector) -> bool:
    if len(text) > MOST_BYTES:
        message = f"this file is larger than {MOST_BYTES // 1_000_000} MB"
        findings.add(Diagnostic("E305", message, None))
    elif text.count("\n") > MOST_LINES:
        findings.add(Diagnostic("E306", f"this file has more than {MOST_LINES:,} lines", None))
    elif "\0" in text:
        at = text.index("\0")
        message = "this is not a text: there is a zero character in it"
        help = "a picture perhaps, or a text in UTF-16; save it as UTF-8"
        findings.add(Diagnostic("E307", message, Span(at, at + 1), "", help))
    elif found := _SVG.match(text):
        message = "this is a drawing in SVG, not a .traj text"
        help = 'a .traj file draws it with one line: svg "drawing.svg" height 80 mm'
        findings.add(Diagnostic("E307", message, Span(*found.span(1)), "", help))
    return not findings.errors


def _internal(fault: Exception, at: Span | None) -> Diagnostic:
    """An error of dqpaint, not of the file."""
    kind = type(fault).__name__
    message = f"internal error, please report ({kind}: {str(fault)[:200]})"
    return Diagnostic("E999", message, at, "", "please send this file along with the message")


def _add(findings: DiagnosticCollector, diagnostic: Diagnostic) -> None:
    with suppress(ErrorLimitError):
        findings.add(diagnostic)

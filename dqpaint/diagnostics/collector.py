"""The messages of one run: each once, in the order of the text, and not too many."""

from dataclasses import replace

from dqpaint.diagnostics.diagnostic import Diagnostic, Severity, Span

MOST = 20  # errors, and warnings; after so many a person reads no more


LONGEST = 240  # of the texts of a message, in which a file's own words may be quoted


class EnoughError(Exception):
    """So many errors were found that the search is over."""


class Findings:
    """Collects messages; the same one about the same place, as in a loop, counts once."""

    def __init__(self) -> None:
        self._found: dict[tuple[str, Span | None], Diagnostic] = {}
        self.errors = 0
        self._warnings = 0

    def add(self, diagnostic: Diagnostic) -> None:
        """Keeps a message; raises `EnoughError` when the list of errors is full."""
        diagnostic = _readable(diagnostic)
        key = diagnostic.code, diagnostic.span
        if key in self._found:
            return
        if diagnostic.severity is Severity.ERROR:
            self._found[key] = diagnostic
            self.errors += 1
            if self.errors >= MOST:
                raise EnoughError
        elif self._warnings < MOST:
            self._found[key] = diagnostic
            self._warnings += 1

    def ordered(self) -> tuple[Diagnostic, ...]:
        """All of them by their place; with errors at most `MOST`, errors before warnings."""
        found = list(self._found.values())
        if self.errors:
            found.sort(key=lambda d: d.severity is Severity.WARNING)
            found = found[:MOST]
        found.sort(key=lambda d: d.span.start if d.span is not None else 1 << 60)
        return tuple(found)


def _readable(diagnostic: Diagnostic) -> Diagnostic:
    """The message without the endless words that it may quote."""
    texts = diagnostic.message, diagnostic.label, diagnostic.help
    if max(map(len, texts)) <= LONGEST:
        return diagnostic
    message, label, cure = (_cut(text) for text in texts)
    return replace(diagnostic, message=message, label=label, help=cure, fix=None)


def _cut(text: str) -> str:
    half = LONGEST // 2
    return text if len(text) <= LONGEST else f"{text[:half]} … {text[-half:]}"

"""Diagnostics of one run -> each once, in the order of the text, limited in number."""

from dataclasses import replace

from dqpaint.diagnostics.diagnostic import Diagnostic, Severity, Span

MOST_MESSAGES = 20  # errors, and warnings; after so many a person reads no more


LONGEST_TEXT = 240  # of the texts of a message, in which a file's own words may be quoted


class ErrorLimitError(Exception):
    """The limit on the number of errors is reached, and the search stops."""


class DiagnosticCollector:
    """Collects diagnostics; repeated ones at the same position count once."""

    def __init__(self) -> None:
        self._found: dict[tuple[str, Span | None], Diagnostic] = {}
        self.errors = 0
        self._warnings = 0

    def add(self, diagnostic: Diagnostic) -> None:
        """Add a message; raises `ErrorLimitError` when the list of errors is full."""
        diagnostic = _shortened(diagnostic)
        key = diagnostic.code, diagnostic.span
        if key in self._found:
            return
        if diagnostic.severity is Severity.ERROR:
            self._found[key] = diagnostic
            self.errors += 1
            if self.errors >= MOST_MESSAGES:
                raise ErrorLimitError
        elif self._warnings < MOST_MESSAGES:
            self._found[key] = diagnostic
            self._warnings += 1

    def error_before(self, span: Span) -> bool:
        """Whether an error was found at a place before this one."""
        return self.errors > 0 and any(
            one.severity is Severity.ERROR and one.span is not None and one.span.start < span.start
            for one in self._found.values()
        )

    def ordered(self) -> tuple[Diagnostic, ...]:
        """All messages by position; if there are errors, at most `MOST_MESSAGES`, errors first."""
        found = list(self._found.values())
        if self.errors:
            found.sort(key=lambda d: d.severity is Severity.WARNING)
            found = found[:MOST_MESSAGES]
        found.sort(key=lambda d: d.span.start if d.span is not None else 1 << 60)
        return tuple(found)


def _shortened(diagnostic: Diagnostic) -> Diagnostic:
    """The diagnostic with long quoted words shortened."""
    texts = diagnostic.message, diagnostic.label, diagnostic.help
    if max(map(len, texts)) <= LONGEST_TEXT:
        return diagnostic
    message, label, help = (_cut(text) for text in texts)
    return replace(diagnostic, message=message, label=label, help=help, fix=None)


def _cut(text: str) -> str:
    half = LONGEST_TEXT // 2
    return text if len(text) <= LONGEST_TEXT else f"{text[:half]} … {text[-half:]}"

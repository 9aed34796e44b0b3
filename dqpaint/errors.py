"""Every error a user can meet has one base. What a drawing's text has wrong is a `ScriptError`."""

from collections.abc import Iterable, Mapping

LEAST_SIMILARITY = 0.6


class DqpaintError(Exception):
    """A fault in an input or a result: exit code 1, one clear sentence, never a traceback."""


class UsageError(DqpaintError):
    """A fault in how a command was called: exit code 2, with the known names or values."""


class UnknownNameError(UsageError):
    """A name that no registry knows; the text asks whether a similar one was meant.

    Args:
        kind: of what is named.
        name: that was given.
        known: names there are.
        aliases: other words for known names.
    """

    def __init__(
        self,
        kind: str,
        name: str,
        known: Iterable[str],
        aliases: Mapping[str, str] | None = None,
    ) -> None:
        super().__init__(kind, name, list(known), dict(aliases or {}))

    def __str__(self) -> str:
        kind, name, known, aliases = self.args
        meant = closest(name, known, aliases)
        asked = f"did you mean '{meant}'? " if meant else ""
        return f"no {kind} named '{name}'; {asked}known: {', '.join(known)}"


def closest(word: str, known: Iterable[str], aliases: Mapping[str, str] | None = None) -> str:
    """The known word, or an alias's meaning, most similar to `word`; empty if none is similar."""
    from difflib import get_close_matches  # slow, and only mistakes need it

    aliases = aliases or {}
    lowered = {k.lower(): k for k in known if k}
    if word.lower() in lowered:
        return lowered[word.lower()]
    for spelling in (word, word.lower(), word.upper() if len(word) < 3 else word):
        if spelling in aliases:
            return aliases[spelling]
    for meant in (lowered, aliases):
        matches = get_close_matches(word.lower()[:40], meant, n=1, cutoff=LEAST_SIMILARITY)
        if matches:
            return meant[matches[0]]
    return ""


def is_no_memory(fault: BaseException) -> bool:
    """Whether a fault says that there is not enough memory, for numbers or for a library's code."""
    return isinstance(fault, MemoryError) or (
        isinstance(fault, ImportError) and "failed to map segment" in str(fault)
    )


class OutputError(DqpaintError):
    """A place that cannot be written."""


class TimeLimitError(DqpaintError):
    """A run that takes longer than it may."""


class UnstableError(DqpaintError):
    """A run whose numbers grew beyond what numbers can hold."""

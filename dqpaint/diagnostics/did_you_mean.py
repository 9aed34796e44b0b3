"""What somebody may have meant."""

from collections.abc import Iterable, Mapping
from difflib import get_close_matches

LEAST_SIMILARITY = 0.6


def closest(word: str, known: Iterable[str], aliases: Mapping[str, str] | None = None) -> str:
    """The known word or the alias's meaning that is most like this one; empty if none is."""
    aliases = aliases or {}
    lowered = {k.lower(): k for k in known if k}
    if word.lower() in lowered:
        return lowered[word.lower()]
    for spelling in (word, word.lower(), word.upper() if len(word) < 3 else word):
        if spelling in aliases:
            return aliases[spelling]
    matches = get_close_matches(word.lower()[:40], lowered, n=1, cutoff=LEAST_SIMILARITY)
    return lowered[matches[0]] if matches else ""


def did_you_mean(suggestion: str) -> str:
    """The question, or nothing."""
    return f"did you mean '{suggestion}'?" if suggestion else ""


def join_words(words: Iterable[str]) -> str:
    """Up to six words."""
    shown = list(words)
    return ", ".join(shown[:6]) + (", …" if len(shown) > 6 else "")

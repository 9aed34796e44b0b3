"""An unknown word -> the known word that was probably meant."""

from collections.abc import Iterable, Mapping
from difflib import get_close_matches

LEAST_SIMILARITY = 0.6


def closest(word: str, known: Iterable[str], aliases: Mapping[str, str] | None = None) -> str:
    """The known word, or an alias's meaning, most similar to `word`; empty if none is similar."""
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
    """The question "did you mean ...?", or an empty text."""
    return f"did you mean '{suggestion}'?" if suggestion else ""


def join_words(words: Iterable[str]) -> str:
    """Up to six words as a list."""
    shown = list(words)
    return ", ".join(shown[:6]) + (", …" if len(shown) > 6 else "")

"""An unknown word -> the known word that was probably meant, as a question."""

from collections.abc import Iterable

from dqpaint.errors import closest

__all__ = ["closest", "did_you_mean", "join_words"]


def did_you_mean(suggestion: str) -> str:
    """The question "did you mean ...?", or an empty text."""
    return f"did you mean '{suggestion}'?" if suggestion else ""


def join_words(words: Iterable[str]) -> str:
    """Up to six words as a list."""
    shown = list(words)
    return ", ".join(shown[:6]) + (", …" if len(shown) > 6 else "")

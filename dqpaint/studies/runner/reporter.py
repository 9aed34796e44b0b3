"""The progress of a study -> a bar, a callback, or nobody."""

from collections.abc import Callable
from typing import Protocol


class Reporter(Protocol):
    """Who hears how far a study is."""

    def begin(self, title: str) -> None:
        """A study begins; title: what it is, and how many runs it has."""

    def show(self, done: float) -> None:
        """So much is done, 0 to 1."""

    def note(self, text: str, aside: bool = False) -> None:
        """Something a person may want to know; aside: only one who is watching."""

    def end(self) -> None:
        """It is over, or was stopped."""


class Callback:
    """A reporter that hands the part done to a function, and says nothing else."""

    def __init__(self, show: Callable[[float], None]) -> None:
        self.show = show

    def begin(self, title: str) -> None:
        """Nothing."""

    def note(self, text: str, aside: bool = False) -> None:
        """Nothing."""

    def end(self) -> None:
        """Nothing."""


SILENT = Callback(lambda _done: None)

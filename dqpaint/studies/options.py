"""Parameters of studies -> keywords in Python, as type checkers see them.

`python -m tests.tools.generated` writes it again.
"""

from collections.abc import Callable, Sequence
from os import PathLike
from typing import Any, Literal

from dqpaint.settings import DrawOptions, RunOptions
from dqpaint.settings import ReplayOptions as OfReplay


class CompareOptions(DrawOptions, total=False):
    """Of `compare`."""

    runs: int | None
    save: Sequence[str] | str | None
    plants: Sequence[str] | str | None
    robots: Sequence[str] | str | None
    disturbs: Sequence[str] | str | None
    figure: str | None
    baseline: str | None
    pairs: str | None
    test: Literal["t", "wilcoxon"] | None
    band: Literal["std", "quantiles", "none"] | None
    scale: Literal["auto", "linear", "log"] | None
    panels: str | None
    span: str | None
    jobs: int | None
    cluster: str | None
    folder: str | PathLike[str] | None


class SweepOptions(DrawOptions, total=False):
    """Of `sweep`."""

    runs: int | None
    save: Sequence[str] | str | None
    controllers: str | Callable[..., Any] | Sequence[str | Callable[..., Any]] | None
    plants: Sequence[str] | str | None
    robots: Sequence[str] | str | None
    disturbs: Sequence[str] | str | None
    figure: str | None
    x: str | None
    scale: Literal["auto", "linear", "log"] | None
    x_scale: Literal["auto", "linear", "log"] | None
    jobs: int | None
    cluster: str | None
    folder: str | PathLike[str] | None


class TuneOptions(RunOptions, total=False):
    """Of `tune`."""

    runs: int | None
    save: Sequence[str] | str | None
    effort: float | None
    figure: str | None
    effort_figure: str | None
    budget: int | None
    jobs: int | None
    cluster: str | None
    folder: str | PathLike[str] | None


class ReplayOptions(OfReplay, total=False):
    """Of `replay`."""

    runs: int | None
    jobs: int | None
    cluster: str | None
    folder: str | PathLike[str] | None

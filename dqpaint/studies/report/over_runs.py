"""Runs of one choice with several seeds -> one curve, and a band that says how they spread."""

from collections.abc import Mapping, Sequence
from typing import Any, Literal

import numpy as np
from numpy.typing import NDArray

from dqpaint.dq import Floats

Arrays = Mapping[str, NDArray[Any]]
Band = Literal["std", "quantiles", "none"]
QUANTILES = (0.1, 0.9)
SAID: dict[Band, str] = {
    "std": "mean of its runs, band one standard deviation",
    "quantiles": "median of its runs, band 10 % to 90 % of them",
    "none": "mean of its runs",
}


def averaged(runs: Sequence[Arrays], name: str, band: Band) -> tuple[Floats, Floats, Floats]:
    """The middle and both edges (N,) of a series over runs; of a single run all are its own.

    Runs of another length than the first (an arm that waits) are not of the same instants and are
    left out.
    """
    first = np.asarray(runs[0][name], dtype=np.float64)
    alike = [np.asarray(run[name], np.float64) for run in runs if run[name].shape == first.shape]
    if len(alike) == 1:
        return first, first, first
    every = np.stack(alike)
    if band == "quantiles":
        low, middle, high = np.quantile(every, (QUANTILES[0], 0.5, QUANTILES[1]), axis=0)
        return middle, low, high
    middle, std = every.mean(axis=0), every.std(axis=0, ddof=1)
    return (middle, middle, middle) if band == "none" else (middle, middle - std, middle + std)

"""A new picture and its reference -> their differences, and the limits that these exceed.

The gates lie between what another processor changes (film 1e-7 of its largest value, 1 of 255 in a
pixel) and the smallest fault worth a word. Other versions of the libraries may change more; then
wider gates hold, which still see what a person would.
"""

from collections.abc import Callable, Mapping
from dataclasses import dataclass

import numpy as np

from dqpaint.light.film import PAD, Film, point_spread, spread
from dqpaint.light.images import Difference, measure_difference
from dqpaint.studies.runner.run import Result
from dqpaint.studies.verify.references import Arrays, Reference

FLOOR = 1e-9
"""A figure that changed by less, in its own SI unit, has not changed."""
BALANCE = 1e-9
"""Of the light, what may be neither on the film nor lost."""


@dataclass(frozen=True)
class Gate:
    """A limit: `same` where the libraries are those of the reference, `other` where not."""

    name: str
    same: float
    other: float
    measure: Callable[["GateResult"], float]


@dataclass(frozen=True)
class GateResult:
    """What a new picture is beside its reference: of the pictures, of the figures, of the light.

    Attributes:
        pictures: their difference.
        figures: the largest relative change of a figure.
        worst: and which figure that is.
        balance: what of the new light is neither on the film nor lost.
    """

    pictures: Difference
    figures: float
    worst: str
    balance: float


GATES = (
    Gate("film max", 1e-5, np.inf, lambda m: m.pictures.film_max),
    Gate("film L1", 1e-5, 2e-2, lambda m: m.pictures.film_l1),
    Gate("energy", 1e-6, 1e-3, lambda m: m.pictures.energy),
    Gate("u8 max", 2, 24, lambda m: m.pictures.u8_max),
    Gate("1 - min SSIM", 1e-3, 5e-2, lambda m: 1 - m.pictures.ssim_min),
    Gate("metrics", 1e-6, 1e-2, lambda m: m.figures),
    Gate("balance", BALANCE, BALANCE, lambda m: m.balance),
)


def measure(reference: Reference, result: Result, made: Arrays) -> GateResult:
    """A new result beside its reference; both pictures have the same size."""
    light, new_light = (developed_from(planes) for planes in (reference.planes, made["planes"]))
    pictures = measure_difference(light, new_light, reference.picture, made["picture"])
    before = figures(reference.facts["figures"], reference.facts["light"])
    after = figures(result.figures, made)
    change, worst = largest_change(before, after)
    return GateResult(pictures, change, worst, float(made["balance"]))


def developed_from(planes: Arrays | np.ndarray) -> np.ndarray:
    """The linear light (H, W, 3) of film planes (3, H, W) with their guard band."""
    whole = np.asarray(planes, dtype=np.float64)
    height = whole.shape[1] - 2 * PAD
    return spread(Film(whole, np.zeros(3), np.zeros(3)), point_spread(height))


def figures(run: Mapping[str, float], light: Mapping[str, object]) -> dict[str, float]:
    """The figures of a run and of its light."""
    sums = {
        f"{name}_{channel}": float(value)
        for name in ("emitted", "lost")
        for channel, value in zip("rgb", np.asarray(light[name], dtype=np.float64), strict=True)
    }
    return {**run, **sums}


def largest_change(before: Mapping[str, float], after: Mapping[str, float]) -> tuple[float, str]:
    """The largest relative change of a figure, and its name; a figure that is gone is infinite."""
    most, worst = 0.0, ""
    for name, value in before.items():
        if name not in after:
            return np.inf, name
        gap = max(0.0, abs(after[name] - value) - FLOOR)
        change = gap / max(abs(value), FLOOR)
        if change > most:
            most, worst = change, name
    return most, worst


def failed_gates(measured: GateResult, alike: bool) -> list[str]:
    """The names of the gates that say no; `alike`: the libraries are those of the reference."""
    names = []
    for gate in GATES:
        limit = gate.same if alike else gate.other
        if not gate.measure(measured) <= limit:  # what is no number is not within
            names.append(f"metrics ({measured.worst})" if gate.name == "metrics" else gate.name)
    return names

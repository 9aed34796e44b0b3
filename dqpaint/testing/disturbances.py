"""A disturbance and its values -> whether it changes a run, repeats and is documented."""

from collections.abc import Mapping

import numpy as np

from dqpaint.core import make_choice
from dqpaint.disturbances import DISTURBANCES, Disturbance
from dqpaint.plants import PLANTS
from dqpaint.testing.runs import require, run

PLANT_FOR = {None: "ideal", "masses": "stiff", "a model of gravity": "compliant"}


def check_disturbance(
    disturbance: str | type[Disturbance], values: Mapping[str, float | str], random: bool
) -> None:
    """Check what every disturbance promises.

    It changes the run (the path by more than 1 um or a motor's torque by more than 0.5 Nm), gives
    the same bits with the same seed and others with another one if it is random, and each of its
    values has a description.

    Args:
        disturbance: its name, or its model.
        values: for which it should be felt.
        random: whether random numbers take part.

    Raises:
        AssertionError: a promise that is not kept.
    """
    model = DISTURBANCES[disturbance] if isinstance(disturbance, str) else disturbance
    require(bool((model.__doc__ or "").strip()), "a disturbance has a docstring")
    for name, field in model.model_fields.items():
        require(bool(field.description), f"its value '{name}' has a description with the unit")
    one = make_choice("disturbance", "checked", model, dict(values))
    plant = PLANTS[PLANT_FOR[model.needs]]
    plain, first, same, other = (
        run(plant), run(plant, {"checked": one}), run(plant, {"checked": one}),
        run(plant, {"checked": one}, seed=1),
    )  # fmt: skip
    require(bool(np.isfinite(first.pose).all()), "the run stays finite")
    moved = np.abs(first.points - plain.points).max()
    effort = np.abs(first.effort - plain.effort).max()
    require(moved > 1e-6 or effort > 0.5, f"it changes the run; it moved the tool {moved:.2g} m")
    require(np.array_equal(first.pose, same.pose), "the same seed gives the same bits")
    differs = np.abs(first.pose - other.pose).max() > 1e-9
    require(differs == random, "another seed gives another run if, and only if, it is random")

"""A plant -> whether it is an arm that a run can be made with."""

from collections.abc import Sequence

import numpy as np

from dqpaint.dq import Floats
from dqpaint.plants import PLANTS, PlantMaker, as_plant_maker
from dqpaint.testing.runs import arm, require, run, start

PERIOD = 0.008  # [s]


def check_plant(plant: str | PlantMaker, within: float | None = 2e-4) -> None:
    """Check what every plant promises.

    It begins at rest in the posture it is given, changes none of its arguments, repeats itself bit
    for bit, measures rates (n,) that are those of its posture, carries a drift along, stays finite
    in a closed loop under a law that suits it, and, if it takes rates, follows them.

    Args:
        plant: its name, or what makes it.
        within: how far it may be from the integral of commanded rates [rad]; None is not checked.

    Raises:
        AssertionError: a promise that is not kept.
    """
    make = PLANTS[plant] if isinstance(plant, str) else as_plant_maker("plant", plant)
    commands = smooth_commands(make, 60)
    kept, home = commands.copy(), start()
    postures, rates = simulate(make, commands, home)
    require(np.array_equal(home, start()), "a plant leaves the start posture as it is")
    require(np.array_equal(commands, kept), "a plant leaves its commands as they are")
    require(np.abs(postures[0] - home).max() < 1e-12, "a plant begins in its start posture")
    require(not rates[0].any(), "a plant begins at rest")
    again = simulate(make, commands, home)
    require(np.array_equal(postures, again[0]), "the same commands give the same bits")
    require(bool(np.isfinite(postures).all()), "postures are finite numbers")
    _check_rates(make, home)
    _check_drift(make, home)
    if make.takes == "rates" and within is not None:
        asked = home + np.cumsum(np.vstack([np.zeros_like(home), commands]), axis=0) * PERIOD
        far = np.abs(postures - asked).max()
        require(far < within, f"it follows its rates within {within:g} rad; it was {far:.2g} away")
    track = run(make)
    require(bool(np.isfinite(track.pose).all()), "it stays finite in a closed loop")


def smooth_commands(make: PlantMaker, count: int, size: float = 0.4) -> Floats:
    """Commands (N, n) that begin at once and go on smoothly: rates [rad/s], or small torques."""
    t = np.arange(count) * PERIOD
    scale = size if make.takes == "rates" else 20 * size
    return np.asarray(scale * np.sin(2 * t[:, None] + np.arange(arm().card.joints)))


def simulate(
    make: PlantMaker,
    commands: Sequence[Floats] | Floats,
    home: Floats,
    drift: Floats | None = None,
    period: float = PERIOD,
) -> tuple[Floats, Floats]:
    """Postures and rates (N+1, n) of a plant under commands (N, n)."""
    plant = make(arm().card, home, period)
    postures, rates = [plant.posture.copy()], [plant.rates.copy()]
    for command in commands:
        plant.run(command, drift)
        postures.append(plant.posture.copy())
        rates.append(plant.rates.copy())
    for array in (plant.effort, plant.encoder, plant.encoder_rates):
        require(array.shape == home.shape, "effort, encoder and encoder_rates have shape (n,)")
    plant.close()
    return np.array(postures), np.array(rates)


def _check_rates(make: PlantMaker, home: Floats) -> None:
    """In one period of 1 ms the posture's change lies between the rates at its ends, to 0.01."""
    postures, rates = simulate(make, smooth_commands(make, 30), home, period=1e-3)
    change = (postures[-1] - postures[-2]) / 1e-3
    ends = rates[-2:]
    far = max(float((change - ends.max(axis=0)).max()), float((ends.min(axis=0) - change).max()))
    require(far < 0.01, f"rates are those of the posture; they differ by {far:.2g} rad/s")


def _check_drift(make: PlantMaker, home: Floats) -> None:
    """A drift comes on top: beside the same run without it."""
    drift = np.linspace(-0.1, 0.1, len(home))
    count = 60 if make.takes == "rates" else 3
    commands = smooth_commands(make, count) * (make.takes == "rates")
    alone = simulate(make, commands, home)[0][-1]
    carried = simulate(make, commands, home, drift)[0][-1]
    moved = count * PERIOD * drift
    far = np.abs(carried - alone - moved).max()
    require(far < 0.02 * np.abs(moved).max(), f"a drift is carried along; it is {far:.2g} rad off")

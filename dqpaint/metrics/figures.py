"""A run and its table -> the figures of the summary.

The measures are the ones of Pereira 2016, 5.2 (integrals over the run of the norms of error,
command, effort, speed and acceleration) and of Chandra 2020 (root mean square and standard
deviation of position and orientation error).
"""

from collections.abc import Callable

import numpy as np

from dqpaint.dq import Floats
from dqpaint.metrics.registry import Table, figure
from dqpaint.simulation import Track


@figure(
    "error_integral", unit="", title="error integral", kind="error", listed=True,
    meaning="of the invariant error, the norm of 1 - x* x_d, over time",
)  # fmt: skip
def _error(track: Track, table: Table) -> float:
    return _integral(table["invariant_error"], track)


@figure(
    "command_integral_rad", unit="rad", title="command", kind="cost", listed=True,
    meaning="the norm of what the joints are told, over time",
)  # fmt: skip
def _rates(track: Track, _table: Table) -> float | None:
    return None if track.torques else _commanded(track)


@figure(
    "torque_integral_Nm_s", unit="Nm s", title="command", kind="cost", listed=True,
    meaning="the norm of what the joints are told, over time",
)  # fmt: skip
def _torque(track: Track, _table: Table) -> float | None:
    return _commanded(track) if track.torques else None


@figure(
    "effort_integral", unit="rad s", title="effort", kind="cost", listed=True,
    meaning="how far the joints move in a step, over time",
)  # fmt: skip
def _effort(track: Track, table: Table) -> float | None:
    return _integral(table["effort_rad"], track) if "effort_rad" in table else None


@figure(
    "speed_integral_m", unit="m", title="way", kind="cost", listed=True,
    meaning="how far the light goes",
)  # fmt: skip
def _way(track: Track, table: Table) -> float:
    return _integral(table["speed_m_s"], track)


@figure(
    "acceleration_integral", unit="m/s", title="acceleration integral", kind="cost", listed=True,
    meaning="of the light, over time",
)  # fmt: skip
def _acceleration(track: Track, table: Table) -> float:
    return _integral(table["acceleration_m_s2"], track)


PLACE = "how far the light is from where it is asked to be at the time"
TURN = "by which angle the tool is turned from what is asked at the time"
SPREADS: tuple[tuple[str, str, Callable[[Floats], float]], ...] = (
    ("rms", "rms", lambda values: float(np.sqrt((values**2).mean()))),
    ("std", "standard deviation", lambda values: float(values.std())),
    ("max", "largest", lambda values: float(values.max())),
)


def _of_column(reduce: Callable[[Floats], float], name: str) -> Callable[[Track, Table], float]:
    return lambda _track, table: reduce(table[name])


for _name, _unit, _shown, _meaning in (
    ("position", "m", "mm", PLACE), ("orientation", "rad", "deg", TURN)
):  # fmt: skip
    for _kind, _word, _reduce in SPREADS:
        figure(
            f"{_name}_error_{_kind}_{_unit}", unit=_unit, shown=_shown, title=f"{_name} {_word}",
            meaning=_meaning, kind="error",
            listed=_kind == "rms" or (_name, _kind) == ("position", "max"),
        )(_of_column(_reduce, f"{_name}_error_{_unit}"))  # fmt: skip


def _commanded(track: Track) -> float | None:
    """A recording may have poses alone."""
    if not track.posture.shape[1]:
        return None
    return _integral(np.sqrt((track.command * track.command).sum(axis=-1)), track)


def _integral(values: Floats, track: Track) -> float:
    """Over the N - 1 steps of the run; the last row's command is not carried out."""
    return float(values[:-1].sum() * track.motion.period)

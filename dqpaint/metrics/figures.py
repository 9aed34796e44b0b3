"""A run and its table -> the figures of the summary.

The measures are the ones of Pereira 2016, 5.2 (integrals over the run of the norms of error,
command, effort, speed and acceleration) and of Chandra 2020 (root mean square and standard
deviation of position and orientation error).
"""

from typing import Any

import numpy as np

from dqpaint.dq import Floats
from dqpaint.metrics.judgement import clipped_rows
from dqpaint.metrics.registry import Table, figure
from dqpaint.simulation import Track

COMMAND_MEANING = "norm of the joint commands, integrated over time"
POSITION_MEANING = "distance of the light from the reference position of the same instant"
ORIENTATION_MEANING = "angle of the tool from the reference orientation of the same instant"


@figure("error_integral", "", "error integral",
        "invariant error, the norm of 1 - x* x_d, integrated over time",
        kind="error", listed=True,
        equation="int_0^t_f |vec(1 - x^* x_d)| dt")  # fmt: skip
def _error(track: Track, table: Table) -> float:
    return _integral(table["invariant_error"], track)


@figure(
    "command_integral_rad",
    "rad",
    "command",
    COMMAND_MEANING,
    listed=True,
    equation="int_0^t_f |q_dot| dt",
)
def _rates(track: Track, _table: Table) -> float | None:
    return None if track.torques else _commanded(track)


@figure(
    "torque_integral_Nm_s",
    "Nm s",
    "command",
    COMMAND_MEANING,
    listed=True,
    equation="int_0^t_f |tau| dt",
)
def _torque(track: Track, _table: Table) -> float | None:
    return _commanded(track) if track.torques else None


@figure("effort_integral", "rad s", "effort",
        "norm of the joint displacements of a step, integrated over time", listed=True,
        equation="T sum_k |q_(k+1) - q_k|")  # fmt: skip
def _effort(track: Track, table: Table) -> float | None:
    return _integral(table["effort_rad"], track) if "effort_rad" in table else None


@figure(
    "speed_integral_m",
    "m",
    "path length",
    "path length of the light",
    listed=True,
    equation="int_0^t_f |t_dot| dt",
)
def _path_length(track: Track, table: Table) -> float:
    return _integral(table["speed_m_s"], track)


@figure("acceleration_integral", "m/s", "acceleration integral",
        "acceleration of the light, integrated over time", listed=True,
        equation="int_0^t_f |t_ddot| dt")  # fmt: skip
def _acceleration(track: Track, table: Table) -> float:
    return _integral(table["acceleration_m_s2"], track)


@figure("clipped_share", "", "clipped",
        "part of the run in which a limit clipped the command of a joint",
        display_unit="%", listed=True, equation="mean(u != clip(u))")  # fmt: skip
def _clipped(track: Track, _table: Table) -> float | None:
    clipped = clipped_rows(track)
    return None if clipped is None else float(clipped.mean())


def _error_statistics(name: str, unit: str, display_unit: str, meaning: str, largest: bool) -> None:
    """Register the root mean square, standard deviation and largest value of an error."""
    column = f"{name}_error_{unit}"
    of = {"position": "|t - t_d|", "orientation": "|theta|"}[name]
    known: dict[str, Any] = {"meaning": meaning, "display_unit": display_unit, "kind": "error"}

    @figure(f"{name}_error_rms_{unit}", unit, f"{name} rms", **known, listed=True,
            equation=f"sqrt(mean({of}^2))")  # fmt: skip
    def _rms(_track: Track, table: Table) -> float:
        return float(np.sqrt((table[column] ** 2).mean()))

    @figure(f"{name}_error_std_{unit}", unit, f"{name} standard deviation", **known,
            equation=f"sqrt(mean({of}^2) - mean({of})^2)")  # fmt: skip
    def _std(_track: Track, table: Table) -> float:
        return float(table[column].std())

    @figure(f"{name}_error_max_{unit}", unit, f"{name} largest", **known, listed=largest,
            equation=f"max {of}")  # fmt: skip
    def _max(_track: Track, table: Table) -> float:
        return float(table[column].max())


_error_statistics("position", "m", "mm", POSITION_MEANING, largest=True)
_error_statistics("orientation", "rad", "deg", ORIENTATION_MEANING, largest=False)


def _commanded(track: Track) -> float | None:
    """A recording may have poses alone."""
    if not track.posture.shape[1]:
        return None
    return _integral(np.sqrt((track.command * track.command).sum(axis=-1)), track)


def _integral(values: Floats, track: Track) -> float:
    """Over the N - 1 steps of the run; the last row's command is not carried out."""
    return float(values[:-1].sum() * track.motion.period)

"""A run among walls -> its columns and figures; a drawing without walls has none of them."""

import numpy as np

from dqpaint.dq import Floats
from dqpaint.metrics.registry import Table, Values, column, figure
from dqpaint.robots.walls import METRES
from dqpaint.simulation import Track


def _least(track: Track) -> Floats | None:
    """The distance to the nearest wall (N,) [m]; None where none has a distance in metres."""
    if track.walls is None or METRES not in track.walls.units:
        return None
    lengths = [unit == METRES for unit in track.walls.units]
    return np.asarray(track.walls.distance[:, lengths].min(axis=1))


@column("wall", "", "wall", "the wall that holds the arm, from 1; 0 where none does",
        from_zero=True, equation='w_k = "the wall that is active", 0 "else"')  # fmt: skip
def _wall(track: Track) -> Values | None:
    if track.walls is None:
        return None
    held = track.walls.active
    return np.where(held.any(axis=1), held.argmax(axis=1) + 1.0, 0.0)


@column("wall_distance_m", "m", "distance from walls", "least distance of the true arm from a wall",
        display_unit="mm", equation="min_i d_i(q)")  # fmt: skip
def _wall_distance(track: Track) -> Values | None:
    return _least(track)


@column("wall_lost_m_s", "m/s", "velocity given up",
        "what walls took of the velocity of the tool that the law wanted",
        display_unit="mm/s", from_zero=True, equation="|J_p (q_dot - q_dot_0)|")  # fmt: skip
def _wall_lost(track: Track) -> Values | None:
    return None if track.walls is None else track.walls.lost


@figure("wall_distance_min_m", "m", "least distance from walls",
        "least distance of the true arm from a wall; below 0 it was passed",
        display_unit="mm", equation="min_k min_i d_i(q_k)")  # fmt: skip
def _wall_distance_min(track: Track, _table: Table) -> float | None:
    least = _least(track)
    return None if least is None else float(least.min())


@figure("wall_active_share", "", "held by walls", "part of the run in which a wall holds the arm",
        display_unit="%", equation="mean(w_k != 0)")  # fmt: skip
def _wall_active(track: Track, _table: Table) -> float | None:
    return None if track.walls is None else float(track.walls.active.any(axis=1).mean())


@figure("wall_lost_m", "m", "work lost to walls",
        "velocity of the tool that was given up, integrated over time",
        display_unit="mm", equation="int_0^t_f |J_p (q_dot - q_dot_0)| dt")  # fmt: skip
def _wall_work(track: Track, _table: Table) -> float | None:
    if track.walls is None:
        return None
    return float(track.walls.lost[:-1].sum() * track.motion.period)

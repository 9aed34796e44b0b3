"""Motion and postures -> the light that the arm will hide in each view of a run.

A forecast: a few points of the brush at some rows; `render.occlusion` traces all of them.
"""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from dqpaint import dq
from dqpaint.dq import Floats
from dqpaint.light.camera import parse_views
from dqpaint.light.sources import sweeps, view_camera
from dqpaint.motion import Motion
from dqpaint.robots.kinematics import CollisionShapes
from dqpaint.settings import Settings

MOST_OCCLUSION_ROWS = 400  # at the arm's shapes in a whole drawing
LEAST_ROWS = 40  # in each view, where there are many
MOST_POINTS, LEAST_SPACING = (
    5,
    0.03,
)  # places along a brush, at the most, and how far apart at least [m]
DEFAULT_SETTINGS = Settings()


class OcclusionForecast(NamedTuple):
    """Emitted and occluded light at some of a forecast's rows.

    Attributes:
        rows: of the forecast (S,).
        emitted: light at each row (S,), in any unit.
        occluded: the part of it that does not reach each view (V, S).
        views: their names, V.
    """

    rows: NDArray[np.intp]
    emitted: Floats
    occluded: Floats
    views: tuple[str, ...]

    def largest_share(self, rows: NDArray[np.intp]) -> tuple[float | None, str]:
        """The largest share of light at some rows that one view does not get, and that view."""
        these = np.isin(self.rows, rows)
        sent = float(self.emitted[these].sum())
        if not sent:
            return None, ""
        shares = self.occluded[:, these].sum(axis=1) / sent
        worst = int(shares.argmax())
        return float(shares[worst]), self.views[worst]


def sampled_rows(line: NDArray[np.int64], most: int) -> NDArray[np.intp]:
    """Some rows (of N): evenly spread ones, and the middle of every run of a line."""
    n = len(line)
    ends = np.flatnonzero(np.diff(line)) + 1
    middles = (np.append(0, ends) + np.append(ends, n)) // 2
    return np.unique(np.concatenate([np.linspace(0, n - 1, min(n, most)).astype(int), middles]))


def forecast_occlusion(
    shapes: CollisionShapes,
    motion: Motion,
    rows: NDArray[np.intp],
    postures: Floats,
    settings: Settings,
) -> OcclusionForecast:
    """The light of a motion that is occluded by the arm that follows it.

    Args:
        shapes: of the arm.
        motion: what is asked.
        rows: of the motion that were followed (N,).
        postures: the arm's at these (N, n) [rad].
        settings: brush, views and camera.
    """
    shots = parse_views(settings.view)
    lit = np.append(motion.light[:-1].any(axis=1), False)[rows]
    looks = sampled_rows(
        motion.source.index[rows], max(MOST_OCCLUSION_ROWS // len(shots), LEAST_ROWS)
    )
    looks = looks[lit[looks]]
    names = tuple(shot.name for shot in shots)
    sent, hidden = np.zeros(len(looks)), np.zeros((len(shots), len(looks)))
    if not len(looks):
        return OcclusionForecast(looks, sent, hidden, names)
    light = sweeps(motion, motion.pose, motion.light, settings)
    points = np.concatenate([sweep.lit_points for sweep in light])
    front = dq.matrix_from_quaternion(motion.front)
    cameras = [view_camera(points, front, settings, shot) for shot in shots]
    for sweep in light:
        energy = sweep.colours[np.minimum(rows[looks], len(sweep.colours) - 1)].sum(axis=1)
        shone = np.flatnonzero(energy)
        if not len(shone):
            continue
        at = rows[looks[shone]]
        lamps = sweep.emitters.positions_along(
            max(LEAST_SPACING, 2 * sweep.emitters.reach / (MOST_POINTS - 1))
        )
        places = sweep.base_positions(sweep.positions[at], sweep.rotations[at], lamps)
        sent[shone] += energy[shone]
        for view, camera in enumerate(cameras):
            for k in range(len(lamps)):
                behind = shapes.occludes(postures[looks[shone]], places[:, k], camera.position)
                hidden[view, shone] += energy[shone] * behind / len(lamps)
    return OcclusionForecast(looks, sent, hidden, names)

"""A motion with photographs -> the same with the light that paints them, solved for its path."""

from collections.abc import Callable
from dataclasses import dataclass, replace
from time import perf_counter

import numpy as np
from numpy.typing import NDArray

from dqpaint.brushes import Lamp, read_lamp
from dqpaint.dq import Floats
from dqpaint.errors import DqpaintError
from dqpaint.light.camera import Camera, parse_views
from dqpaint.light.film import REFERENCE_HEIGHT, point_spread
from dqpaint.light.inverse import (
    WHITE,
    Exposing,
    Likeness,
    boxed,
    developed,
    light_for,
    likeness,
    seen_through,
    solve,
)
from dqpaint.light.sources import view_camera
from dqpaint.motion import Motion
from dqpaint.painting.photos.light_cache import LightCache
from dqpaint.painting.picture import exposure_to
from dqpaint.painting.scene import make_scene
from dqpaint.program import Photo
from dqpaint.settings import Settings

LEAST_ROWS, ROWS = 100, 720
"""A picture of fewer rows is none to look at, as that of an export: light is then solved for one of
so many rows."""
HEADROOM = 2.5
"""Power of a lamp over what an even white area takes: fine bright lines take more."""
EDGE = 1e-6
"""Share of a side by which rounding may carry a point out of a rectangle."""
LEAST_TONE = 0.02
"""sRGB tone of a photograph from which on it takes light."""
MARGIN = 3.0
"""How far beside a photograph it is to be dark [strokes' distances]: else light that falls there
would cost nothing, and edges would be lit for two."""
LEAST_SHARE = 0.02
"""Light of a row in which the lamp hardly moves, to begin with."""
QUIET = 1e-3
"""Share of the largest power below which a lamp is off, when its range is told."""


@dataclass(frozen=True)
class LitPhoto:
    """What was reached for one photograph.

    Attributes:
        photo: which.
        likeness: of the picture that is expected to the photograph, seen from the front.
        ideal: the same with a lamp that has any power.
        strokes: lines without a dark move between them.
        length: of path that shines [m].
        seconds: that the lamp is on [s].
        largest: power of the lamp, 0 to 1.
        least: power that is not off, likewise.
        steps: of the solver.
        took: time of the solver [s].
    """

    photo: Photo
    likeness: Likeness
    ideal: Likeness
    strokes: int
    length: float
    seconds: float
    largest: float
    least: float
    steps: int
    took: float


def solve_photos(
    motion: Motion,
    settings: Settings,
    progress: Callable[[float], None] = lambda _done: None,
    reached: Floats | None = None,
) -> tuple[Motion, tuple[LitPhoto, ...]]:
    """The motion with the light that paints its photographs; as it is where there is none.

    The light is solved for the view from the front, on a film of the picture's own height, but of
    at most `REFERENCE_HEIGHT` rows, as larger ones spread light in proportion.

    Args:
        motion: the reference.
        settings: size and exposure of the picture, and the lamp.
        progress: called with the share done, 0 to 1.
        reached: positions (N, 3) of the lamp where they are known, after a run [m]; the exposure
            stays that of the motion.

    Raises:
        DqpaintError: a photograph is painted with a brush that is no point.
    """
    if not motion.program.photos:
        return motion, ()
    _check_brushes(motion, settings)
    if reached is None:
        motion = _dark_outside(motion)
    tasks, gain = _tasks(motion, settings, reached)
    exposure = motion.exposure or max(task.wanted_exposure for task in tasks)
    lamp, cache = read_lamp(settings.lamp), LightCache(motion.program.name)
    light, lit = np.array(motion.light), []
    for number, task in enumerate(tasks):
        begun = perf_counter()

        def show(done: float, before: int = number) -> None:
            progress((before + done) / len(tasks))

        one = task.solved(gain * exposure, light, lamp, cache, show)
        lit.append(replace(one, took=perf_counter() - begun))
    return replace(motion, light=light, exposure=exposure), tuple(lit)


def likeness_reached(motion: Motion, settings: Settings, reached: Floats) -> tuple[Likeness, ...]:
    """How like its photographs the light of a motion is at positions (N, 3) [m]."""
    if not motion.program.photos or motion.exposure is None:
        return ()
    tasks, gain = _tasks(motion, settings, reached)
    return tuple(task.likeness_of(motion.light, gain * motion.exposure) for task in tasks)


def _tasks(
    motion: Motion, settings: Settings, reached: Floats | None
) -> tuple[list["_Task"], float]:
    """What is to be solved, and the factor from an exposure per m^2 to one per px^2."""
    camera = _front_camera(motion, settings)
    pixels = camera.project(motion.points if reached is None else reached)[0]
    tasks = [
        _Task(motion, photo, number + 1, pixels, camera, reached)
        for number, photo in enumerate(motion.program.photos)
    ]
    return tasks, exposure_to(camera, motion.photo_frames.reshape(-1, 3), 1.0)


def _check_brushes(motion: Motion, settings: Settings) -> None:
    segments = motion.program.segments
    used = {s.brush.name for s in segments if s.light is not None and s.light.photo}
    if settings.brush is not None:
        used = {settings.brush.partition(":")[0]}
    if used - {"point"}:
        raise DqpaintError(
            f"{motion.program.name}: a photo is painted with a point of light, and the brush is "
            f"'{min(used - {'point'})}'"
        )


def _photo_rows(motion: Motion, number: int) -> NDArray[np.bool_]:
    """The rows (N-1,) of the strokes of a photograph, from 1."""
    lights = [s.light.photo if s.light is not None else 0 for s in motion.program.segments]
    return np.asarray(np.array(lights)[motion.stroke[:-1]] == number)


def _dark_outside(motion: Motion) -> Motion:
    """The motion, dark where a photograph's strokes leave it, as they do to turn."""
    light = np.array(motion.light)
    for number in range(1, len(motion.program.photos) + 1):
        light[:-1][_photo_rows(motion, number) & ~_inside_rows(motion, number)] = 0.0
    return replace(motion, light=light)


def _inside_rows(motion: Motion, number: int) -> NDArray[np.bool_]:
    """The rows (N-1,) of the reference that lie on a photograph, from 1."""
    points, corners = motion.points, motion.photo_corners[number - 1]
    ends = _is_inside(points, motion.photo_frames[number - 1])
    middles = _is_inside(0.5 * (points[1:] + points[:-1]), corners)
    return np.asarray(ends[1:] & ends[:-1] & middles)


def _is_inside(points: Floats, corners: Floats) -> NDArray[np.bool_]:
    """Whether points (N, 3) lie in a rectangle with corners (4, 3), seen along its normal."""
    foot, right, _, up = corners
    sides = np.stack([right - foot, up - foot], axis=1)
    at = (points - foot) @ sides / (sides**2).sum(axis=0)
    return np.asarray(((at >= -EDGE) & (at <= 1.0 + EDGE)).all(axis=1))


def _front_camera(motion: Motion, settings: Settings) -> Camera:
    """The camera of the view from the front that the light is solved for."""
    scene = make_scene(motion, motion.pose, settings)
    shot = parse_views("front")[0]
    camera = view_camera(scene.shown_points, scene.front, settings, shot)
    rows = min(camera.height if camera.height >= LEAST_ROWS else ROWS, REFERENCE_HEIGHT)
    return camera if rows == camera.height else camera.scaled(rows / camera.height)


class _Task:
    """One photograph: its rows, its box on the film, and the map from energies to the image."""

    def __init__(
        self, motion: Motion, photo: Photo, number: int, pixels: Floats, camera: Camera,
        reached: Floats | None,
    ) -> None:  # fmt: skip
        self.motion, self.photo = motion, photo
        own, inside = _photo_rows(motion, number), _inside_rows(motion, number)
        if reached is not None:  # an arm that lags is on the photo where it was to have left it
            there = _is_inside(reached, motion.photo_frames[number - 1])
            inside |= there[1:] & there[:-1]
        self.rows: NDArray[np.intp] = np.flatnonzero(own & inside)
        placed = camera.project(motion.photo_corners[number - 1])[0]
        size = camera.width, camera.height
        inner = boxed(placed, size)
        beside = MARGIN * photo.detail * np.linalg.norm(placed[1] - placed[0])
        beside /= np.linalg.norm(photo.right)
        self.box = boxed(np.concatenate([placed - beside, placed + beside]), size)
        left, top = inner.left - self.box.left, inner.top - self.box.top
        self.inner = slice(top, top + inner.height), slice(left, left + inner.width)
        self.picture = seen_through(_toned(photo), placed, self.box)
        self.exposing = Exposing(
            pixels[self.rows], pixels[self.rows + 1], self.box, point_spread(camera.height)
        )
        self.share = self._shares()

    def _shares(self) -> Floats:
        """The light (K,) of each row to begin with: as much as it is long, at most 1."""
        way = np.linalg.norm(self.exposing.end - self.exposing.start, axis=1)
        usual = float(np.median(way[way > 0.0])) if (way > 0.0).any() else 1.0
        return np.asarray(np.clip(way / usual, LEAST_SHARE, 1.0))

    @property
    def wanted_exposure(self) -> float:
        """The exposure [m^2 / (lamp s)] at which an even white takes 1 / `HEADROOM` of the power.

        By the seconds that the light spends where there is any in the photograph, and its area.
        """
        lit = self.picture.max(axis=2) > LEAST_TONE
        share = float(lit[self.inner].mean())
        middle = 0.5 * (self.exposing.start + self.exposing.end)
        at = np.rint(middle - np.array([self.box.left, self.box.top])).astype(np.int64)
        column = np.clip(at[:, 0], 0, self.box.width - 1)
        row = np.clip(at[:, 1], 0, self.box.height - 1)
        seconds = float(self.share[lit[row, column]].sum()) * self.motion.period
        area = share * float(np.linalg.norm(np.cross(self.photo.right, self.photo.up)))
        white = float(light_for(np.ones((1, 1, 3)), WHITE).max())
        return HEADROOM * white * area / max(seconds, 1e-9)

    def solved(
        self,
        exposure: float,
        light: Floats,
        lamp: Lamp,
        cache: LightCache,
        progress: Callable[[float], None],
    ) -> LitPhoto:
        """Solve for an exposure [px^2 / (lamp s)], and put the colours into `light` (N, 3)."""
        period, photo = self.motion.period, self.photo
        most = np.full(len(self.rows), period * exposure)
        colour = None
        if photo.colours is not None:
            colour = np.array(photo.colour) / max(photo.colour)
        key = cache.key(self.exposing.start, self.exposing.end, self.picture, self.share, most,
                        np.array(self.exposing.psf.widths), colour)  # fmt: skip
        powers, steps = cache.read(key, len(self.rows)), 0
        if powers is None:
            found = solve(self.exposing, self.picture, self.share, most, colour, None, progress)
            powers = np.clip(found.energy / most[:, None], 0.0, 1.0).astype(np.float32)
            steps = len(found.costs)
            cache.write(key, powers)
        light[self.rows] = powers
        ideal = told = self.likeness_of(light, exposure)
        joined = np.diff(self.rows, prepend=-2) == 1
        rounded = lamp.rounded(powers, np.full(len(powers), period), joined)
        if rounded is not powers:
            light[self.rows] = rounded
            told = self.likeness_of(light, exposure)
        power = light[self.rows].max(axis=1)
        on = power > QUIET
        way = np.linalg.norm(np.diff(self.motion.points, axis=0)[self.rows], axis=1)
        apart = np.diff(self.rows[on], prepend=-2) > 1
        return LitPhoto(
            photo, told, ideal, int(apart.sum()),
            float(way[on].sum()), float(on.sum() * period), float(power.max(initial=0.0)),
            float(power[on].min(initial=1.0)), steps, 0.0,
        )  # fmt: skip

    def likeness_of(self, light: Floats, exposure: float) -> Likeness:
        """How like the photograph some light (N, 3) is, for an exposure [px^2 / (lamp s)]."""
        energy = light[self.rows] * (self.motion.period * exposure)
        made = developed(self.exposing.expose(energy))[0]
        return likeness(made[self.inner], self.picture[self.inner])


def _toned(photo: Photo) -> Floats:
    """The photograph in the colours its lamp has."""
    if photo.colours is None:
        return photo.picture
    from dqpaint.photo import in_one_colour

    return in_one_colour(photo.picture, photo.colour)

"""Sweeps of light, samples and the size of a picture -> the memory they will take, or an error.

The figures are peaks that were measured, rounded up: on the safe side by up to a factor of three.
"""

from collections.abc import Sequence

import numpy as np

from dqpaint.errors import DqpaintError
from dqpaint.light.camera import NEAREST_DEPTH, Camera
from dqpaint.light.film import DIAMETER_RATIO, PAD
from dqpaint.light.sources import Sweep
from dqpaint.settings import Settings

BASE = 250e6  # bytes of the libraries and a small picture
PER_SAMPLE, PER_SAMPLE_OF_PREVIEW = 4_500, 1_000  # of a run with its columns; of a motion alone
PER_PIXEL = 42
PER_PIXEL_OF_ARM = 70  # where it is shown or hides light
PER_PIXEL_OF_OVERLAY = 50
PER_PIXEL_OF_LAYER = 24  # of discs of one diameter
SPREAD_LAYERS = 3  # that are worked on at a time
PER_LAMP_STEP = 4_500  # of a stretch between two samples in which no lamp switches


def check_run_memory(
    sweeps: Sequence[Sweep], settings: Settings, per_sample: float = PER_SAMPLE
) -> None:
    """Refuse a run whose picture would take more memory than the settings allow.

    Raises:
        DqpaintError: it would; the message says what takes most, and what takes less.
    """
    _check({**_of_run(sweeps, per_sample), **_of_light(sweeps), **_of_picture(settings)}, settings)


def check_picture_memory(sweeps: Sequence[Sweep], camera: Camera, settings: Settings) -> None:
    """Likewise for one picture, with the discs that its lamps are from there."""
    layers = max((_layers(sweep, camera) for sweep in sweeps), default=0)
    pixels = _pixels(settings) * PER_PIXEL_OF_LAYER
    discs = {"discs of lamps that are near and far; a smaller --size takes less": layers * pixels}
    _check({**_of_light(sweeps), **_of_picture(settings), **discs}, settings)


def _check(parts: dict[str, float], settings: Settings) -> None:
    total = BASE + sum(parts.values())
    if total <= settings.max_memory * 1e9:
        return
    most = max(parts, key=lambda name: parts[name])
    raise DqpaintError(
        f"this may take {total / 1e9:.1f} GB of memory, above the {settings.max_memory:g} GB of "
        f"--max-memory; {parts[most] / 1e9:.1f} GB are for {most}"
    )


def _of_run(sweeps: Sequence[Sweep], per_sample: float) -> dict[str, float]:
    samples = max((len(sweep.pose) for sweep in sweeps), default=0)
    return {f"{samples:,} samples; a longer period takes less": samples * per_sample}


def _of_light(sweeps: Sequence[Sweep]) -> dict[str, float]:
    """Of the stretch between two samples in which lamps switch most often."""
    work = max((sweep.most_lamp_steps for sweep in sweeps), default=0)
    name = (
        f"{work:,} lamps, times the steps in which they switch between two samples; a lower --pwm "
        "or strobe, fewer leds or a shorter period take less"
    )
    return {name: work * PER_LAMP_STEP}


def _of_picture(settings: Settings) -> dict[str, float]:
    each = PER_PIXEL
    each += PER_PIXEL_OF_ARM if settings.staged else 0
    each += PER_PIXEL_OF_OVERLAY if settings.overlay else 0
    name = f"{settings.width} x {settings.height} pixels; a smaller --size takes less"
    return {name: _pixels(settings) * each}


def _pixels(settings: Settings) -> int:
    return (settings.width + 2 * PAD) * (settings.height + 2 * PAD)


def _layers(sweep: Sweep, camera: Camera) -> float:
    """The number of films that lamps with a size take, for the largest to the smallest disc."""
    points = sweep.lit_points
    if not sweep.emitters.size or not len(points):
        return 0
    depth = np.maximum(camera.project(points)[1], NEAREST_DEPTH)
    return SPREAD_LAYERS + 2 + float(np.log(depth.max() / depth.min()) / np.log(DIAMETER_RATIO))

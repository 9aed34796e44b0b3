"""A motion and settings -> the sweeps of light of a drawing, and the camera of each view.

Of the light alone, and without the image library: a forecast needs it as a picture does.
"""

from dataclasses import replace

import numpy as np

from dqpaint.brushes import Emitters, make_brush, read_brush
from dqpaint.dq import Floats
from dqpaint.errors import DqpaintError
from dqpaint.light.camera.camera import DEFAULT_LENS, FRAME_FILL, Camera
from dqpaint.light.camera.exposure_settings import parse_exposure
from dqpaint.light.camera.views import Shot, camera_for_shot
from dqpaint.light.sources.sweep import Sweep
from dqpaint.motion import Motion
from dqpaint.settings import Settings

MOST_FLASHES = 2_000_000
LEAST_BRIGHTNESS = 0.02  # share of the usual speed: light by length shows a lamp at rest, too
FILL_WITH_ARM = 0.45  # of the limiting dimension a drawing takes that leaves room for the arm


def view_camera(points: Floats, front: Floats, settings: Settings, shot: Shot) -> Camera:
    """The camera of one view.

    Args:
        points: (K, 3) what must be in the picture [m].
        front: (3, 3) columns: right, up and towards the viewer, base frame.
        settings: Size, exposure, and whether there is to be room for the arm.
        shot: From where.
    """
    real = parse_exposure(settings.exposure or "auto")
    lens, distance = (DEFAULT_LENS, None) if real is None else (real.lens, real.distance)
    size = (settings.width, settings.height)
    fill = FILL_WITH_ARM if settings.ghost else FRAME_FILL
    return camera_for_shot(shot, points, front, size, lens, distance, fill)


def sweeps(
    motion: Motion, pose: Floats, colours: Floats, settings: Settings, even: bool = False
) -> tuple[Sweep, ...]:
    """One sweep for each brush of the drawing; each is dark where another brush is used.

    Args:
        motion: The reference motion.
        pose: (N, 8) of the tool, base frame.
        colours: (N, 3) linear, of the time from each row to the next.
        settings: Brush, and how the lamps are dimmed.
        even: Whether every millimetre is to be equally bright.

    Raises:
        DqpaintError: A lamp that flashes too often.
    """
    segments = motion.program.segments
    rates = [(s.strobe.frequency, s.strobe.duty) if s.strobe else (0.0, 1.0) for s in segments]
    strobe = np.array(rates)[motion.stroke[:-1]] if any(s.strobe for s in segments) else None
    fastest = max(settings.pwm, max(rate for rate, _ in rates))
    if fastest * motion.t[-1] > MOST_FLASHES:
        raise DqpaintError(
            f"{motion.program.name}: {fastest:g} Hz for {motion.t[-1]:.0f} s give more than "
            f"{MOST_FLASHES:,} flashes; flashing this fast is not visible: remove it"
        )
    found = []
    for emitters, used in _brushes(motion, settings):
        shone = colours[:-1] if used is None else colours[:-1] * used[:, None]
        if used is not None and not shone.any():
            continue
        sweep = Sweep(motion.period, pose, shone, emitters, strobe, settings.pwm)
        found.append(even_by_length(sweep) if even else sweep)
    return tuple(found)


def _brushes(motion: Motion, settings: Settings) -> list[tuple[Emitters, Floats | None]]:
    """The brushes of a drawing, each with its use (N-1,); None means everywhere."""
    if settings.brush is not None:
        return [(read_brush(settings.brush).emitters(), None)]
    words = [segment.brush for segment in motion.program.segments]
    kinds = list(dict.fromkeys(words))
    if len(kinds) == 1:
        return [(make_brush(kinds[0]).emitters(), None)]
    of = np.array([kinds.index(word) for word in words])[motion.stroke[:-1]]
    return [
        (make_brush(kind).emitters(), (of == i).astype(np.float64)) for i, kind in enumerate(kinds)
    ]


def even_by_length(sweep: Sweep) -> Sweep:
    """The sweep with equal brightness per length: light by path length, not by time."""
    lit = sweep.colours.any(axis=1)
    rates = sweep.lamp_travel / sweep.period
    moving = rates[lit & (rates > 0.0)]
    usual = float(np.median(moving)) if len(moving) else 1.0
    return replace(sweep, colours=sweep.colours * (rates / usual + LEAST_BRIGHTNESS)[:, None])

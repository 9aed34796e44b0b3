"""How long light takes: python tests/bench/bench_film.py. Read the ratios, not the milliseconds."""

from __future__ import annotations

import time
from collections.abc import Callable

import cv2
import numpy as np

from dqpaint import dq
from dqpaint.brushes import read_brush
from dqpaint.light.camera.camera import Camera, frame_points
from dqpaint.light.camera.views import parse_views
from dqpaint.light.film.auto_exposure import automatic_exposure
from dqpaint.light.film.develop import develop
from dqpaint.light.film.film import Film, expose
from dqpaint.light.film.point_spread import point_spread, spread
from dqpaint.light.sources.emission import Light, shine
from dqpaint.light.sources.sweep import Sweep

SECONDS = 24.0


def spiral(samples: int) -> Light:
    """Twelve turns in 24 s, 10 cm in radius."""
    turn = np.linspace(0.0, 24.0 * np.pi, samples)
    radius = 0.1 * turn / turn[-1]
    points = np.column_stack([radius * np.cos(turn), radius * np.sin(turn), 0.0 * turn])
    return shine(points, np.tile([0.05, 0.4, 1.0], (samples, 1)), SECONDS / samples)


def best(work: Callable[[], object], repeats: int = 5) -> float:
    """Shortest of some runs [ms], of all processors together: others may be at work."""
    times = []
    for _ in range(repeats):
        begin = time.process_time()
        work()
        times.append(time.process_time() - begin)
    return 1e3 * min(times)


def seen(light: Light, size: tuple[int, int]) -> Camera:
    return frame_points(light.lit_points, np.eye(3), parse_views("front")[0].view, size)


def whole(light: Light, size: tuple[int, int]) -> None:
    camera, psf = seen(light, size), point_spread(size[1])
    image = spread(expose(light, camera), psf)
    develop(image, automatic_exposure(light, camera))


def at_full_size(film: Film, height: int) -> None:
    """The same spread without a pyramid."""
    image = np.ascontiguousarray(film.planes.transpose(1, 2, 0), dtype=np.float32)
    for width in point_spread(height).widths:
        cv2.GaussianBlur(image, (0, 0), width)


def against_datashader(light: Light, camera: Camera, ours: float) -> None:
    """A million samples, drawn by the library that draws millions; it counts, we integrate."""
    try:
        import datashader
        import pandas
    except ImportError:
        print("  datashader is not installed: not compared (pip install datashader)")
        return
    pixels, _ = camera.project(light.points)
    power = np.vstack([light.energy, light.energy[-1:]])
    columns = dict(zip("xyrgb", [*pixels.T, *power.T], strict=True))
    frame = pandas.DataFrame(columns)
    ranges = {"x_range": (0, camera.width), "y_range": (0, camera.height)}
    canvas = datashader.Canvas(camera.width, camera.height, **ranges)
    sums = datashader.summary(**{channel: datashader.sum(channel) for channel in "rgb"})
    for name, width in (("smooth", 1), ("jagged", 0)):
        theirs = best(lambda w=width: canvas.line(frame, "x", "y", agg=sums, line_width=w), 3)
        print(f"  datashader's {name} line: {theirs:.0f} ms, {theirs / ours:.1f} times ours")


def brushes(size: tuple[int, int]) -> None:
    """3000 poses of a helicoid."""
    turn = np.linspace(0.0, 4.0 * np.pi, 3000)
    half, zero = 0.5 * turn, 0.0 * turn
    rotation = np.column_stack([np.cos(half), zero, np.sin(half), zero])
    pose = dq.pose_from(np.column_stack([zero, 0.02 * turn, zero]), rotation)
    for text in ("point", "ball:size=5mm", "bar", "ribbon", "pixelstick", "fibre"):
        sweep = Sweep(0.008, pose, np.ones((2999, 3)), read_brush(text).emitters())
        camera = frame_points(sweep.lit_points, np.eye(3), parse_views("20,15")[0].view, size)
        spent = best(lambda sweep=sweep, camera=camera: expose(sweep, camera), 2)
        print(f"expose {text:14} 3000 poses at 1080p: {spent:6.0f} ms")


def main() -> None:
    light = spiral(3000)
    begin = time.perf_counter()
    whole(light, (1280, 720))
    first = 1e3 * (time.perf_counter() - begin)
    later = best(lambda: whole(light, (1280, 720)))
    print(f"light to picture, 3000 samples, 1280x720: first {first:.0f} ms, later {later:.0f} ms")

    size = (1920, 1080)
    times = {}
    for samples in (3_000, 100_000, 1_000_000):
        light = spiral(samples)
        camera = seen(light, size)
        times[samples] = best(lambda light=light, camera=camera: expose(light, camera))
        print(f"expose {samples:>9,} samples at 1080p: {times[samples]:6.1f} ms")
    print(f"  333 times the samples cost {times[1_000_000] / times[3_000]:.1f} times as much")

    against_datashader(light, camera, times[1_000_000])
    brushes(size)

    film = expose(light, camera)
    pyramid = best(lambda: spread(film, point_spread(1080)))
    print(f"spread at 1080p: {pyramid:.1f} ms")
    full = best(lambda: at_full_size(film, 1080), 1)
    print(f"  GaussianBlur at full size {full:.0f} ms, {full / pyramid:.0f} times as much")
    image = spread(film, point_spread(1080))
    print(f"develop at 1080p: {best(lambda: develop(image, 10.0)):.1f} ms")


if __name__ == "__main__":
    main()

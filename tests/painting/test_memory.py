"""What a painting would take is forecast before it is taken."""

import os
import subprocess
import sys

import numpy as np
import pytest

import dqpaint
from dqpaint import dq
from dqpaint.brushes import Emitters
from dqpaint.errors import DqpaintError, UsageError
from dqpaint.light.camera import NEAREST_DEPTH, Camera
from dqpaint.light.film import PAD
from dqpaint.light.film.film import FilmAccumulator
from dqpaint.light.sources import Sweep
from dqpaint.painting import memory
from dqpaint.settings import make_settings

TEXT = "period 50 ms\nline to (30, 0) mm in 0.5 s\n"


def sweep(samples=11, lamps=1, period=0.05, size=0.0, depth=0.0, **more):
    ways = np.zeros((samples, 3))
    ways[:, 2] = np.linspace(0.0, depth, samples)
    pose = dq.pose_from(ways, np.array([1.0, 0, 0, 0]))
    places = np.zeros((lamps, 3))
    places[:, 0] = np.arange(lamps) / 1000
    emitters = Emitters(places, np.full((1, lamps, 3), 1 / lamps), size=size)
    return Sweep(period, pose, np.full((samples - 1, 3), 0.5), emitters, **more)


def forecast(sweeps, **settings):
    """The least memory [GB] that is enough, found by halving."""
    low, high = 0.0, 1000.0
    for _ in range(40):
        middle = 0.5 * (low + high)
        try:
            memory.check_run_memory(sweeps, make_settings(max_memory=middle, **settings))
            high = middle
        except DqpaintError:
            low = middle
    return high


def test_each_part_counts():
    small = forecast([sweep()], width=64, height=36)
    assert 0.25 < small < 0.35
    more = forecast([sweep(100_001)], width=64, height=36)
    assert more - small == pytest.approx(99_990 * memory.PER_SAMPLE / 1e9, rel=1e-6)
    wide = forecast([sweep()], width=3840, height=2160)
    pixels = (3840 + 2 * PAD) * (2160 + 2 * PAD) - (64 + 2 * PAD) * (36 + 2 * PAD)
    assert wide - small == pytest.approx(pixels * memory.PER_PIXEL / 1e9, rel=1e-6)
    assert forecast([sweep()], width=3840, height=2160, ghost=True) > wide + 0.5
    lamps = forecast([sweep(lamps=200, pwm=2e4)], width=64, height=36)
    steps = 1 + 3 * (2 * 1000 + 2)
    extra = (200 * steps - 1) * memory.PER_LAMP_STEP / 1e9
    assert lamps - small == pytest.approx(extra, rel=1e-6)


def test_what_takes_most_is_named():
    for sweeps, size, word in (
        ([sweep(1_000_001)], 64, "1,000,001 samples"), ([sweep()], 8192, "8192 x 8192"),
        ([sweep(lamps=2000, pwm=1e5)], 64, "--pwm"),
    ):  # fmt: skip
        with pytest.raises(DqpaintError, match=word):
            memory.check_run_memory(sweeps, make_settings(width=size, height=size))


def test_a_4k_picture_is_made_by_default():
    for more in ({}, {"ghost": True}, {"overlay": True}):
        memory.check_run_memory([sweep()], make_settings(width=3840, height=2160, **more))


def test_discs_near_and_far_take_a_film_for_each_diameter():
    camera = Camera(
        position=np.array([0.0, 0.0, 2.0]), rotation=np.diag([1.0, -1.0, -1.0]), focal=2000.0,
        width=64, height=36, centre=np.array([32.0, 18.0]),
    )  # fmt: skip
    for depth in (0.0, 1.0, 1.9):
        one = sweep(size=0.1, depth=depth)
        film = FilmAccumulator(camera)
        for piece in one.emission_to(camera):
            film.add(piece)
        told = memory._layers(one, camera)
        assert len(film._discs) <= told - memory.SPREAD_LAYERS <= len(film._discs) + 3
    assert memory._layers(sweep(), camera) == 0
    assert NEAREST_DEPTH < 0.1


@pytest.mark.parametrize("make", [dqpaint.draw, dqpaint.preview])
def test_a_run_is_refused_before_it_moves(tmp_path, monkeypatch, make):
    (tmp_path / "a.traj").write_text(TEXT)
    more = {"plant": "ideal"} if make is dqpaint.draw else {}
    make(tmp_path / "a.traj", size=(64, 36), **more)
    name = "dqpaint.painting.paint.track" if more else "dqpaint.painting.picture.expose"
    monkeypatch.setattr(name, lambda *_: pytest.fail("it runs"))
    for choice in ({"max_memory": 0.2}, {"size": (8192, 8192)},
                   {"pwm": 1e5, "brush": "bar:leds=2000"}):  # fmt: skip
        if make is dqpaint.preview and "pwm" in choice:
            continue
        with pytest.raises(DqpaintError, match="max-memory"):
            make(tmp_path / "a.traj", **{"size": (64, 36), **more, **choice})


@pytest.mark.parametrize("wrong", [0, -1, 1001, float("nan")])
def test_a_limit_of_memory_is_a_size(wrong):
    with pytest.raises(UsageError, match="max_memory"):
        make_settings(max_memory=wrong)
    assert make_settings(max_memory=1000).max_memory == 1000


MEASURED = """
import sys
import dqpaint
from dqpaint.painting import memory

forecasts, real = [], memory._check

def kept(parts, settings):
    forecasts.append(memory.BASE + sum(parts.values()))
    real(parts, settings)

memory._check = kept
dqpaint.{make}("a.traj", **{choices})
with open("/proc/self/status") as status:  # ru_maxrss would begin at what the parent had taken
    peak = next(int(line.split()[1]) for line in status if line.startswith("VmHWM"))
print(max(forecasts), 1024 * peak)
"""


@pytest.mark.slow
@pytest.mark.skipif(sys.platform != "linux", reason="elsewhere the peak has other units")
@pytest.mark.parametrize(("make", "choices", "seconds"), [
    ("draw", {"size": (64, 36)}, 0.5), ("draw", {"size": (2560, 1440)}, 0.5),
    ("draw", {"size": (1280, 720), "ghost": True, "overlay": True}, 0.5),
    ("draw", {"size": (64, 36), "brush": "bar:leds=100", "pwm": 2e3}, 0.5),
    ("preview", {"size": (64, 36)}, 10_000.0),
    ("preview", {"size": (640, 360), "brush": "ball:size=30mm"}, 0.5),
])  # fmt: skip
def test_a_forecast_is_above_what_was_taken_and_not_far(tmp_path, make, choices, seconds):
    text = TEXT.replace("0.5 s", f"{seconds:g} s")
    (tmp_path / "a.traj").write_text(text)
    choices = choices | ({"plant": "ideal"} if make == "draw" else {})
    done = subprocess.run(
        [sys.executable, "-c", MEASURED.format(make=make, choices=choices)], cwd=tmp_path,
        env={**os.environ, "PYTHONPATH": os.pathsep.join(filter(None, sys.path))},
        capture_output=True, text=True, check=True,
    )  # fmt: skip
    told, peak = map(float, done.stdout.split()[-2:])
    print(f"{make} {choices}: forecast {told / 1e9:.2f} GB, taken {peak / 1e9:.2f} GB")
    assert peak < told < 4 * peak

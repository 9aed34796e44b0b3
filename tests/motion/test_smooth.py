"""The profile `smooth`: its limits kept, its time by other reckonings, its chains along bends."""

import math

import numpy as np
import pytest

from dqpaint import dq
from dqpaint.diagnostics.collector import DiagnosticCollector
from dqpaint.language import ScriptError, parse
from dqpaint.motion import plan, survey
from dqpaint.motion.geometry.s_curves import reached, s_curves
from dqpaint.motion.look_ahead import Stretches
from dqpaint.motion.schedule import schedule_strokes

FINER = 10  # than the samples
KEPT = 1e-3


def lines(rng, count):
    """Straight lines (K,) of every kind of S-curve, with speeds, accelerations and jerks."""
    length, speed = 10 ** rng.uniform(-4, 0.5, count), 10 ** rng.uniform(-2, 0.5, count)
    acceleration, jerk = 10 ** rng.uniform(-1, 1, count), 10 ** rng.uniform(-1, 3, count)
    none = np.zeros(count)
    stretches = Stretches(np.arange(count), length, np.full(count, 1e30), none, acceleration)
    return stretches, jerk, speed


def textbook(length, v, a, j):
    """The time of an S-curve from rest to rest, case by case."""
    if j * v < a * a:  # the acceleration is never reached on the way to the speed
        a = math.sqrt(j * v)
    if length >= v * (v / a + a / j):
        return length / v + v / a + a / j
    if length >= 2 * a**3 / j**2:  # the acceleration is reached, the speed is not
        top = 0.5 * (-(a**2) / j + math.sqrt(a**4 / j**2 + 4 * a * length))
        return 2 * (top / a + a / j)
    return 4 * (length / (2 * j)) ** (1 / 3)


def test_a_straight_line_takes_the_time_of_the_textbook(rng):
    stretches, jerk, speed = lines(rng, 400)
    found = s_curves(stretches, jerk, speed).seconds
    values = zip(stretches.size, speed, stretches.acceleration, jerk, strict=True)
    np.testing.assert_allclose(found, [textbook(*one) for one in values], rtol=1e-9)


def test_a_straight_line_goes_as_ruckig_goes(rng):
    ruckig = pytest.importorskip("ruckig")
    stretches, jerk, speed = lines(rng, 200)
    found = s_curves(stretches, jerk, speed)
    tau = np.linspace(0, 1, 60)
    for k in range(200):
        asked = ruckig.InputParameter(1)
        asked.current_position, asked.target_position = [0.0], [stretches.size[k]]
        asked.max_velocity, asked.max_jerk = [speed[k]], [jerk[k]]
        asked.max_acceleration = [stretches.acceleration[k]]
        other = ruckig.Trajectory(1)
        assert ruckig.Ruckig(1).calculate(asked, other) == ruckig.Result.Working
        assert found.seconds[k] == pytest.approx(other.duration, rel=1e-9)
        places = [other.at_time(t * other.duration)[0][0] for t in tau]
        mine = found.progress(np.full(len(tau), k), tau).value * stretches.size[k]
        np.testing.assert_allclose(mine, places, atol=1e-9 * stretches.size[k])


def test_the_speed_reached_is_that_of_ruckig_on_the_shortest_way(rng):
    ruckig = pytest.importorskip("ruckig")
    for _ in range(200):
        speed = rng.choice([0.0, 10 ** rng.uniform(-4, 0)])
        way, a, j = 10 ** rng.uniform((-5, -1, -1), (0, 1, 3))
        asked = ruckig.InputParameter(1)
        asked.control_interface = ruckig.ControlInterface.Velocity
        asked.current_velocity, asked.target_velocity = [speed], [reached(speed, way, a, j)]
        asked.max_acceleration, asked.max_jerk = [a], [j]
        other = ruckig.Trajectory(1)
        ruckig.Ruckig(1).calculate(asked, other)
        assert other.at_time(other.duration)[0][0] == pytest.approx(way, rel=1e-7)


def test_chains_keep_every_limit(rng):
    strokes = 40
    count = rng.integers(1, 40, strokes)
    first, n = np.cumsum(count) - count, count.sum()
    size, most = 10 ** rng.uniform(-5, -1.5, n), 10 ** rng.uniform(-4, 0, n)
    gate = np.where(rng.random(n) < 0.1, 0.0, 10 ** rng.uniform(-4, 0, n))
    gate[first] = 0.0
    a, jerk = rng.uniform(0.5, 3, n), 10 ** rng.uniform(0, 2.5, strokes)
    speed = rng.uniform(0.02, 0.5, strokes)
    found = s_curves(Stretches(first, size, most, gate, a), jerk, speed)
    tau = np.linspace(0, 1, 20_001)
    for k in range(strokes):
        own = slice(first[k], first[k] + count[k])
        edges = np.concatenate([[0.0], np.cumsum(size[own])])
        progress = found.progress(np.full(len(tau), k), tau)
        place, rate, slope = (part * found.lengths[k] for part in progress)
        at = np.clip(np.searchsorted(edges, place, side="right") - 1, 0, count[k] - 1)
        inside = (place - edges[at] > 1e-9) & (edges[at + 1] - place > 1e-9)
        most_here = np.minimum(np.sqrt(most[own]), speed[k])[at]
        assert (rate <= most_here * (1 + KEPT))[inside].all()
        assert (np.abs(slope) <= a[own][at] * (1 + KEPT))[inside].all()
        step = found.seconds[k] / (len(tau) - 1)
        assert np.abs(np.diff(slope)).max() <= jerk[k] * step * (1 + KEPT)
        # the rate is the integral of the slope, the place that of the rate: nothing jumps
        assert np.abs(np.diff(rate) - 0.5 * (slope[1:] + slope[:-1]) * step).max() < jerk[k] * (
            step**2
        )
        np.testing.assert_allclose(
            np.cumsum(0.5 * (rate[1:] + rate[:-1])) * step, place[1:], atol=1e-5
        )
        for edge, limit in zip(edges[:-1], gate[own], strict=True):
            assert rate[np.abs(place - edge).argmin()] ** 2 <= limit + 1e-2 * speed[k] ** 2


def drawing(rng):
    """A random path, with its speed, acceleration and jerk."""
    x, y, z, r, angle, blend = rng.uniform((20, 20, -30, 15, 40, 1), (90, 90, 30, 40, 330, 8))
    path = (
        f"line to ({x:.3f}, {y:.3f}, {z:.3f}) mm",
        f"arc centre ({r:.3f}, 0, {z:.3f}) mm angle {angle:.2f} deg rise {z:.2f} mm",
        f"curve ({r:.2f}*t, {y:.2f}*sin(2*t*rad), {z:.2f}*t^2/4) mm for t from 0 to 2",
        f"stroke blend {blend:.2f} mm\nline to ({x:.2f}, 0) mm to ({x:.2f}, {y:.2f}) mm\n"
        f"arc centre (-{r:.2f}, 0) mm angle {angle:.2f} deg\nend",
        f"stroke\nline to ({x:.2f}, 0) mm to ({x:.2f}, {y:.2f}) mm to (0, {-y:.2f}) mm\nend",
    )[rng.integers(5)]
    speed, a, j = 10 ** rng.uniform((-1.5, -0.5, 0), (-0.3, 0.7, 2.3))
    return f"speed {speed} m/s\nprofile smooth({a} m/s/s, {j} m/s/s/s)\n{path}", speed, a, j


@pytest.mark.parametrize("paths", [15, pytest.param(200, marks=pytest.mark.slow)])
def test_random_paths_keep_their_limits_between_the_samples_too(rng, paths):
    for _ in range(paths):
        text, speed, a, j = drawing(rng)
        table = schedule_strokes(parse(text), DiagnosticCollector())
        for stroke in np.flatnonzero(table.paced >= 0):
            tau = np.linspace(0, 1, FINER * table.count[stroke] + 1)
            own = np.full(len(tau), stroke)
            flow, _ = table.flow(own, tau, {})
            point = dq.translation(flow.pose)
            assert np.linalg.norm(dq.point_velocity(flow.twist, point), axis=1).max() <= (
                speed * (1 + KEPT)
            )
            slope = table.progress(own, tau).slope * table.length[stroke]
            assert np.abs(slope).max() <= a * (1 + KEPT)
            step = table.time[stroke] / (len(tau) - 1)
            assert np.abs(np.diff(slope)).max() <= j * step * (1 + KEPT)
            assert table.wanted[stroke] <= table.time[stroke] * (1 + 1e-9)
            assert table.time[stroke] < table.wanted[stroke] + 0.008 * (1 + 1e-9)


def test_a_time_is_kept_within_the_limits_or_refused():
    text = "line to (100, 0) mm in {} s profile smooth"
    motion = plan(parse(text.format(2)), dq.IDENTITY)
    assert motion.t[-1] == pytest.approx(2.0, abs=1e-9)
    assert np.abs(np.diff(motion.acceleration[:, 3:], axis=0)).max() <= 20 * 0.008 * (1 + KEPT)
    least = textbook(0.1, 100.0, 2.0, 20.0)
    assert plan(parse(text.format(least * 1.001)), dq.IDENTITY).t[-1] >= least
    with pytest.raises(ScriptError, match="E328"):
        plan(parse(text.format(least * 0.999)), dq.IDENTITY)


@pytest.mark.parametrize("corner", ["corner jump", "corner 0 mm"])
def test_it_stops_at_corners_that_no_arc_rounds(corner):
    text = f"profile smooth\n{corner}\nstroke\nline to (60, 0) mm to (60, 40) mm\nend"
    motion = plan(parse(text), dq.IDENTITY)
    at = np.abs(motion.points - [0.06, 0.0, 0.0]).max(axis=1).argmin()
    assert np.linalg.norm(motion.twist[at, 3:]) < 2e-2


def test_it_mixes_with_other_profiles():
    one, other = (
        "line to (50, 0) mm profile smooth\n",
        "stroke\nline by (0, 30) mm by (9, 9) mm\nend\n",
    )
    apart = [plan(parse(text), dq.IDENTITY).t[-1] for text in (one, other)]
    together = plan(parse(one + other + one.replace("50", "80")), dq.IDENTITY)
    rows = [round(time / 0.008) for time in apart]
    both = plan(parse(other), dq.IDENTITY)
    moved = together.points[rows[0] : sum(rows) + 1] - together.points[rows[0]]
    np.testing.assert_allclose(moved, both.points - both.points[0], atol=1e-12)


def test_a_survey_of_smooth_strokes_is_that_of_their_plan(rng):
    for _ in range(10):
        program = parse(drawing(rng)[0])
        found, motion = survey(program), plan(program, dq.IDENTITY)
        assert (found.samples, found.seconds) == (len(motion.t), motion.t[-1])
        assert (found.length, found.unevenness) == (motion.length, motion.unevenness)
        assert found.notes == motion.notes

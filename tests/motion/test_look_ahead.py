"""Look-ahead: limits kept, no time lost, corners within what is said, light even, times kept."""

import math

import numpy as np
import pytest
from scipy.spatial import cKDTree

from dqpaint import dq
from dqpaint.language import parse
from dqpaint.language.pen.stroke_state import ACCELERATION
from dqpaint.motion import plan
from dqpaint.motion.look_ahead import Stretches, fastest, speeds_for
from tests.support.strokes import strokes_of

HALF = math.sqrt(2.0) * ACCELERATION  # along the path and across it at once


def random_stretches(rng, strokes=4):
    count = rng.integers(1, 12, strokes)
    first = np.cumsum(count) - count
    size = rng.uniform(1e-4, 0.02, count.sum())
    most = 10.0 ** rng.uniform(-5, -1, count.sum())
    gate = np.where(rng.random(count.sum()) < 0.3, 0.0, 10.0 ** rng.uniform(-5, 0, count.sum()))
    gate[first] = 0.0
    return Stretches(first, size, most, gate, rng.uniform(0.5, 3.0, count.sum()))


def slowly(stretches, number, cruise, parts=4000):
    """The least time of one stroke: another reckoning, step by step on a fine grid."""
    ends = np.append(stretches.first[1:], len(stretches.size))
    own = slice(stretches.first[number], ends[number])
    size, most = stretches.size[own], np.minimum(stretches.most[own], cruise**2)
    gain = np.repeat(2 * stretches.acceleration[own] * size / parts, parts)
    x = np.append(np.repeat(most, parts), 0.0)
    joints = np.arange(len(size)) * parts
    x[joints] = np.minimum(x[joints], stretches.gate[own])
    x[joints[1:]] = np.minimum(x[joints[1:]], most[:-1])
    for k in range(len(gain)):
        x[k + 1] = min(x[k + 1], x[k] + gain[k])
    for k in range(len(gain) - 1, -1, -1):
        x[k] = min(x[k], x[k + 1] + gain[k])
    v = np.sqrt(x)
    return (2 * np.repeat(size / parts, parts) / (v[1:] + v[:-1])).sum()


def test_no_limit_is_passed_and_no_time_is_lost(rng):
    for _ in range(4):
        stretches = random_stretches(rng)
        cruise = rng.uniform(0.02, 0.4, 4)
        phases = fastest(stretches, cruise)
        for number in range(4):
            seconds = slowly(stretches, number, cruise[number])
            assert phases.seconds[number] == pytest.approx(seconds, rel=2e-3)
            tau = np.linspace(0, 1, 20_001)
            found = phases.progress(np.full(len(tau), number), tau)
            place = found.value * phases.lengths[number]
            speed = found.rate * phases.lengths[number]
            ends = np.append(stretches.first[1:], len(stretches.size))
            own = slice(stretches.first[number], ends[number])
            edges = np.cumsum(stretches.size[own])
            at = np.minimum(np.searchsorted(edges, place), len(edges) - 1)
            assert (
                speed**2 <= np.minimum(stretches.most[own][at], cruise[number] ** 2) + 1e-9
            ).all()
            bend = found.slope * phases.lengths[number]
            assert (np.abs(bend) <= stretches.acceleration[own].max() * (1 + 1e-9)).all()
            assert found.value[0] == 0.0
            assert found.value[-1] == 1.0
            assert speed[0] == 0.0
            assert speed[-1] < 1e-6
            for stop in np.flatnonzero(stretches.gate[own][1:] == 0.0):
                assert speed[np.abs(place - edges[stop]).argmin()] < 0.02
            step = phases.seconds[number] / 20_000
            np.testing.assert_allclose(np.cumsum(speed)[:-1] * step, place[:-1], atol=2e-4)


def test_a_straight_line_takes_the_time_of_the_textbook():
    length, speed, a = np.array([0.2, 0.003]), np.array([0.1, 0.1]), 2.0
    line = Stretches(np.arange(2), length, np.full(2, 1e30), np.zeros(2), np.full(2, a))
    found = fastest(line, speed)
    np.testing.assert_allclose(
        found.seconds, [0.2 / 0.1 + 0.1 / a, 2 * math.sqrt(0.003 / a)], rtol=1e-12
    )
    np.testing.assert_allclose(found.peaks, [0.1, math.sqrt(0.003 * a)], rtol=1e-12)


def test_a_time_is_kept_where_the_acceleration_allows_it(rng):
    stretches = random_stretches(rng)
    wanted = 1.5 * fastest(stretches, np.full(4, 10.0)).seconds
    found = fastest(stretches, speeds_for(stretches, wanted))
    np.testing.assert_allclose(found.seconds, wanted, rtol=1e-9)
    least = fastest(stretches, speeds_for(stretches, 0.1 * wanted)).seconds
    assert (least > 0.1 * wanted).all()


PATHS = {
    "name": 'text "Marie" "Curie" font "scripts" height 25 mm',
    "gothic": 'text "Ein Ag" font "gothiceng" height 25 mm',
    "square": "stroke\nline by (50, 0) mm by (0, 50) mm by (-50, 20) mm by (1, 0) mm\nend",
    "bent": "stroke\nline by (30, 0) mm\narc centre (20, 20, 5) mm angle 200 deg\n"
    "line by (9, 9) mm\nend",
    "rotated": "stroke tool rpy(0, 20 deg, 60 deg)\nline by (50, 0) mm by (0, 50, 9) mm\nend",
    "formula": "stroke\ncurve (20*t, 20*sin(3*t*rad)) mm for t from 0 to 3\n"
    "line by (0, 30) mm\nend",
    "blended": "blend 5 mm\nline by (50, 0) mm by (0, 50) mm by (-50, 20) mm",
    "letters": 'blend 2 mm\ntext "Wok" font "futural" height 25 mm',
}


@pytest.mark.parametrize("corner", ["", "corner 0.5 mm\n", "corner 0 mm\n"])
@pytest.mark.parametrize("path", PATHS)
def test_a_drawing_keeps_its_acceleration_and_its_light_even(path, corner):
    motion = plan(parse(f"period 1 ms\n{corner}{PATHS[path]}", "a"), dq.IDENTITY)
    assert not motion.notes
    velocity = dq.point_velocity(motion.twist, motion.points)
    speed = np.linalg.norm(velocity, axis=1)
    assert speed.max() <= 0.1 * (1 + 1e-9)
    bend = dq.point_acceleration(motion.twist, motion.acceleration, motion.points)
    assert np.linalg.norm(bend, axis=1).max() < HALF * 1.05
    change = np.linalg.norm(np.diff(velocity, axis=0), axis=1) / motion.period
    assert change.max() < HALF * 1.05
    stretch = np.linalg.norm(np.diff(motion.points, axis=0), axis=1)
    lit = motion.lit[:-1] & (stretch > 1e-5)
    per_length = motion.light[:-1].max(axis=1)[lit] * motion.period / stretch[lit]
    np.testing.assert_allclose(per_length, 1 / 0.1, rtol=0.02)


@pytest.mark.parametrize("deviation", [0.05, 0.5, 2.0])
@pytest.mark.parametrize("path", ["gothic", "square", "bent"])
def test_the_path_leaves_its_corners_by_no_more_than_is_said(path, deviation):
    def points(corner):
        text = f"period 1 ms\nprofile constant\ncorner {corner}\nspeed 30 mm/s\n{PATHS[path]}"
        return plan(parse(text, "a"), dq.IDENTITY).points

    sharp, found = points("jump"), points(f"{deviation} mm")
    for one, other in ((sharp, found), (found, sharp)):
        far = cKDTree(other).query(one)[0].max()
        assert far < 1e-3 * deviation + 2e-5
    assert cKDTree(found).query(sharp)[0].max() > 0.5e-3 * min(deviation, 0.5) - 2e-5


def test_a_corner_is_run_through_at_the_speed_of_its_arc():
    turn, deviation = math.pi / 2, 1e-3
    text = "period 1 ms\nstroke corner 1 mm\nline by (50, 0) mm by (0, 50) mm\nend"
    motion = plan(parse(text, "a"), dq.IDENTITY)
    speed = np.linalg.norm(dq.point_velocity(motion.twist, motion.points), axis=1)
    radius = deviation / (1 / math.cos(turn / 2) - 1)
    inner = slice(len(speed) // 4, -len(speed) // 4)
    assert speed[inner].min() == pytest.approx(math.sqrt(ACCELERATION * radius), rel=1e-3)


def test_a_corner_of_nothing_is_a_stop_and_constant_is_none():
    body = "line by (50, 0) mm by (0, 50) mm\nend"
    motion = plan(parse(f"period 1 ms\nstroke corner 0 mm\n{body}", "a"), dq.IDENTITY)
    speed = np.linalg.norm(dq.point_velocity(motion.twist, motion.points), axis=1)
    assert speed[len(speed) // 2 - 3 : len(speed) // 2 + 4].min() < 2e-3
    assert np.abs(motion.points - [0.05, 0, 0]).sum(1).min() < 2e-6
    for clause in ("profile constant", "corner jump", "profile cubic(1 mm/s, 1 mm/s)"):
        (stroke,) = strokes_of(parse(f"stroke {clause}\n{body}", "a"))
        assert stroke.table.pace is None


@pytest.mark.parametrize("seconds", [12.0, 4.0])
def test_a_text_takes_its_time_and_all_of_it_shines_alike(seconds):
    motion = plan(parse(f'text "Ai" height 30 mm in {seconds} s', "a"), dq.IDENTITY)
    assert motion.seconds == pytest.approx(seconds, abs=6 * motion.period)
    stretch = np.linalg.norm(np.diff(motion.points, axis=0), axis=1)
    lit = motion.lit[:-1] & (stretch > 1e-5)
    per_length = motion.light[:-1].max(axis=1)[lit] / stretch[lit]
    np.testing.assert_allclose(per_length, np.median(per_length), rtol=0.02)


def test_jumps_that_are_meant_are_not_told():
    text = "profile constant\ncorner jump\nline by (50, 0) mm by (0, 50) mm"
    assert not plan(parse(text, "a"), dq.IDENTITY).notes
    text = "profile constant\nline by (50, 0) mm\nline by (0, 50) mm corner jump"
    assert [note.code for note in plan(parse(text, "a"), dq.IDENTITY).notes] == ["W403"]

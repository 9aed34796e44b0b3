"""Rehearsals: what is learned, where it ends, and that a real arm's files say the same."""

import math

import numpy as np
import pytest

import dqpaint
from dqpaint import dq
from dqpaint.errors import DqpaintError, UsageError
from dqpaint.language import parse
from dqpaint.motion import plan
from dqpaint.robots.model import read_card
from dqpaint.simulation import corrected, encode_learned, read_learned
from dqpaint.studies.declared import run_study
from dqpaint.studies.kinds import rehearse

RING = """period 8 ms
profile quintic
move to (30, 0) mm
arc centre (0, 0) mm angle 360 deg in 2 s light white
"""
SMALL = {"size": "64x36", "jobs": 1}


@pytest.fixture
def ring(tmp_path):
    path = tmp_path / "ring.traj"
    path.write_text(RING)
    return path


def rehearsed(drawing, folder, **given):
    return run_study("rehearse", str(drawing), {**SMALL, **given}, folder)


MOTION = plan(
    parse("period 8 ms\nline to (60, 20, 5) mm tool rot(y, 20 deg) in 0.8 s\n", "m.traj"),
    read_card("iiwa").canvas.pose,
)


def test_the_corrected_reference_moves_as_its_twists_say(rng):
    """By central differences of its poses, from a correction that turns and moves far."""
    t = MOTION.t[:, None]
    a = rng.normal(size=6) * 0.3 * np.sin(3 * t) + rng.normal(size=6) * 0.2 * t
    found = corrected(MOTION, a)
    rows = slice(40, 75)  # where it is faded in, and before the drawing's end
    step = dq.mul(found.pose[2:], dq.conj(dq.nearest(found.pose[:-2], found.pose[2:])))
    by_poses = (2 * dq.log(step) / (2 * MOTION.period))[rows]
    np.testing.assert_allclose(found.twist[1:-1][rows], by_poses, atol=3e-4)
    slope = np.gradient(found.twist, MOTION.period, axis=0)[1:-1][rows]
    np.testing.assert_allclose(found.acceleration[1:-1][rows], slope, atol=3e-3)
    np.testing.assert_array_equal(found.pose[0], MOTION.pose[0])  # it begins at the reference


def test_a_learned_path_survives_its_file(tmp_path, rng):
    a = rng.normal(size=(len(MOTION.t), 6)) * 1e-3
    path = tmp_path / "a.csv"
    path.write_bytes(encode_learned(MOTION.t, a))
    np.testing.assert_array_equal(read_learned(str(path), MOTION.t), a)
    with pytest.raises(UsageError, match="another one"):
        read_learned(str(path), MOTION.t * 1.5)


def test_the_filter_shifts_nothing_and_takes_what_is_fast():
    t = 0.008 * np.arange(1000)
    slow, fast = (np.sin(2 * np.pi * f * t)[:, None] for f in (0.5, 40.0))
    passed = rehearse.low_pass(slow + fast, 6.0, 0.008)[200:-200]
    np.testing.assert_allclose(passed, slow[200:-200], atol=5e-3)
    with pytest.raises(UsageError, match="half the rate"):
        rehearse.low_pass(slow, 62.5, 0.008)


def test_how_late_an_arm_answers_is_found():
    pose = MOTION.pose
    for rows in (0, 3, 7):
        late = np.concatenate([np.repeat(pose[:1], rows, axis=0), pose[: len(pose) - rows]])
        assert abs(rehearse.answer_rows(pose, late, MOTION.period) - rows) <= rows // 7


def test_when_it_ends():
    assert rehearse.finished([1e-3]) == ""
    assert rehearse.finished([1e-3, 3e-4]) == ""
    assert "worse" in rehearse.finished([1e-3, 3e-4, 4e-4])
    assert "less than 2 %" in rehearse.finished([1e-3, 9.9e-4])
    assert rehearse.finished([1e-6]).endswith("nothing to learn")


@pytest.mark.slow
def test_a_jump_is_not_rehearsed(tmp_path):
    with pytest.raises(DqpaintError, match="set point jumps"):
        rehearsed("step", tmp_path, plant="ideal")


def test_an_arm_that_needs_no_teaching_learns_nothing(tmp_path):
    """A light that turns evenly on the ideal arm: the law's steps leave no error."""
    path = tmp_path / "still.traj"
    path.write_text("period 8 ms\nhold 0.5 s light white\n")
    found = rehearsed(path, tmp_path / "out", plant="ideal")
    assert len(found.trials) == 1
    assert not found.learned.any()


@pytest.mark.slow
def test_it_takes_off_gamma_a_trial_and_recordings_teach_the_same(ring, tmp_path, monkeypatch):
    """The runs of a law that lags, again from their own CSVs, as a real arm would give them."""
    monkeypatch.chdir(tmp_path)
    given = {"controller": "p", "plant": "ideal", "trials": 3}
    found = rehearsed(ring, tmp_path / "a", **given)
    assert found.ratios == pytest.approx([0.3, 0.3], rel=0.1)
    again = rehearsed(ring, tmp_path / "a", **given)  # from the journal
    np.testing.assert_array_equal(again.learned, found.learned)
    names = []
    for j, cell in enumerate(found.cells):
        run = dqpaint.draw(
            str(ring), controller="p", plant="ideal", size=(64, 36),
            learned=cell.runs[0].settings.learned,
        )  # fmt: skip
        names.append(f"run{j}.csv")
        table = {name: run.table[name] for name in ("t_s", *(f"q{i}_rad" for i in range(1, 8)))}
        rows = zip(*(column.tolist() for column in table.values()), strict=True)
        text = "\n".join([",".join(table), *(",".join(map(repr, row)) for row in rows)])
        (tmp_path / names[-1]).write_text(text + "\n")
    recorded = rehearsed(ring, tmp_path / "b", recordings=",".join(names[:2]))
    np.testing.assert_allclose(recorded.learned, found.learned, atol=1e-6)
    assert [one.rms for one in recorded.trials] == pytest.approx(
        [one.rms for one in found.trials[:2]], rel=1e-3
    )


@pytest.mark.slow
def test_on_compliant_the_slope_is_the_predicted_one(ring, tmp_path):
    found = rehearsed(ring, tmp_path, plant="compliant", trials=3)
    errors = [one.rms for one in found.trials]
    slope = np.polyfit(range(3), np.log(errors), 1)[0]
    assert slope == pytest.approx(math.log(1 - 0.7), rel=0.1)


@pytest.mark.slow
def test_without_the_filter_it_ends_before_it_grows(tmp_path):
    given = {"controller": "p", "gains": "k=40", "plant": "compliant", "gamma": 1.0}
    found = rehearsed("star", tmp_path, cutoff=0.0, trials=10, **given)
    errors = [one.rms for one in found.trials]
    assert len(errors) < 10
    assert errors[-1] > errors[-2]
    assert found.best == len(errors) - 2
    np.testing.assert_array_equal(found.learned, found.trials[-2].correction)

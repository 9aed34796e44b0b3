"""The unmodelled twist: its form, its band, and that the arm is moved by just that."""

import numpy as np
import pytest

from dqpaint import dq
from dqpaint.controllers import CONTROLLERS
from dqpaint.controllers.base.controller import Controller
from dqpaint.controllers.laws.pereira.p import RateGains
from dqpaint.disturbances import DISTURBANCES, make_disturbances
from dqpaint.errors import UnknownNameError, UsageError
from dqpaint.language import parse
from dqpaint.motion import plan
from dqpaint.plants import PLANTS
from dqpaint.robots.kinematics.kinematics import Kinematics
from dqpaint.robots.model.card import read_card
from dqpaint.simulation.closed_loop import track

CARD = read_card("iiwa")
ARM = Kinematics(CARD)
PERIOD = 0.004
T = np.arange(5000) * PERIOD
SIX = {"x": 0.1, "y": -0.2, "z": 0.3, "wx": 1.0, "wy": 2.0, "wz": -3.0}
SIZE = np.array([1.0, 2.0, -3.0, 0.1, -0.2, 0.3])


def signal(seed=0, **values):
    one = make_disturbances({"twist": values})["twist"]
    return one.twist(T, PERIOD, np.random.default_rng(seed))


def test_constant_and_sine_are_what_they_say():
    np.testing.assert_array_equal(signal(**SIX), np.tile(SIZE, (len(T), 1)))
    wanted = np.sin(2 * np.pi * 3.0 * T)[:, None] * SIZE
    np.testing.assert_allclose(signal(form="sine", frequency=3.0, **SIX), wanted, atol=1e-12)
    assert (signal(**{"": "sine", "x": 1.0})[0] == 0).all()


def test_noise_has_its_rms_its_band_and_axes_of_their_own():
    noise = signal(form="noise", frequency=5.0, **SIX)
    np.testing.assert_allclose(noise.std(axis=0), np.abs(SIZE), rtol=0.05)
    np.testing.assert_allclose(noise.mean(axis=0), 0, atol=0.05 * np.abs(SIZE).max())
    power = np.abs(np.fft.rfft(noise * np.hanning(len(T))[:, None], axis=0)) ** 2
    above = np.fft.rfftfreq(len(T), PERIOD) > 5.1
    assert power[above].sum() < 1e-5 * power.sum()
    assert power[~above][len(power[~above]) // 2 :].sum() > 0.3 * power.sum()
    off = np.corrcoef(noise.T) - np.eye(6)
    assert np.abs(off).max() < 0.2


def test_noise_repeats_with_its_seed_alone():
    one, same, other = (signal(s, form="noise", x=1.0) for s in (3, 3, 4))
    np.testing.assert_array_equal(one, same)
    assert np.abs(one - other).max() > 0.5


@pytest.mark.parametrize(("values", "said"), [
    ({}, "it has no effect"),
    ({"v": 1.0}, "'v'"),
    ({"": "square", "x": 1.0}, "'square' .*'sine'"),
    ({"x": "fast"}, "x 'fast'"), ({"x": float("nan")}, "x nan"),
    ({"x": 1.0, "frequency": 0.0}, "frequency 0.0 .*0.001"),
])  # fmt: skip
def test_bad_values_are_refused_with_the_known_ones(values, said):
    with pytest.raises(UsageError, match=said):
        make_disturbances({"twist": values})


def test_a_frequency_beyond_half_the_rate_is_refused():
    with pytest.raises(UsageError, match=r"126 Hz .*125 Hz"):
        signal(form="sine", x=1.0, frequency=126.0)
    with pytest.raises(UsageError, match="125 Hz"):
        signal(form="noise", x=1.0, frequency=126.0)


def test_unknown_disturbances_list_the_known_ones():
    with pytest.raises(UnknownNameError, match=r"'wind'; .*base"):
        make_disturbances({"wind": {}})


@pytest.mark.parametrize("name", DISTURBANCES)
def test_every_disturbance_names_its_units(name):
    model = DISTURBANCES[name]
    assert model.__doc__
    assert all(field.description for field in model.model_fields.values())


STILL = Controller("still", "none", RateGains, lambda seen, _gains: np.zeros(6))


@pytest.mark.parametrize("plant", ["ideal", pytest.param("stiff", marks=pytest.mark.slow)])
@pytest.mark.parametrize("values", [{"y": 0.03, "z": 0.02}, {"wx": 0.2, "wy": -0.3}])
def test_the_tool_is_carried_by_just_that_velocity(plant, values):
    """Under a law that does nothing: the place by the linear part, the turning by the angular."""
    motion = plan(parse("period 2 ms\nstart at (0, 0)\nhold 0.5 s\n", "t.traj"), CARD.canvas.pose)
    start = CARD.home + 0.1
    run = track(
        motion, ARM, start, PLANTS[plant], STILL, STILL.read_gains({}),
        disturbances=make_disturbances({"twist": values}),
    )  # fmt: skip
    v = np.array([values.get(axis, 0.0) for axis in ("x", "y", "z")])
    w = np.array([values.get(axis, 0.0) for axis in ("wx", "wy", "wz")])
    np.testing.assert_allclose(run.points[-1] - run.points[0], 0.5 * v, atol=2e-4)
    turned = 2 * dq.log(dq.mul(run.pose[-1], dq.conj(run.pose[0])))[:3]
    np.testing.assert_allclose(turned, 0.5 * w, atol=1e-3)
    v0 = v + np.cross(run.points[:-1], w)  # about the base origin
    np.testing.assert_allclose(
        run.disturbance[:-1], np.c_[np.tile(w, (len(v0), 1)), v0], atol=1e-12
    )
    assert not run.disturbance[-1].any()


def test_a_run_without_one_has_none():
    motion = plan(parse("hold 80 ms\n", "t.traj"), CARD.canvas.pose)
    law = CONTROLLERS["hinf"]
    run = track(motion, ARM, CARD.home, PLANTS["ideal"], law, law.read_gains({}))
    assert not run.disturbance.any()


@pytest.mark.parametrize(("values", "said"), [
    ({"x": 1e200}, "x 1e.200 .*1000"),
    ({"x": 1e-200}, "1e-09 to 1000"),
    ({"x": 1.0, "frequency": 1e-200}, "frequency 1e-200 .*0.001"),
    ({"": "sine", "form": "noise", "x": 1.0}, "form .*twice"),
])  # fmt: skip
def test_slips_are_refused_with_the_range(values, said):
    with pytest.raises(UsageError, match=said):
        make_disturbances({"twist": values})


def test_a_sine_at_half_the_rate_would_meet_zeros_alone():
    with pytest.raises(UsageError, match=r"125 Hz .*125 Hz"):
        signal(form="sine", frequency=125.0, x=1.0)
    assert np.abs(signal(form="noise", frequency=125.0, x=1.0)).max() > 0.5

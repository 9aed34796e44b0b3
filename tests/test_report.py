"""What a person is told after a run."""

import pytest

import dqpaint
from dqpaint import listing, report


def remarks(tmp_path, period, controller):
    path = tmp_path / "dot.traj"
    path.write_text(f"period {period}\nhold 40 ms\n")
    plant = None if controller.startswith("accel") else "ideal"
    return report.remarks(dqpaint.draw(path, controller=controller, plant=plant, size=(64, 36)))


@pytest.mark.slow
@pytest.mark.parametrize("controller", ["accel", "accel-decoupled"])
def test_torques_held_for_long_are_warned_of(tmp_path, controller):
    (text,) = remarks(tmp_path, "8 ms", controller)
    assert text == (
        "warning: torques are held for 8 ms; laws that command them are made for 5 ms (200 Hz) or "
        "less\n  = help: write period 5 ms in the drawing"
    )
    assert remarks(tmp_path, "5 ms", controller) == []


def test_joint_rates_held_for_long_are_not(tmp_path):
    assert remarks(tmp_path, "20 ms", "hinf") == []


def test_a_gain_without_a_default_is_listed_without_one():
    text = listing.text(listing.lists("controllers"))
    assert "  K_O  1/s, in place of gamma_O\n" in text
    assert "None" not in text

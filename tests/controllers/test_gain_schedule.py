"""Gains that change over a drawing: how they are written, read, checked and shown."""

import numpy as np
import pytest
from pydantic import Field

from dqpaint.controllers import CONTROLLERS
from dqpaint.controllers.base.gain_schedule import read_schedule
from dqpaint.controllers.base.gains import Gain, Gains
from dqpaint.errors import UsageError


class Two(Gains):
    k: Gain = Field(20.0, description="1/s")
    q: Gain | tuple[Gain, ...] = Field(1.0, description="a diagonal")


def read(**given):
    return read_schedule(Two, given, "controller 'two'")


@pytest.mark.parametrize(("text", "at"), [
    ("2.8..5.3@10%", {0.0: 2.8, 0.05: 4.05, 0.1: 5.3, 0.5: 5.3, 1.0: 5.3}),
    ("5..20", {0.0: 5, 0.5: 12.5, 1.0: 20}),
    ("220..220@30%..270@30%", {0.0: 220, 0.29999: 220, 0.3: 270, 1.0: 270}),
    ("1@20%..2@40%..1@100%", {0.0: 1, 0.2: 1, 0.3: 1.5, 0.4: 2, 0.7: 1.5, 1.0: 1}),
    ("20", {0.0: 20, 1.0: 20}), ("1e1..2e1@50%", {0.25: 15}), ("3..7@0%", {0.0: 7, 0.5: 7}),
    ("3..3@100%..7@100%", {0.99: 3, 1.0: 7}),
])  # fmt: skip
def test_values_over_the_drawing(text, at):
    gains = read(k=text)
    for part, value in at.items():
        assert gains.at(part).k == pytest.approx(value, abs=1e-9)
    assert [g.k for g in gains.over(np.array(list(at)))] == pytest.approx(list(at.values()))


def test_diagonals_change_element_by_element():
    gains = read(q="1,2,3..3@50%")
    assert gains.at(0.0).q == (1, 2, 3)
    assert gains.at(0.25).q == (2, 2.5, 3)
    assert gains.at(1.0).q == (3, 3, 3)
    assert read(q=(1.0, 2.0)).at(0.5).q == (1.0, 2.0)
    assert read(q="1,2").at(0.5).q == (1.0, 2.0)


def test_two_gains_change_apart():
    gains = read(k="10..20", q="1..3@50%")
    assert (gains.at(0.25).k, gains.at(0.25).q) == (12.5, 2.0)


@pytest.mark.parametrize("text", [
    "", "x", "5..", "..5", "5..x@10%", "5..20@10", "5..20@110%", "5..20@-1%", "5@10%",
    "1..2@50%..3@20%", "1..2..3", "1,2..1,2,3@50%", "5..20@", "5..20@@10%", "1,,2",
])  # fmt: skip
def test_what_is_no_schedule_is_told_with_the_form(text):
    with pytest.raises(UsageError, match=r"'q' .*'two' is '"):
        read(q=text)


@pytest.mark.parametrize("text", ["5..0@10%", "5..-3", "5..nan", "0..5", "5..1e12@20%"])
def test_every_value_on_the_way_is_checked(text):
    with pytest.raises(UsageError, match="1e-09 to 1e\\+09; "):
        read(k=text)


def test_what_is_shown_is_what_was_written():
    assert read(k="5..20@10%").as_dict() == {"k": "5..20@10%", "q": 1.0}
    shown = CONTROLLERS["hinf"].read_gains({"gamma_O": "0.5..0.25@10%"}).as_dict()
    assert shown["gamma_O"] == "0.5..0.25@10%"
    assert shown["K_O"] == "4..8@10%"  # follows
    assert shown["gamma_T"] == 0.0707


def test_constant_gains_are_one_object():
    rows = read(k=3.0).over(np.linspace(0, 1, 5))
    assert all(row is rows[0] for row in rows)


@pytest.mark.parametrize(("text", "at"), [
    ("10@50%..40@50%", {0.0: 10, 0.49: 10, 0.5: 40, 1.0: 40}),
    ("10@50%..40@50%..60@100%", {0.0: 10, 0.25: 10, 0.75: 50, 1.0: 60}),
])  # fmt: skip
def test_what_stands_before_a_first_jump_holds_until_then(text, at):
    gains = read(k=text)
    for part, value in at.items():
        assert gains.at(part).k == pytest.approx(value)


def test_what_follows_from_a_gain_that_comes_back_is_not_shown_as_constant():
    shown = CONTROLLERS["hinf"].read_gains({"K_T": "20..40@50%..20"}).as_dict()
    assert shown["gamma_T"] == "0.0707107..0.0353553@50%..0.0707107@100%"
    assert shown["K_O"] == 40


def test_both_values_of_a_jump_count_for_the_promise():
    dip = CONTROLLERS["hinf"].read_gains({"K_T": "40..10@95%..40@95%"})
    assert dip.disturbance_bounds()[1] == pytest.approx(0.1)
    assert CONTROLLERS["hinf"].read_gains({"K_T": "10@50%..40@50%"}).disturbance_bounds()[1] == 0.1


def test_a_ramp_has_a_bounded_number_of_points():
    text = "..".join(f"{20 + i % 2}@{i / 20:g}%" for i in range(1001))
    with pytest.raises(UsageError, match=r"'k' .*1001 points; .*1000"):
        CONTROLLERS["p"].read_gains({"k": text})


@pytest.mark.parametrize("law", ["lqr", "lqr8"])
def test_what_counts_at_the_end_alone_has_no_ramp(law):
    with pytest.raises(UsageError, match=r"'0\.\.1@10%'"):
        CONTROLLERS[law].read_gains({"s": "0..1@10%"})
    assert CONTROLLERS[law].read_gains({"s": "0.3"}).first.s == 0.3


@pytest.mark.parametrize(("gamma", "weakest"), [("0.1..0.3@50%..0.2@60%", 0.3), ("0.3..0.1", 0.3)])
def test_the_weakest_promise_of_rotation_counts(gamma, weakest):
    promise = CONTROLLERS["hinf"].read_gains({"gamma_O": gamma}).disturbance_bounds()
    assert promise == pytest.approx(
        CONTROLLERS["hinf"].read_gains({"gamma_O": weakest}).disturbance_bounds()
    )


def test_a_gain_that_has_no_value_is_not_shown():
    class Some(Gains):
        k: Gain = Field(1.0)
        limit: Gain | None = Field(None)

    assert Some().as_dict() == {"k": 1.0}
    assert Some(limit=2.0).as_dict() == {"k": 1.0, "limit": 2.0}

"""What a study varies: values as they are written, and settings with them in place."""

import numpy as np
import pytest

from dqpaint.errors import UsageError
from dqpaint.settings.model import make_settings
from dqpaint.studies.experiment.axes import (
    Axis,
    axis_description,
    axis_label,
    combinations,
    parse_axis,
    parse_texts,
    split_law,
    with_choice,
)


def test_lists_and_ranges():
    assert parse_axis("k=5, 10,20") == Axis("k", ("5", "10", "20"))
    assert parse_axis("plant=ideal,stiff").numbers is None
    assert parse_axis("k=0..10:6").texts == ("0", "2", "4", "6", "8", "10")
    assert parse_axis("k=0..10:lin:6") == parse_axis("k=0..10:6")
    np.testing.assert_allclose(parse_axis("k=100..1:log:5").numbers, [100, 31.62, 10, 3.162, 1])
    assert len(set(parse_axis("k=1..1.00001:9").texts)) == 9
    assert parse_axis("Q=[1,1,4],2").texts == ("[1,1,4]", "2")
    assert parse_axis("k=5..20@10%,7").texts == ("5..20@10%", "7")  # a ramp is a value


@pytest.mark.parametrize(
    ("text", "fault"),
    [
        ("k", "NAME=VALUES"), ("k=", "NAME=VALUES"), ("=1,2", "NAME=VALUES"),
        ("k=1,,2", "empty"), ("k=5,5", "twice"), ("k=0..10:log:3", "above 0"),
        ("k=1..2:1", "2 to"), ("k=a..b:3", "are numbers"), ("k=1..inf:3", "finite"),
    ],
)  # fmt: skip
def test_bad_axes_are_told(text, fault):
    with pytest.raises(UsageError, match=fault):
        parse_axis(text)


def test_laws_have_gains_of_their_own():
    assert parse_texts("controller", "hinf, p(k=5),p(k=20)") == ["hinf", "p(k=5)", "p(k=20)"]
    assert split_law("lqr(Q=1,1,4,R=0.01)") == ("lqr", {"Q": "1,1,4", "R": 0.01})
    assert split_law("my.py:law(k=5..20@10%)") == ("my.py:law", {"k": "5..20@10%"})
    for wrong in ("p(k=5", "p(k)", "p(k=5)x", "p,p", "", "p,,q"):
        with pytest.raises(UsageError):
            parse_texts("controller", wrong)
    for wrong in ("a,,b", "a,a", "", [], 3, [3]):
        with pytest.raises(UsageError):
            parse_texts("robot", wrong)


def test_plants_have_values_of_their_own():
    both = ["stiff", "compliant(frequency=60,damping=1)"]
    assert parse_texts("plant", ",".join(both)) == both
    written = "compliant:frequency=60,damping=1,stiff,compliant:gravity=0"
    listed = ["compliant:frequency=60,damping=1", "stiff", "compliant:gravity=0"]
    assert parse_texts("plant", written) == listed
    made = with_choice(make_settings(), {"plant": both[1]})
    assert made.plant == "compliant:frequency=60,damping=1"


def test_disturbances_are_alternatives():
    text = "none,payload(2),payload(2)+twist(sine,x=1e+0)"
    assert parse_texts("disturb", text) == ["none", "payload(2)", "payload(2)+twist(sine,x=1e+0)"]
    base = make_settings(disturb="latency=1")
    latency, payload = {"latency": {"": 1.0}}, {"payload": {"": 2.0}}
    assert with_choice(base, {"disturb": "none"}).disturb == latency
    assert with_choice(base, {"disturb": "payload(2)"}).disturb == {**latency, **payload}
    both = with_choice(make_settings(), {"disturb": "payload(2)+twist(sine,x=1e+0)"}).disturb
    assert both == {**payload, "twist": {"": "sine", "x": 1.0}}
    with pytest.raises(UsageError, match="is not NAME=VALUE"):
        with_choice(base, {"disturb": "payload"})


def test_choices_go_where_they_belong():
    base = make_settings(gains={"a": 1.0}, disturb={"twist": {"form": "sine", "x": 0.1}})
    made = with_choice(
        base,
        {"controller": "p(k=5)", "plant": "ideal", "disturb.twist.frequency": "3", "seed": "7",
         "b": "[1,2]", "gain.plant": "4"},
    )  # fmt: skip
    assert made.controller == "p"
    assert made.gains == {"a": 1.0, "k": 5.0, "b": "1,2", "plant": 4.0}
    assert made.plant == "ideal"
    assert made.seed == 7
    assert made.disturb == {"twist": {"form": "sine", "x": 0.1, "frequency": 3.0}}
    assert base.disturb["twist"] == {"form": "sine", "x": 0.1}
    bare = make_settings()
    assert with_choice(bare, {"disturb.twist.x": "0"}).disturb == {}
    both = {"disturb.twist.x": "0", "disturb.twist.y": "0.1"}
    assert with_choice(bare, both).disturb == {"twist": {"y": 0.1}}
    with pytest.raises(UsageError, match=r"disturb\.NAME\.VALUE"):
        with_choice(base, {"disturb.twist": "1"})
    with pytest.raises(UsageError, match="seed"):
        with_choice(base, {"seed": "-1"})


def test_the_last_axis_runs_fastest():
    axes = [parse_axis("a=1,2"), parse_axis("b=x,y")]
    found = [(c["a"], c["b"]) for c in combinations(axes)]
    assert found == [("1", "x"), ("1", "y"), ("2", "x"), ("2", "y")]


def test_an_axis_says_its_unit():
    base = make_settings(controller="lqr")
    assert axis_label("k", make_settings(controller="p")) == "k [1/s]"
    assert axis_label("gain.r", base) == "gain.r [s^2]"
    assert axis_label("q", base) == "q"  # a weight has none
    assert axis_label("disturb.twist.wx", base) == "disturb.twist.wx [rad/s]"
    assert axis_label("disturb.payload.mass", base) == "disturb.payload.mass [kg]"
    assert axis_label("disturb.latency.periods", base) == "disturb.latency.periods"
    assert axis_label("plant", base) == "plant"
    assert axis_description("k", make_settings(controller="p")).startswith("1/s, the rate")
    assert axis_description("nothing", base) == ""

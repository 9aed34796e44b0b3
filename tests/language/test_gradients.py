"""Gradients through several colours, and round the hues: where each colour is."""

import colorsys

import numpy as np
import pytest

from dqpaint.language import ScriptError, parse
from dqpaint.language.writing.formatter import formatted
from dqpaint.motion import plan
from dqpaint.outputs.robot.light_cues import cue_sheet
from dqpaint.program import Light, colours

IDENTITY = np.array([1.0, 0, 0, 0, 0, 0, 0, 0])
RED, LIME, BLUE = (1.0, 0.0, 0.0), (0.0, 1.0, 0.0), (0.0, 0.0, 1.0)


def light(clause: str) -> Light:
    (segment,) = parse(f"line by (60, 0) mm light {clause}", "a.traj").segments
    assert segment.light is not None
    return segment.light


def test_several_colours_are_evenly_apart() -> None:
    made = light("red to lime to blue 50%")
    assert (made.at(0.0), made.at(0.5), made.at(1.0)) == (RED, LIME, (0.0, 0.0, 0.5))
    assert made.at(0.25) == pytest.approx((0.5, 0.5, 0.0))
    part = made.part(0.25, 0.75)
    for share in (0.0, 0.3, 0.5, 0.9, 1.0):
        assert part.at(share) == pytest.approx(made.at(0.25 + 0.5 * share))


@pytest.mark.parametrize(("way", "turn"), [("hue", -1 / 3), ("hue long", 2 / 3)])
def test_the_way_round_the_hues(way: str, turn: float) -> None:
    made = light(f"red to blue {way}")
    assert (made.first, made.last) == (RED, BLUE)
    for share in (0.25, 0.5, 0.75):
        encoded = colorsys.hsv_to_rgb((share * turn) % 1.0, 1.0, 1.0)
        assert made.at(share) == pytest.approx([colours.linear(c) for c in encoded], abs=1e-12)


def test_a_grey_has_the_hue_of_the_other_colour() -> None:
    middle = light("white to red hue").at(0.5)
    assert middle == pytest.approx([1.0, colours.linear(0.5), colours.linear(0.5)])


def test_the_rainbow_is_all_hues_and_a_name_of_the_file_is_its_own() -> None:
    hues = [colours.to_hsv(light("rainbow").at(share))[0] for share in np.linspace(0, 1, 25)]
    assert np.diff(hues).min() > 0.0
    assert hues[-1] == pytest.approx(280 / 360)
    (segment,) = parse("let rainbow = blue\nline by (9, 0) mm light rainbow", "a.traj").segments
    assert segment.light == Light(BLUE, BLUE)


def test_legs_strokes_and_letters_share_it_by_length() -> None:
    first, last = parse("line by (30, 0) mm by (0, 60) mm light red to lime to blue").segments
    assert first.light is not None
    assert last.light is not None
    assert first.light.last == last.light.first == pytest.approx((1 / 3, 2 / 3, 0.0))
    assert last.light.between == ((pytest.approx(0.25), LIME),)
    assert light("red to lime to blue").dimmed(0.5).at(0.5) == (0.0, 0.5, 0.0)


def test_what_shone_shines_again_with_all_its_colours() -> None:
    text = "light red to lime to blue\nline by (9, 0) mm light off\nline by (9, 0) mm light on 50%"
    again = parse(text, "a.traj").segments[-1].light
    assert again == light("red 50% to lime 50% to blue 50%")


def energy(text: str) -> np.ndarray:
    """The mean colour of a drawing, by the rows of its motion."""
    motion = plan(parse(f"profile constant\nperiod 1 ms\n{text}", "a.traj"), IDENTITY)
    return np.asarray(motion.light[:-1].mean(axis=0))


def test_motions_shine_with_the_integral_of_the_colours() -> None:
    """By the trapezium of the stops: red and blue a quarter of the way, lime half of it."""
    one = "line by (60, 0) mm in 1 s light red to lime to blue"
    many = "stroke in 1 s light red to lime to blue\n{}end".format("line by (7, 0) mm\n" * 9)
    for text in (one, many):
        np.testing.assert_allclose(energy(text), (0.25, 0.5, 0.25), atol=2e-3)


def test_a_step_across_a_joint_has_the_mean_of_its_colours() -> None:
    """Seven steps, each across joints of nine lines, by a fine sum over the way."""
    lines = "line by (7, 0) mm\n" * 9
    text = (
        f"profile constant\nperiod 100 ms\nstroke samples 7 light red to lime to blue\n{lines}end"
    )
    motion = plan(parse(text, "a.traj"), IDENTITY)
    share = (np.arange(70_000) + 0.5) / 70_000
    fine = np.array([np.interp(share, (0, 0.5, 1), stops) for stops in np.eye(3)])
    means = fine.reshape(3, 7, -1).mean(axis=2).T
    np.testing.assert_allclose(motion.light[:-1], means, atol=1e-8)


@pytest.mark.parametrize("bend", ["t", "t^2/360 deg"])
def test_the_colour_of_a_curve_is_a_formula_of_its_parameter(bend: str) -> None:
    """Where the light is tells the parameter: on a circle, the angle, however fast it is run."""
    text = f"curve polar(40 mm, {bend}) for t from 10 deg to 350 deg light hsv(t, 1, 0.5)"
    motion = plan(parse(f"period 1 ms\n{text}", "a.traj"), IDENTITY)
    lit = motion.lit[:-1]
    x, y = (0.5 * (motion.points[1:] + motion.points[:-1]))[lit].T[:2]
    angle = np.arctan2(y, x) % (2 * np.pi)
    t = angle if bend == "t" else np.sqrt(angle * 2 * np.pi)
    wanted = [[colours.linear(c) for c in colorsys.hsv_to_rgb(h / 2 / np.pi, 1, 0.5)] for h in t]
    np.testing.assert_allclose(motion.light[:-1][lit], wanted, atol=4e-3)
    again = parse(f"{text}\nline by (1, 0) mm light on", "a.traj").segments
    assert again[-1].light == again[1].light


def test_fast_colours_are_as_close_as_need_be() -> None:
    text = "curve (t*1 mm, 0, 0) for t from 0 to 60 light rgb(0.5+0.5*sin(3*t*rad), 0, 0) even"
    (segment,) = parse(text, "a.traj").segments
    assert segment.light is not None
    assert segment.light.even
    for share in np.linspace(0, 1, 333):
        red = colours.linear(0.5 + 0.5 * np.sin(180 * share))
        assert segment.light.at(share)[0] == pytest.approx(red, abs=4e-3)


def test_one_colour_has_no_way() -> None:
    with pytest.raises(ScriptError) as caught:
        parse("line by (9, 0) mm light red hue", "a.traj")
    assert caught.value.diagnostics[0].code == "E109"


def test_a_lamp_that_is_cued_shows_the_colour_of_the_way() -> None:
    text = "profile constant\nline by (60, 0) mm speed 60 mm/s light red to lime to blue"
    rows = cue_sheet(plan(parse(text, "a.traj"), IDENTITY), ()).splitlines()
    s, *rgb = np.array([row.split(",")[1:5] for row in rows if row[0].isdigit()], dtype=float).T[:4]
    near = np.array([np.interp(s + 0.24e-3, (0, 0.03, 0.06), stops) for stops in np.eye(3)])
    np.testing.assert_allclose(np.array(rgb)[:, :-1], near[:, :-1], atol=0.02)


@pytest.mark.parametrize("way", ["", " hue", " hue long", " hue long even"])
def test_the_formatter_keeps_the_way(way: str) -> None:
    text = f"line by (9, 0) mm light   red 50%  to lime to blue{way.replace(' ', '  ')}"
    assert formatted(text) == f"line by (9, 0) mm light red 50% to lime to blue{way}\n"
    assert parse(formatted(text)).segments[0].light == parse(text).segments[0].light

"""Functions, defs, frames: what they mean, what they know, and that they end."""

import numpy as np
import pytest

from dqpaint.language import ScriptError, parse
from dqpaint.program.taylor import Taylor
from tests.support.drawn import drawn, last, only
from tests.support.work import Calls
from tests.support.wrong_drawings import found


def place(text):
    return last(text).end.position


def test_a_function_is_its_formula():
    assert place("let f(x, k) = k*x^2*mm\nline by (f(3, 2), f(2, 1))") == pytest.approx(
        (0.018, 0.004, 0)
    )
    assert place("let p(t) = polar(2 mm, t)\nline to p(90 deg)") == pytest.approx((0, 0.002, 0))
    assert place("let g() = 3 mm\nline by (g(), 0)") == pytest.approx((0.003, 0, 0))
    two = "let f(a) = 2*a\nlet g(a, b) = f(a) + f(f(b))\nline by (g(1, 2)*mm, 0)"
    assert place(two) == pytest.approx((0.010, 0, 0))


def test_a_function_knows_what_was_known_at_its_place():
    text = "let r = 3 mm\nlet f(k) = k*r\nrepeat i from 1 to 2\nlet q = f(i)\nline by (q, 0)\nend"
    assert [s.end.position[0] for s in drawn(text).segments] == pytest.approx([0.003, 0.009])
    text = "let r = 3 mm\nlet f(r) = 2*r\nline by (f(5 mm), r)"
    assert place(text) == pytest.approx((0.010, 0.003, 0))


def test_functions_within_curves_have_their_exact_derivatives():
    text = "let f(x) = sin(x)*x/rad\nlet g(x) = f(2*x)\n"
    text += "curve (g(t), f(t), t/rad) mm for t from 0 to 2 rad"
    t = np.linspace(0.1, 1.9, 7)
    x, y, _ = only(text).path.formula(Taylor.variable(t))
    f = [t * np.sin(t), np.sin(t) + t * np.cos(t), 2 * np.cos(t) - t * np.sin(t)]
    u = 2 * t
    g = [u * np.sin(u), 2 * (np.sin(u) + u * np.cos(u)), 4 * (2 * np.cos(u) - u * np.sin(u))]
    for k in range(3):
        np.testing.assert_allclose(y.derivatives[k], 1e-3 * f[k], atol=1e-15)
        np.testing.assert_allclose(x.derivatives[k], 1e-3 * g[k], atol=1e-15)


def test_a_def_is_its_lines_where_it_is_called():
    text = """
let r = 10 mm
def star(size, n)
  let a = 360 deg/n
  move by (size, 0)
  repeat k from 1 to n
    line by polar(size, k*a) light hsv(k*a)
  end
end
star(r, 3)
with shift (50, 0) mm rotate 90 deg
  star(2*r, 4)
end
"""
    written = """
let r = 10 mm
move by (r, 0)
repeat k from 1 to 3
  line by polar(r, k*120 deg) light hsv(k*120 deg)
end
with shift (50, 0) mm rotate 90 deg
  move by (2*r, 0)
  repeat k from 1 to 4
    line by polar(2*r, k*90 deg) light hsv(k*90 deg)
  end
end
"""
    mine, plain = drawn(text).segments, drawn(written).segments
    assert len(mine) == len(plain) == 8
    for a, b in zip(mine, plain, strict=True):
        assert a.end.position == pytest.approx(b.end.position, abs=1e-15)
        assert a.light == b.light
    assert {s.line.line for s in mine} == {5, 7}


def test_settings_in_a_def_hold_for_its_lines():
    text = "def f()\nspeed 5 mm/s\nlight red\nline by (1, 0) mm\nend\nf()\nline by (1, 0) mm\nf"
    a, b = drawn(text.removesuffix("\nf")).segments
    assert (a.timing.speed, b.timing.speed) == pytest.approx((0.005, 0.1))
    assert (a.light.first, b.light.first) == ((1, 0, 0), (1, 1, 1))


def test_defs_call_those_before_them_and_hide_their_names():
    text = "def a(n)\nline by (n*mm, 0)\nend\ndef b(n)\nlet q = n + 1\na(n)\na(q)\nend\n"
    text += "b(1)\nb(5)\nlet q = 3"
    assert [s.end.position[0] for s in drawn(text).segments] == pytest.approx(
        [0.001, 0.003, 0.008, 0.014]
    )


def test_a_mistake_in_a_def_shows_the_calls_that_led_there():
    text = "def a(n)\nline by (n, 0)\nend\ndef b(n)\na(n)\nend\nb(5)\nb(6)"
    with pytest.raises(ScriptError) as caught:
        parse(text, "a.traj")
    (found,) = caught.value.diagnostics
    assert (found.code, found.span.text_in(text)) == ("E218", "(n, 0)")
    assert [span.text_in(text) for span, _ in found.related] == ["a(n)", "b(5)"]
    assert "= called from: a.traj:5:1\n" in str(caught.value)


def test_a_frame_is_a_place_and_a_turn_wherever_it_is_used():
    text = "frame leaf at (30, 5) mm turned 90 deg\n{}\nline to (10, 0) mm\nend"
    assert place(text.format("with frame leaf")) == pytest.approx((0.03, 0.015, 0))
    assert place(text.format("with rotate 90 deg frame leaf")) == pytest.approx((-0.015, 0.03, 0))
    assert place(text.format("with frame leaf shift (1, 0) mm scale 2")) == pytest.approx(
        (0.03, 0.026, 0)
    )
    text = "frame board turned rpy(90 deg, 0, 0)\nwith frame board\nline to (0, 3) mm\nend"
    assert place(text) == pytest.approx((0, 0, 0.003), abs=1e-15)


@pytest.mark.parametrize(("radius", "to", "words", "centre", "degrees"), [
    ("5 mm", "(6, 0) mm", "left", (3, 4), 73.7398),
    ("5 mm", "(6, 0) mm", "right", (3, -4), -73.7398),
    ("5 mm", "(6, 0) mm", "left long", (3, -4), 286.2602),
    ("5 mm", "(6, 0) mm", "right long", (3, 4), -286.2602),
    ("3 mm", "(6, 0) mm", "left", (3, 0), 180),
    ("3 mm", "(6, 0) mm", "right long", (3, 0), -180),
])  # fmt: skip
def test_an_arc_with_a_radius(radius, to, words, centre, degrees):
    """`left` is against the clock: seen from +z the way bends to the left."""
    arc = only(f"arc radius {radius} to {to} {words}")
    assert np.array(arc.path.centre) == pytest.approx(np.array([*centre, 0]) * 1e-3, abs=1e-9)
    assert np.degrees(arc.path.angle) * arc.path.axis[2] == pytest.approx(degrees, abs=1e-3)
    assert arc.end.position == pytest.approx((0.006, 0, 0), abs=1e-12)
    turned = only(f"with rotate rot(x, 90 deg)\narc radius {radius} to {to} {words}\nend")
    assert turned.path.axis == pytest.approx((0, -arc.path.axis[2], 0), abs=1e-12)
    about = only(f"arc radius {radius} to (0, 6, 0) mm axis x {words}")
    assert about.end.position == pytest.approx((0, 0.006, 0), abs=1e-12)


@pytest.mark.slow
@pytest.mark.parametrize("text", [
    "def a0()\nhold 1 s\nend\n"
    + "".join(f"def a{i}()\na{i - 1}()\na{i - 1}()\nend\n" for i in range(1, 40)) + "a39()",
    "def a(n)\nrepeat n\nrepeat n\nrepeat n\nlet q = 1\nend\nend\nend\nend\na(9999)",
    "let f0(a) = a\n" + "".join(f"let f{i}(a) = f{i - 1}(a) + f{i - 1}(a)\n" for i in range(1, 30))
    + "curve (f29(t), 0, t) for t from 0 to 1 mm",
    "let f(a) = " + "+".join(["a"] * 5000) + "\nlet g(a) = " + "+".join(["f(a)"] * 5000)
    + "\nline by (g(1)*mm, 0)",
    "let f(a) = a\nline by (" + "f(" * 60 + "1" + ")" * 60 + "*mm, 0)",
    "let f(a) = " + "(" * 60 + "a" + ")" * 60 + "\n"
    + "line by (" + "f(" * 60 + "1" + ")" * 60 + "*mm, 0)",
    "def a(n)\n" + "with rotate 1 deg\n" * 30 + "line by (n, 0)\n" + "end\n" * 31
    + "with rotate 1 deg\n" * 30 + "a(" + "(" * 60 + "1 mm" + ")" * 60 + ")\n" + "end\n" * 30,
], ids=["calls", "repeats", "formulas", "curve", "values", "deep", "blocks"])  # fmt: skip
def test_whatever_calls_whatever_it_ends(text):
    with Calls(30_000_000):  # 14 of them are needed where a curve is drawn
        assert {d.code for d in found(text)} <= {"E304", "E308", "E309", "E127"}


@pytest.mark.slow
def test_ten_thousand_calls_are_quick():
    text = "let k = 2\ndef a(n)\nlet q = k*n\nmove by (q, 0)\nend\nrepeat 10000\na(1 mm)\nend"
    with Calls(3_000_000):  # twice what is needed
        assert len(drawn(text).segments) >= 9_999

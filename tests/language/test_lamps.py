"""What shines: brush, strobe, even light, the light of strokes."""

import pytest

from dqpaint.program.program import Brush, Light, Strobe
from tests.support.drawn import drawn, last, only

RED, BLUE, WHITE = (1.0, 0.0, 0.0), (0.0, 0.0, 1.0), (1.0, 1.0, 1.0)


@pytest.mark.parametrize(("words", "brush"), [
    ("brush point", Brush()),
    ("brush point 3 mm", Brush("ball", (("size", 0.003),))),
    ("brush bar 120 mm", Brush("bar", (("length", 0.12),), True)),
    ("brush bar 12 cm along y", Brush("bar", (("length", 0.12), ("along", (0, 1, 0))), True)),
    (
        "brush bar along (0, 3, -4) length 12 cm",
        Brush("bar", (("length", 0.12), ("along", (0, 0.6, -0.8))), True),
    ),
])  # fmt: skip
def test_brushes_as_setting_as_clause_and_in_a_block(words, brush):
    line = "line by (9, 0) mm"
    assert only(f"{words}\n{line}").brush == brush
    first, second = drawn(f"{line} {words} speed 5 mm/s\n{line}").segments
    assert (first.brush, second.brush) == (brush, Brush())
    assert first.timing.speed == pytest.approx(0.005)
    block = drawn(f"with {words} scale 2 rotate 90 deg\n{line}\nend\n{line}").segments
    assert [s.brush for s in block] == [brush, Brush()]  # a lamp is a thing: it is not scaled
    assert last(f"{line}\nhold 1 s {words}").brush == brush


def test_words_of_arcs_may_be_names():
    text = "let radius = 3 mm\nlet left = 9 mm\nbrush bar radius\n"
    segment = only(f"{text}arc radius radius to (left/2, 0) left")
    assert segment.brush == Brush("bar", (("length", 0.003),), True)
    assert segment.end.position == pytest.approx((0.0045, 0, 0))


@pytest.mark.parametrize(("words", "strobe"), [
    ("strobe 10 Hz", Strobe(10.0, 0.5)),
    ("strobe 10 Hz 30%", Strobe(10.0, pytest.approx(0.3))),
    ("strobe 3/s 100%", Strobe(3.0, 1.0)),
    ("strobe 1/(20 ms) 5%", Strobe(pytest.approx(50), pytest.approx(0.05))),
    ("strobe off", None),
])  # fmt: skip
def test_strobes(words, strobe):
    line = "line by (9, 0) mm"
    assert only(f"{words}\n{line}").strobe == strobe
    block = drawn(
        f"strobe 7 Hz\n{line} {words}\n{line}\nwith {words}\n{line}\nend\n{line}"
    ).segments
    assert [s.strobe for s in block] == [strobe, Strobe(7.0), strobe, Strobe(7.0)]


@pytest.mark.parametrize(("words", "light"), [
    ("light red even", Light(RED, RED, True)),
    ("light red to blue even", Light(RED, BLUE, True)),
    ("light red 50% even", Light((0.5, 0, 0), (0.5, 0, 0), True)),
    ("light red even\nlight off\nlight on", Light(RED, RED, True)),
    ("light red even\nlight on 50%", Light((0.5, 0, 0), (0.5, 0, 0), True)),
    ("light red even\nlight blue", Light(BLUE, BLUE)),
    ("light on even", Light(WHITE, WHITE, True)),
    ("light off even", None),
])  # fmt: skip
def test_even_light(words, light):
    assert last(f"{words}\nline by (9, 0) mm").light == light


def test_an_even_gradient_stays_even_on_every_leg():
    a, b = drawn("line by (1, 0) mm by (3, 0) mm light red to blue even").segments
    assert a.light == Light(RED, pytest.approx((0.75, 0, 0.25)), True)
    assert b.light == Light(pytest.approx((0.75, 0, 0.25)), BLUE, True)


def test_a_stroke_s_gradient_is_carried_whole():
    text = (
        "corner jump\nstroke light red to blue\nline by (1, 0) mm by (3, 0) mm\nline by (0, 1) mm"
    )
    a, b, c = drawn(f"{text} light white\nend").segments
    assert a.light == b.light == a.stroke.light == Light(RED, BLUE)
    assert c.light == Light(WHITE, WHITE)
    assert a.stroke == b.stroke == c.stroke
    a, b = drawn(
        "corner jump\nlight red to blue\nstroke\nline by (1, 0) mm\nline by (1, 0) mm\nend"
    ).segments
    assert a.stroke.light is None  # a setting is of each line, as ever
    assert a.light == b.light == Light(RED, BLUE)


def test_even_light_waits_in_the_dark():
    assert last("light red even\nline by (1, 0) mm\nhold 1 s").light is None
    assert last("light red\nline by (1, 0) mm\nhold 1 s").light == Light(RED, RED)

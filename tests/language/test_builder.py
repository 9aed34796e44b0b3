"""Drawings from Python: the same text, the same motion, the same errors."""

import math
import re
from operator import attrgetter

import numpy as np
import pytest

import dqpaint
from dqpaint.core.examples import find_drawing
from dqpaint.errors import UsageError
from dqpaint.language import parse, read
from dqpaint.language.vocabulary.words import PARTS, STATEMENTS
from dqpaint.language.writing.builder import METHODS, Drawing, DrawingError, example_call, quoted
from dqpaint.language.writing.formatter import formatted
from dqpaint.motion import plan
from dqpaint.robots.model.card import read_card

CANVAS = read_card("iiwa").canvas.pose
WORDS = [word for word in STATEMENTS if word != "end"]
METHOD = {word: method for method, word in METHODS.items()}


def motion(program):
    return plan(program, CANVAS)


def star():
    d = Drawing("star", period=0.01, speed=0.06)
    r = 0.08
    d.move(to=(r * math.cos(math.pi / 2), r * math.sin(math.pi / 2)))
    for i in range(1, 6):
        angle = math.radians(90 + i * 144)
        d.line(to=(r * math.cos(angle), r * math.sin(angle)), light=f"hsv({i * 72} deg)")
    return d


def test_a_computed_star_is_the_written_star():
    built, written = motion(star().program()), motion(read(find_drawing("star")))
    assert built.pose == pytest.approx(written.pose, abs=1e-12)
    assert built.twist == pytest.approx(written.twist, abs=1e-12)
    assert np.array_equal(built.light, written.light)


def test_the_place_may_be_left_to_the_arm():
    drawing = Drawing()
    drawing.robot("iiwa")
    drawing.place("auto")
    drawing.line(to=(0.01, 0))
    assert "place auto" in str(drawing).splitlines()
    drawing.place("auto", at=(0.6, 0, 0.5))
    with pytest.raises(DrawingError, match="takes no 'at'"):
        drawing.program()


def rich():
    d = Drawing(period=0.008)
    d.comment("all sorts\n\nof things")
    d.robot("iiwa")
    d.place(at=(0.6, 0.1, 0.5), turned=[1, 0, 0, 0])
    d.let("r", "40 mm")
    d.let("n", 3)
    d.speed(1 / 30)
    d.light("#ff8800")
    d.start(at=np.array([1 / 3, -0.1, 1e-7]) / 7, tool=(0.5, 0.5, -0.5, 0.5))
    d.line(to=[(0.01, 0.02), np.float64([0.03, 0.04, -0.001])], by=(1e-3, 0), in_=np.pi)
    for angle in np.linspace(0.1, 1.3, 4):
        with d.block(rotate=angle, shift=(0.01, 0), light=("red", "hsv(30 deg) 40%")):
            d.arc(via=(0.02, 0.01), to=(0.03, 0), samples=40)
            d.curve("polar(r, t)", "t", 0, "90 deg", tool="follow", profile="cubic(0, 0)")
    with d.repeat("i", 1, 3), d.block(scale=0.5), d.repeat(2):
        d.line(by=("i*mm", "n*mm"))
        d.line(by=("2*r", 0.01))
    d.screw(about=(0, 0), along=(0, 0, 1), angle=-math.pi / 3, pitch=0.05 / math.tau)
    d.step(to=(0, 0), light="off")
    d.hold(0.5, light=("white", "off"))
    return d


def test_written_and_read_again_it_is_the_same_to_the_last_bit():
    drawing = rich()
    text = str(drawing)
    assert formatted(text) == text
    asked, again = motion(drawing.program()), motion(parse(text))
    for kind in ("t", "pose", "twist", "acceleration", "light", "source.line"):
        read = attrgetter(kind)
        assert np.array_equal(read(asked), read(again)), kind
    legs = asked.program.segments[:3]
    assert legs[0].start.position == tuple((np.array([1 / 3, -0.1, 1e-7]) / 7).tolist())
    assert sum(leg.timing.seconds for leg in legs) == pytest.approx(np.pi, rel=1e-12)


def test_numbers_are_si_units():
    d = Drawing(period=0.004, turnspeed=math.radians(50))
    d.start(at=(0.01, 0.02))
    d.screw(about=(0, 0), along=(0, 0, 1), angle=math.radians(70), pitch=0.03 / math.tau, in_=2)
    d.arc(centre=(0, 0), angle=-1, rise=0.01, grow=0.005, speed=0.05)
    with d.block(rotate=0.5, scale=0.5):
        d.line(to=(0.03, 0), tool="rpy(0, 0, 1 rad)", samples=300)
    d.line(by=(0, 0), tool="rpy(0, 0, 2 rad)")
    d.hold(0.25)
    text = """period 4 ms
turnspeed 50 deg/s
start at (10, 20) mm
screw about (0, 0) along z angle 70 deg pitch 30 mm/turn in 2000 ms
arc centre (0, 0) angle -1 rad rise 1 cm grow 5 mm speed 5 cm/s
with rotate 0.5 rad scale 0.5
line to (30, 0) mm tool rpy(0, 0, 1 rad) samples 300
end
line by (0, 0) tool rpy(0, 0, 2 rad)
hold 250 ms
"""
    built, written = motion(d.program()), motion(parse(text))
    assert built.t == pytest.approx(written.t, abs=1e-9)
    assert built.pose == pytest.approx(written.pose, abs=1e-12)
    assert built.acceleration == pytest.approx(written.acceleration, abs=1e-9)


def test_numbers_are_written_so_that_they_come_back(rng):
    for value in [*rng.normal(size=50) * 10.0 ** rng.integers(-12, 3, 50), 0.0, -0.0, 1.0, 1e-300]:
        d = Drawing()
        d.move(to=(value, -value))
        d.line(by=(0.1, 0))
        assert d.program().start.position[:2] == (value, -value)


@pytest.mark.parametrize("word", WORDS)
def test_every_statement_is_a_method_that_writes_its_example(word):
    known, d = STATEMENTS[word], Drawing()
    rest = known.example.removeprefix(word).strip()
    assert getattr(d, METHOD[word]).__doc__.startswith(known.meaning[0].upper())
    if known.head:
        head = rest
        for part in known.parts:  # what stands after the head is parts
            head = re.split(rf" {part} ", head)[0]
        rest = rest.removeprefix(head).strip()
        getattr(d, METHOD[word])(head)
        assert d._lines[0] == f"{word} {head}"
    else:
        parts = {}
        for part, value in split(rest, known.parts):
            parts[f"{part}_"] = value
        getattr(d, METHOD[word])(**parts)
        assert d._lines[0] == known.example


def split(text, parts):
    """The parts of an example line and their values."""
    found = re.split(rf"(?:^| )({'|'.join(parts)}) ", text)[1:]
    return zip(found[::2], found[1::2], strict=True)


@pytest.mark.parametrize(("word", "part"), [(w, p) for w in WORDS for p in STATEMENTS[w].parts])
def test_every_part_is_a_keyword(word, part):
    d, known = Drawing(), STATEMENTS[word]
    flag = PARTS[part].takes == "flag"
    value = True if flag else PARTS[part].example.removeprefix(part).strip()
    head = [known.example.removeprefix(word).strip()] if known.head else []
    getattr(d, METHOD[word])(*head, **{f"{part}_" if part == "in" else part: value})
    assert d._lines[0].endswith(f" {PARTS[part].example}")


def test_no_statement_hides_a_method():
    own = {name for name in vars(Drawing) if not name.startswith("_")} | {"name"}
    assert not own & set(METHODS)
    assert set(METHODS) <= set(dir(Drawing()))


def test_errors_say_which_call():
    d = Drawing("wave")
    d.speed("40 mm")
    d.hold(1)

    def deeper():
        d.line(to=(0.1, 0), profile="fancy")  # here

    deeper()
    with pytest.raises(DrawingError) as caught:
        d.program()
    text = str(caught.value)
    assert "error[E218]: 'speed' needs a speed, but this is a length\n --> wave:1:7" in text
    assert re.search(
        r"= help: write 40 mm/s\n  = call: test_builder.py:\d+, in test_errors_say", text
    )
    (call,) = re.findall(r"call: test_builder.py:(\d+), in deeper", text)
    with open(__file__, encoding="utf-8") as source:
        assert source.readlines()[int(call) - 1].endswith("# here\n")


@pytest.mark.slow
def test_errors_of_motion_and_reach_say_it_too():
    d = Drawing()
    d.line(to=(0.1, 0), speed=1e-12)
    with pytest.raises(DrawingError, match=r"E302.*\n(.*\n)*.*call: test_builder\.py"):
        dqpaint.preview(d)
    d = Drawing()
    d.line(to=(2, 0))
    with pytest.raises(DrawingError, match=r"E310.*\n(.*\n)*.*call: test_builder\.py"):
        dqpaint.draw(d, plant="ideal", size=(64, 36))


@pytest.mark.parametrize(("call", "says"), [
    (lambda d: d.line(too=(1, 0)), "line: .*'too'"),
    (lambda d: d.line(to=(1, 2, 3, 4)), r"line: to: \(1, 2, 3, 4\)"),
    (lambda d: d.line(to=(math.nan, 0)), "nan"),
    (lambda d: d.line(to=("1 # 2", 0)), "'1 # 2'"),
    (lambda d: d.line(to=(None, 0)), "0 alone|None"),
    (lambda d: d.line((1, 0)), "without a name; .*d.line"),
    (lambda d: d.hold(math.inf), "hold: inf"),
    (lambda d: d.hold(True), "hold: True"),
    (lambda d: d.hold("1 s # off"), "1 s # off"),
    (lambda d: d.hold("1 s\nhold 2 s"), "hold 2 s"),
    (lambda d: d.hold(), 'missing; .*d.hold\\("1 s"\\)'),
    (lambda d: d.hold(1, 2), "2 values .*d.hold"),
    (lambda d: d.repeat("i", 1), "2 values .*d.repeat"),
    (lambda d: d.tool(5), "tool: 5 .*d.tool"),
    (lambda d: d.line(to=None), "to: None .*to="),
    (lambda d: d.line(to=(1, 0), brush=3), 'for example: brush="bar 120 mm along x"'),
    (lambda d: d.curve("t", t=(0, 1)), "'t'.*d.curve"),
    (lambda d: d.hold(1, light=quoted('r"d')), "quotes"),
    (lambda d: d.write("hold 1 s\nhold 1 s"), "one line"),
    (lambda d: Drawing(perod=1), "'perod'"),
])  # fmt: skip
def test_wrong_calls_are_told_where_they_are(call, says):
    with pytest.raises((UsageError, ValueError), match=says) as caught:
        call(Drawing())
    assert isinstance(caught.value, UsageError) or "quotes" in says
    with pytest.raises(AttributeError, match="a drawing has no 'lin'; it has: "):
        Drawing().lin(to=(1, 0))


def test_verbatim_lines_and_open_blocks():
    d = Drawing()
    with d.repeat(2):
        d.write("line   by (1, 0)mm")
        assert str(d) == "repeat 2\n  line by (1, 0) mm\nend\n"
    d.write("lin")
    with pytest.raises(DrawingError, match=r"call: test_builder\.py"):
        str(d)


def test_a_block_that_fails_is_closed():
    d = Drawing()

    def broken():
        with d.repeat(2):
            d.hold(1)
            d.line(nix=3)

    with pytest.raises(UsageError):
        broken()
    assert str(d) == "repeat 2\n  hold 1 s\nend\n"


@pytest.mark.slow
def test_draw_takes_a_drawing(tmp_path):
    painting = dqpaint.draw(star(), size=(64, 36), plant="ideal")
    assert painting.motion.program.name == "star"
    written = dqpaint.save(painting, tmp_path)
    assert sorted(path.name for path in written) == [
        "star-hinf.csv",
        "star-hinf.json",
        "star-hinf.png",
    ]
    assert dqpaint.preview(star(), size=(64, 36)).image.max() > 200


@pytest.mark.parametrize("word", WORDS)
def test_every_example_of_a_call_is_one(word):
    """What messages show can be typed, and writes the statement's own example."""
    for form in example_call(word).split(", or "):
        d = Drawing()
        block = eval(form, {"d": d})
        if block is not None:
            with block:
                pass
        line = str(d).split("\n")[0]
        assert line.split()[0] == word
        if ", or " not in example_call(word) and not STATEMENTS[word].block:
            assert line == formatted(STATEMENTS[word].example).strip()


def test_a_call_that_lacks_something_is_shown_how_it_goes():
    d = Drawing()
    d.curve("polar(1, t)")
    with pytest.raises(DrawingError) as caught:
        d.program()
    assert 'for example: d.curve("polar(40 mm, t)", "t", 0, "360 deg")' in str(caught.value)
    d = Drawing()
    with d.define("petal", "r"):
        d.line(by=("r", 0))
    with pytest.raises(AttributeError, match=r"d\.write"):
        d.petal(3)

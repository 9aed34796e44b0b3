"""Attributes of SVG, read by its grammar; transforms as another library multiplies them."""

import math
import random

import pytest
import svgelements

from dqpaint.language.imports.svg import values
from dqpaint.language.imports.svg.values import Length, UnreadableError


@pytest.mark.parametrize(
    "text",
    [
        "translate(3)",
        "translate(3-4)",
        "rotate(30 5,6) scale(2)",
        " matrix(1 2,3 4 5 6), skewX(30) skewY(-10) ",
        "scale(2,-1.5e-1)translate(1 2)",
    ],
)
def test_transforms_mean_the_same(text: str) -> None:
    wanted = svgelements.Matrix(text)
    assert values.transform(text) == pytest.approx([wanted[i] for i in range(6)], abs=1e-12)


def test_lists_of_transforms_too() -> None:
    chance = random.Random(2)
    counts = {"matrix": (6,), "translate": (1, 2), "scale": (1, 2), "rotate": (1, 3)}
    counts |= dict.fromkeys(
        ("translateX", "translateY", "scaleX", "scaleY", "skewX", "skewY"), (1,)
    )
    for _ in range(200):
        names = chance.choices(list(counts), k=chance.randint(1, 4))
        given = [[chance.uniform(-2, 2) for _ in range(chance.choice(counts[n]))] for n in names]
        text = ", ".join(
            f"{n}({' '.join(map(repr, g))})" for n, g in zip(names, given, strict=True)
        )
        one, two = (text.partition(")")[i] for i in (0, 2))  # the first, and those that stand in it
        outer, inner = values.transform(f"{one})"), values.transform(two)
        wanted = pytest.approx([svgelements.Matrix(text)[i] for i in range(6)], abs=1e-12)
        assert values.transform(text) == wanted
        assert values.times(outer, inner) == wanted


def test_units() -> None:
    for text, pixels in (
        ("7", 7), ("7px", 7), ("1in", 96), ("2.54cm", 96), ("25.4 mm".replace(" ", ""), 96),
        ("72pt", 96), ("6pc", 96), ("101.6Q", 96), (" -1e1 ", -10),
    ):  # fmt: skip
        assert values.length(text) == pytest.approx((pixels, 0))
    assert values.length("50%") == Length(percent=50.0)
    assert values.size_or_auto("auto") is None
    turned = values.transform("rotate(0.25turn) translate(1in, 2)")
    assert turned == pytest.approx((0, 1, -1, 0, -2, 96))
    quarter = values.transform("rotate(1.5707963267948966rad)")
    assert quarter == values.transform("rotate(90)") == values.transform("rotate(100grad)")
    for nothing in ("", " ", "none"):
        assert values.transform(nothing) == values.IDENTITY


@pytest.mark.parametrize(
    ("text", "made"),
    [
        ("red", "#ff0000ff"),
        ("#F80", "#ff8800ff"),
        ("#f808", "#ff880088"),
        ("#12345678", "#12345678"),
        ("rgb(255, 0, 128)", "#ff0080ff"),
        ("rgb(100% 0% 50% / 50%)", "#ff008080"),
        ("rgba(300,-5,0,.5)", "#ff000080"),
        ("hsl(120deg, 100%, 50%)", "#00ff00ff"),
        ("hsl(0.5turn 100% 50%)", "#00ffffff"),
    ],
)
def test_paints(text: str, made: str) -> None:
    assert values.paint(text) == bytes.fromhex(made[1:])


def test_paints_that_are_no_colours() -> None:
    assert values.paint("none") is values.paint("transparent") is None
    assert values.paint("CurrentColor") == values.CURRENT


def test_a_gradient_s_mean() -> None:
    red, blue = b"\xff\0\0\xff", b"\0\0\xff\0"
    assert values.mean([red, None, values.CURRENT, blue]) == b"\x80\0\x80\x80"
    assert values.mean([None]) == b"\0\0\0\xff"


@pytest.mark.parametrize(
    ("read", "text", "reason"),
    [
        (values.path, "L1 2", "it begins with 'L', not with M"),
        (values.path, "M0 0 X 5", "'X' stands where a number of its M is expected"),
        (values.path, "M0 0 Lnan 3", "'nan' stands where a number of its L is expected"),
        (values.path, "M0 0 L1 2 3", "its L needs numbers by 2, and has 3: 'L1 2 3'"),
        (values.path, "M0 0 H", "its H needs a number, and has 0: 'H'"),
        (values.path, "M0 0 L1,,2", "',2' stands where a number of its L is expected"),
        (values.path, "M0 0 L1 2,", "',' stands where a number of its L is expected"),
        (values.path, "M0 0 A5 5 0 0", "its A needs numbers by 7, and has 4: 'A5 5 0 0'"),
        (values.path, "M0 0 A5 5 0 2 0 1 1", "the flags of 'A5 5 0 2 0 1 1' are not 0 or 1"),
        (values.path, "M0 0 A5 1e-300 0 0 0 1 1",
         "the radius '1e-300' of its A is far too small"),
        (values.path, "M0 0 z 3", "'3' follows its z, which takes no numbers"),
        (values.path, "M0 0 L1e400 3", "'1e400' is far too large"),
        (values.points, "1,2 3", "it has 3 numbers, and points have two each"),
        (values.points, "1,2 three", "'three' stands where a number is expected"),
        (values.length, "nan", "'nan' is no length"),
        (values.length, "inf", "'inf' is no length"),
        (values.length, "3em", "the unit of '3em' is none of px, mm, cm, in, pt, pc, %"),
        (values.length, "1e8in", "'1e8in' is far too large"),
        (values.size, "-2", "'-2' is negative"),
        (values.view_box, "0 0 5", "it has 3 numbers instead of 4"),
        (values.view_box, "0 0 -5 5", "its size is negative: '0 0 -5 5'"),
        (values.transform, "rotate(x)", "'x' is no angle"),
        (values.transform, "rotate()", "rotate needs 1 or 3 numbers, and has 0"),
        (values.transform, "scale(1e400)", "'1e400' is far too large"),
        (values.transform, "spin(3)", "'spin' is none of matrix, translate, translateX, "
         "translateY, scale, scaleX, scaleY, rotate, skewX, skewY"),
        (values.transform, "scale(2", "'scale(2' is no transform"),
        (values.transform, "translate(5%)", "'5%' of what is not known"),
        (values.transform, "scale(1)" * 1001, "more than 1,000 transforms one after the other"),
        (values.paint, "blu", "'blu' is no colour"),
        (values.paint, "bad", "'bad' is no colour"),  # without its #
        (values.paint, "rgb(1, 2)", "'rgb(1, 2)' is no colour"),
        (values.paint, "rgb(a, 2, 3)", "'a' is no number"),
        (values.opacity, "half", "'half' is no number"),
    ],
)  # fmt: skip
def test_what_can_t_be_read(read, text: str, reason: str) -> None:
    with pytest.raises(UnreadableError) as caught:
        read(text)
    assert str(caught.value) == reason


def test_opacities_are_cut_off() -> None:
    assert [values.opacity(t) for t in ("2", "-1", "50%", "0.25")] == [1.0, 0.0, 0.5, 0.25]
    assert math.isclose(values.opacity("33.3%"), 0.333)


def test_a_long_path_that_is_wrong_at_its_end_is_answered_at_once() -> None:
    """No going back and forth over what was read."""
    for text in ("M" + "11" * 100_000 + "x", "M0 0A" + "1" * 100_000 + "x", "M" + "1 " * 99_999):
        with pytest.raises(UnreadableError):
            values.path(text)

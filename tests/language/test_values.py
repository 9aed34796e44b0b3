"""Expressions: units, precedence, functions, curves, colours."""

import colorsys
import math

import numpy as np
import pytest

from dqpaint.diagnostics.diagnostic import Span
from dqpaint.language import ScriptError, parse
from dqpaint.language.pen.durations import apportion
from dqpaint.language.vocabulary.units import NAMES, dimension_name
from dqpaint.program import colours
from dqpaint.program.program import Curve, Light, Profile, Samples
from dqpaint.program.taylor import Taylor
from tests.support.drawn import last, matrix, only, rotation


def length(expression: str) -> float:
    """The value of an expression that is a length [m]."""
    return only(f"line by ({expression}, 1 mm)").end.position[0]


@pytest.mark.parametrize(
    ("expression", "value"),
    [
        ("1 mm + 2 cm", 0.021),
        ("-2^2 * mm", -0.004),
        ("2^3^2 * mm", 0.512),
        ("(1 + 2) mm", 0.003),
        (".5 m - 1e-1 m", 0.4),
        ("2*3 mm", 0.006),
        ("6 mm / 2 / 3", 0.001),
        ("40 mm/s * 2 s", 0.08),
        ("9 mm^2 / mm", 0.081),  # a unit binds tightest: (9 mm)^2
        ("sqrt(9 mm*mm)", 0.003),
        ("150 mm/turn * 180 deg", 0.075),
        ("5 Hz * 2 s * mm", 0.01),
        ("sin(30 deg) * mm", 0.0005),
        ("cos(60°) * mm", 0.0005),
        ("tan(45 deg) * mm", 0.001),
        ("asin(1)/rad * mm", math.pi / 2000),
        ("acos(0)/deg * mm", 0.09),
        ("atan(1)/deg * mm", 0.045),
        ("exp(ln(3)) * mm", 0.003),
        ("abs(-3 mm) + min(4 mm, 2 mm, 9 mm) + max(0, 1 mm)", 0.006),
        ("2 turns / turn * mm", 0.002),
        ("pi * 1 mm", math.pi / 1000),
        ("(3 mm) ^ 2 / 1 mm", 9e-3),
        ("+5 mm", 0.005),
        ("--5 mm", 0.005),
        ("0 - 5 mm", -0.005),
        ("0 + 5 mm - 0", 0.005),
    ],
)
def test_numbers(expression: str, value: float) -> None:
    assert length(expression) == pytest.approx(value, rel=1e-12)


def test_brackets_go_over_lines_and_comments() -> None:
    text = "line by (1, # the first\n   2,\n\n 3\n) mm"
    assert only(text).end.position == pytest.approx((0.001, 0.002, 0.003))
    assert only(text).span == Span(0, 23)


def test_zero_needs_no_unit() -> None:
    assert only("let a = 0\nline to (a, 5 mm, 0*3)").end.position == (0, 0.005, 0)
    assert only("line by (0, 0) - z*mm").end.position == (0, 0, -0.001)
    assert only("line by z*mm - (0, 0)").end.position == (0, 0, 0.001)


def test_points() -> None:
    text = "let p = (1, 2, 3) mm\nline to 2*p - p/2 + polar(1 mm, 90 deg) + x*mm - (0, 0)"
    assert only(text).end.position == pytest.approx((0.0025, 0.004, 0.0045))


def test_orientations_multiply_like_matrices() -> None:
    segment = only("line by (1,0) mm tool rot(z, 90 deg) * rpy(30 deg, 0, 0) * quat(1, 0, 0, 0)")
    expected = rotation((0, 0, 1), 90) @ rotation((1, 0, 0), 30)
    assert matrix(segment.end.orientation) == pytest.approx(expected, abs=1e-15)


def test_profiles() -> None:
    profiles = {
        "cubic": Profile("cubic"),
        "cubic(1 mm/s, 2 mm/s)": Profile("cubic", (0.001, 0.002)),
        "cubic(0, 90 deg/s)": Profile("cubic", (0, math.pi / 2), True),
        "quintic(0, 1 m/s, 0, 2 m/s/s)": Profile("quintic", (0, 1, 0, 2)),
        "constant": Profile("constant"),
        "smooth": Profile("smooth", acceleration=2.0, jerk=20.0),
        "smooth(1 m/s/s, 5000 mm/s^3)": Profile("smooth", acceleration=1.0, jerk=5.0),
        "trapezoid": Profile("trapezoid"),
    }
    for text, profile in profiles.items():
        assert only(f"line by (1,0) mm profile {text}").profile == profile


FORMULAS = [
    "(t*mm, t^2*mm, t^3*mm)",
    "(sin(t*rad)*mm, cos(t*deg)*mm, tan(t/9*rad)*mm)",
    "polar(exp(t)*mm, t*rad) + (1, 2, 3) mm",
    "(sqrt(1 + t)*mm, ln(2 + t)*mm, abs(t - 5)*mm)",
    "(asin(t/9)/rad*mm, acos(t/9)/rad*mm, atan(t)/rad*mm)",
    "(min(t, 5)*mm, max(t*mm, 1 mm, -t*mm), 1/(1+t)*mm)",
    "-(t, 2) mm / (3 + t) + k*t*y*mm",
    "((1+t)^1.5*mm, 2^t*mm, (1+t)^(-2)*mm)",
]


@pytest.mark.parametrize("formula", FORMULAS)
def test_curves_have_exact_derivatives(formula: str) -> None:
    segment = last(f"let k = 7\ncurve {formula} for t from 0.1 to 0.9 samples 10")
    assert isinstance(segment.path, Curve)
    assert segment.timing == Samples(10)
    t, h = np.linspace(0.2, 0.8, 5), 1e-5

    def values(at: np.ndarray) -> np.ndarray:
        return np.array([c.derivatives[0] for c in segment.path.formula(Taylor.variable(at))])

    series = np.array([c.derivatives for c in segment.path.formula(Taylor.variable(t))])
    slope = (values(t + h) - values(t - h)) / (2 * h)
    bend = (values(t + 1e-3) - 2 * values(t) + values(t - 1e-3)) / 1e-6
    assert series[:, 1] == pytest.approx(slope, rel=1e-7, abs=1e-11)
    assert series[:, 2] == pytest.approx(bend, rel=1e-4, abs=1e-8)
    end = np.array(
        [c.derivatives[0] for c in segment.path.formula(Taylor.variable(np.array([0.9])))]
    )
    assert segment.end.position == pytest.approx(tuple(end[:, 0]))


def test_a_formula_that_is_not_finite_in_between_says_where() -> None:
    # The place is not among those the language looks at itself.
    path = last("curve (mm/(t - 0.1234567), 0) for t from 0 to 1").path
    assert isinstance(path, Curve)
    with pytest.raises(ScriptError, match=r"E243.*t = 0\.123457"):
        path.formula(Taylor.variable(np.array([0.1234567])))


def test_apportioned() -> None:
    assert apportion(11, [3, 1, 6]) == [3, 2, 6]
    for count in range(3, 60):
        counts = apportion(count, [0.1, 5.0, 2.7])
        assert sum(counts) == count
        assert min(counts) >= 1


def test_dimension_names() -> None:
    assert NAMES[(1.0, -1.0, 0.0, 0.0)] == "a speed"
    assert dimension_name((3.0, -1.0, 0.0, 0.0)) == "a quantity in m^3/s"
    assert dimension_name((0.0, -2.0, 0.0, 0.0)) == "a quantity in 1/s^2"


# Colours.


def colour(text: str) -> tuple[float, ...]:
    light = only(f"line by (1,0) mm light {text}").light
    assert light is not None
    return light.first


def test_colours() -> None:
    assert len(colours.NAMES) == 148  # of CSS Color 4
    orange = ((128 + 0.055 * 255) / 1.055 / 255) ** 2.4
    assert colour('"#ff8000"') == pytest.approx((1, orange, 0))
    assert colour('"#f80"') == colour('"#ff8800"')
    assert colour("orange") == colour('"#ffa500"') == colour('"Orange"')
    assert colour("tan") == colour('"#d2b48c"')
    assert colour("hsv(120 deg)") == (0, 1, 0)
    assert colour("hsv(-240 deg, 1, 1)") == (0, 1, 0)
    encoded = colorsys.hsv_to_rgb(0.1, 0.5, 0.25)
    assert colour("hsv(36 deg, 0.5, 0.25)") == pytest.approx(tuple(map(colours.linear, encoded)))
    assert colour("white 25%") == (0.25, 0.25, 0.25)
    assert only("line by (1,0) mm light black").light is None
    assert only("line by (1,0) mm light red 0%").light is None
    assert only("line by (1,0) mm light off to red").light == Light((0, 0, 0), (1, 0, 0))


@pytest.mark.parametrize(
    ("kelvin", "x", "y"),
    # Chromaticities of the black body: tables of Wyszecki and Stiles, Color Science (1982).
    [
        (2000, 0.5267, 0.4133),
        (3000, 0.4369, 0.4041),
        (5000, 0.3451, 0.3516),
        (10000, 0.2807, 0.2884),
    ],
)
def test_temperatures(kelvin: float, x: float, y: float) -> None:
    rgb = np.array(colour(f"{kelvin} K"))
    to_xyz = np.array(
        [
            [0.4124564, 0.3575761, 0.1804375],
            [0.2126729, 0.7151522, 0.0721750],
            [0.0193339, 0.1191920, 0.9503041],
        ]
    )
    xyz = to_xyz @ rgb
    assert rgb.max() == 1
    assert tuple(xyz[:2] / xyz.sum()) == pytest.approx((x, y), abs=0.004)


def test_reserved_words_are_free_elsewhere() -> None:
    program = parse("robot iiwa\nlet end1 = 1 mm\nline by (end1, 0)", "a")
    assert program.robot == "iiwa"
    assert parse('robot "my arm.urdf"\nline by (1, 0) mm', "a").robot == "my arm.urdf"

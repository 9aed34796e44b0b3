"""Whatever is written: a drawing of finite numbers, or a message, and soon."""

import math
import random
import re

import numpy as np
import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from dqpaint.language import Program, ScriptError, parse
from tests.support.drawing_texts import FILES, HERE, MIXED, ROSE, SCRAPS, STAR, TOKEN, WHOLE
from tests.support.work import Calls

MOST_CALLS = 4_500_000  # twice what is needed


def check(text: str) -> None:
    """Compiles a text; whatever comes out must be sound."""
    try:
        program = parse(text, "fuzz.traj", HERE)
    except ScriptError as error:
        told(error)
    else:
        finite(program.segments)
        joined(program)


def told(error: ScriptError) -> None:
    assert str(error)
    for diagnostic in error.diagnostics:
        assert diagnostic.code != "E999", error.text
        assert diagnostic.message
        span = diagnostic.span
        assert span is None or 0 <= span.start <= span.end <= len(error.text)


def finite(thing: object) -> None:
    if isinstance(thing, float):
        assert math.isfinite(thing)
    elif isinstance(thing, np.ndarray):
        assert np.isfinite(thing).all()
    elif isinstance(thing, tuple):
        for part in thing:
            finite(part)
    elif hasattr(thing, "__dataclass_fields__"):
        for name in thing.__dataclass_fields__:
            finite(getattr(thing, name))


def joined(program: Program) -> None:
    at = program.start
    for segment in program.segments:
        assert segment.start == at
        at = segment.end
        assert math.hypot(*at.orientation) == pytest.approx(1, abs=1e-12)


@pytest.mark.slow
def test_mutants() -> None:
    chance = random.Random(20161122)
    texts = [  # the file of the table's photograph is not there
        re.sub(r'photo "ada.*', "", text) for text in (STAR, ROSE, MIXED, WHOLE, WHOLE, *FILES)
    ]
    for text in texts:
        check(text)
        assert parse(text, "whole.traj", HERE).segments
    for _ in range(2000):
        words = TOKEN.findall(chance.choice(texts))
        for _ in range(chance.randint(1, 3)):
            i, scrap = chance.randrange(len(words)), chance.choice(SCRAPS)
            new = chance.choice(([scrap], [words[i], f" {scrap} "], [chance.choice(words)], [" "]))
            words[i : i + 1] = new
        check("".join(words))


numbers = st.one_of(
    st.sampled_from(["0", "1", "-1", "0.5", "3", "90", "1e308", "1e-308", "1e154", "360", "9^9^9"]),
    st.floats(allow_nan=False, allow_infinity=False).map(repr),
)
units = st.sampled_from(["", " mm", " m", " deg", " s", " mm/s", " deg/s", " K", " mm/turn"])
points = st.builds(
    "({}, {}, {}){}".format, numbers, numbers, numbers, st.sampled_from([" mm", " m", ""])
)
orientations = st.one_of(
    st.builds("rpy({} deg, {} deg, {} deg)".format, numbers, numbers, numbers),
    st.builds("rot({}, {} deg)".format, points, numbers),
    st.builds("look {} up {}".format, points, points),
    st.builds("look line {} along {}".format, points, points),
    st.sampled_from(["keep", "follow"]),
)
values = st.builds("{}{}".format, numbers, units)
clauses = st.one_of(
    st.builds(" in {} s".format, numbers),
    st.builds(" samples {}".format, numbers),
    st.builds(" speed {} mm/s".format, numbers),
    st.builds(" tool {}".format, orientations),
    st.builds(" light hsv({} deg) to {} K".format, numbers, numbers),
    st.builds(" profile cubic({} mm/s, {} mm/s)".format, numbers, numbers),
    st.just(""),
)
formulas = st.builds(
    "({0}*sin(t*{1}), {2}*t{4}, {3}*exp(t){4})".format,
    values,
    units.map(lambda u: u.strip() or "1"),
    numbers,
    numbers,
    st.sampled_from(["*mm", "*m", "^2*mm", "^0.5*mm", "/t*mm"]),
)
statements = st.one_of(
    st.builds("start at {} tool {}".format, points, orientations),
    st.builds("line to {} by {}{}".format, points, points, clauses),
    st.builds("move to {}".format, points),
    st.builds("arc via {} to {}{}".format, points, points, clauses),
    st.builds(
        "arc centre {} axis {} angle {} deg rise {} mm grow {} mm{}".format,
        points,
        points,
        numbers,
        numbers,
        numbers,
        clauses,
    ),
    st.builds(
        "screw about {} along {} angle {} deg pitch {} mm/turn{}".format,
        points,
        points,
        numbers,
        numbers,
        clauses,
    ),
    st.builds("screw to {} tool {}".format, points, orientations),
    st.builds("curve {} for t from {} to {}{}".format, formulas, numbers, numbers, clauses),
    st.builds("with rotate {} deg about {} scale {}".format, numbers, points, numbers),
    st.builds("repeat i from {} to {}".format, st.integers(0, 3), st.integers(2, 4)),
    st.builds(
        "let v{} = {} {} {}".format, st.integers(0, 9), values, st.sampled_from("+-*/^"), values
    ),
    st.builds("tool {}".format, orientations),
    st.builds("hold {}".format, values),
    st.builds("step to {}".format, points),
    st.builds("period {}".format, values),
    st.builds("blend {} mm".format, numbers),
    st.builds("arc radius {} mm to {} left{}".format, numbers, points, clauses),
    st.builds("stroke{}".format, clauses),
    st.builds("frame w{} at {} turned {} deg".format, st.integers(0, 2), points, numbers),
    st.builds("with frame w{}".format, st.integers(0, 2)),
    st.builds("def d{}(a)".format, st.integers(0, 2)),
    st.builds("d{}({})".format, st.integers(0, 2), values),
    st.builds("let f{}(a) = a*{}".format, st.integers(0, 2), values),
    st.builds("line by (f{}({}), 3 mm)".format, st.integers(0, 2), values),
    st.builds("brush bar {} mm along {}".format, numbers, points),
    st.builds("strobe {} Hz {}%".format, numbers, numbers),
    st.builds("light red to {} K even".format, numbers),
    st.just("end"),
)


@pytest.mark.slow
@settings(max_examples=300, deadline=None, suppress_health_check=list(HealthCheck))
@given(st.lists(statements, min_size=1, max_size=8))
def test_wild_numbers(lines: list[str]) -> None:
    check("\n".join(lines))


@settings(max_examples=200, deadline=None)
@given(st.text())
def test_any_text(text: str) -> None:
    check(text)


@pytest.mark.parametrize(
    "text",
    [
        "(" * 200_000,
        "let a = " + "(" * 200_000,
        "let a = 1" + "+1" * 50_000 + "\nline by (a*mm, 0)",
        "let a = 1" + "^1" * 5_000,
        "with rotate 1 deg\n" * 5_000,
        "end\n" * 50_000,
        "§" * 200_000,
        "repeat 10000\n" * 3 + "end\n" * 3,
        "repeat 9999\n" * 3 + "line by (1,0) mm\n" + "end\n" * 3,
        "let a = " + "9" * 100_000,
        "line " + "by (1, 0) mm " * 5_000,
        'light "' + "x" * 200_000 + '"',
        "a" * 200_000,
        "line by (1,0) mm samples 1000000000000",
    ],
    ids=lambda text: text[:16],
)
def test_large_files_end_soon(text: str) -> None:
    with Calls(MOST_CALLS):
        check(text)


@pytest.mark.slow
def test_ten_thousand_lines() -> None:
    text = "line to (1.5, 2.5, 3) mm\nline to (2.5, 2.5, 3) mm\n" * 5_000
    with Calls(MOST_CALLS):
        assert len(parse(text, "long.traj").segments) == 10_000

"""Lettering: its size, its place, its lines, and what the fonts are made of."""

from itertools import pairwise

import numpy as np
import pytest

from dqpaint.language import parse
from dqpaint.language.imports import lettering
from dqpaint.program import piecewise
from dqpaint.program.program import (
    CruiseSpeed,
    Light,
    PiecewiseCurve,
    Program,
    Samples,
    Segment,
    Straight,
)
from tests.support.drawn import drawn

FONTS = lettering.font_names()
MM = 1e-3


def strokes(program: Program) -> list[Segment]:
    return [s for s in program.segments if isinstance(s.path, PiecewiseCurve)]


def box(program: Program) -> np.ndarray:
    """Least and greatest coordinates (2, 3) of all that shines [mm]."""
    return np.array(piecewise.bounding_box([s.path for s in strokes(program)])) / MM


def inked(line: str) -> np.ndarray:
    return box(drawn(f"text {line}"))


@pytest.mark.parametrize("name", FONTS)
def test_fonts(name: str) -> None:
    font = lettering.read_font(name)
    assert font.name == name
    assert set(map(chr, range(32, 127))) - set(font.glyphs) <= set(
        "^abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ"
    )
    for letter, glyph in font.glyphs.items():
        assert glyph.width > 0
        assert bool(glyph.strokes) == (letter != " ")
        for points in glyph.strokes:
            assert len(points) > 1
            assert np.abs(points).max() < 60
    for letter in "H" if font.has("H") else "Ω":
        ys = np.concatenate(font.glyph(letter).strokes)[:, 1]
        assert (ys.min(), ys.max()) == (0, font.cap)


def test_acknowledgements_travel_with_the_fonts() -> None:
    words = (lettering.FONTS / "README.md").read_text("utf-8")
    for said in ("Dr. A. V. Hershey", "National Bureau of Standards", "James Hurt", "MIT"):
        assert said in words


def test_height_is_that_of_a_capital() -> None:
    """An H of futural: stems at 4 and 18 of 22 units, 21 high."""
    least, most = inked('"H" height 42 mm at (10, 20) mm')
    np.testing.assert_allclose(least, (10, 20, 0), atol=1e-9)
    np.testing.assert_allclose(most, (10 + 2 * 14, 20 + 42, 0), atol=1e-9)


def test_letters_follow_each_other_by_their_widths() -> None:
    """H (22 units wide) and I (8, its stem at 4): from 4 to 22 + 4."""
    least, most = inked('"HI" height 21 mm at (0, 0)')
    assert most[0] - least[0] == pytest.approx(22)
    least, most = inked('"H I" height 21 mm at (0, 0)')  # a blank is 16 units
    assert most[0] - least[0] == pytest.approx(38)


@pytest.mark.parametrize(("align", "edge"), [("left", 0.0), ("centre", 0.5), ("right", 1.0)])
def test_alignment(align: str, edge: float) -> None:
    at = np.array([7.0, 3.0])
    for line in ("Ada", "H", "So"):
        least, most = inked(f'"{line}" height 10 mm at (7, 3) mm align {align}')
        assert least[0] + edge * (most[0] - least[0]) == pytest.approx(at[0], abs=1e-9)


def test_center_is_centre() -> None:
    american, british = (inked(f'"A" height 9 mm align {word}') for word in ("center", "centre"))
    np.testing.assert_array_equal(american, british)


def test_lines_stand_under_each_other() -> None:
    least, most = inked('"H" "I" "H" height 10 mm at (0, 0)')
    assert (least[1], most[1]) == pytest.approx((-32, 10))  # 1.6 heights from one to the next


def test_width_fits_the_longest_line() -> None:
    least, most = inked('"Ada" "A" width 80 mm')
    assert most[0] - least[0] == pytest.approx(80)
    least, most = inked('"HH" width 70 mm height 10 mm')
    assert most[1] - least[1] == pytest.approx(10)  # 22 + 14 of 21 units: the height is smaller
    least, most = inked('"HH" width 12 mm height 10 mm')
    assert most[0] - least[0] == pytest.approx(12)


def test_blanks_at_the_ends_count() -> None:
    assert inked('"  H" height 21 mm at (0, 0)')[0][0] == pytest.approx(32)
    assert inked('"H " height 21 mm at (0, 0) align right')[1][0] == pytest.approx(-16)


def test_without_a_place_it_begins_where_the_tool_is() -> None:
    program = drawn('start at (5, 6) mm\nline by (1, 1) mm\ntext "H" height 21 mm')
    np.testing.assert_allclose(box(program)[0], (6, 7, 0), atol=1e-9)


def test_it_stands_in_its_frame() -> None:
    program = drawn('with rotate 90 deg shift (10, 0) mm scale 2\ntext "H" height 21 mm\nend')
    least, most = box(program)
    np.testing.assert_allclose(most - least, (42, 28, 0), atol=1e-9)
    program = drawn('with rotate 90 deg\ntext "H" height 21 mm at (10, 0) mm\nend')
    np.testing.assert_allclose(box(program)[0], (-21, 10, 0), atol=1e-9)


def test_a_letter_is_one_stroke_and_evenly_lit() -> None:
    program = drawn('text "SOS" height 20 mm light red')
    assert len(strokes(program)) == 3
    for segment in strokes(program):
        assert segment.light == Light((1, 0, 0), (1, 0, 0), even=True)
    dark = [s for s in program.segments if s.light is None]
    assert len(dark) == 2
    assert all(isinstance(s.path, Straight) for s in dark)


def test_bows_are_round_and_stems_are_straight() -> None:
    (o,) = strokes(drawn('text "O" height 20 mm'))
    out = piecewise.derivatives(o.path, np.arange(len(o.path.cubic)), np.ones(len(o.path.cubic)))[1]
    into = piecewise.derivatives(o.path, np.arange(len(o.path.cubic)), np.zeros(len(o.path.cubic)))[
        1
    ]
    out, into = (v / np.linalg.norm(v, axis=1)[:, None] for v in (out, np.roll(into, -1, axis=0)))
    np.testing.assert_allclose(out, into, atol=1e-12)
    for segment in strokes(drawn('text "AEFHIKLMNTVWXYZ" height 20 mm')):
        assert not segment.path.cubic[:, 2:].any()


@pytest.mark.parametrize("name", FONTS)
def test_bows_stay_near_their_points(name: str) -> None:
    """What is rounded leaves the font's own polyline by less than a unit in 21."""
    font = lettering.read_font(name)
    for glyph in font.glyphs.values():
        for points in glyph.strokes:
            curve = lettering._stroke(points, font.sharpest)
            count = len(curve.cubic)
            g = np.tile(np.linspace(0, 1, 9), count)
            of = np.repeat(np.arange(count), 9)
            at = piecewise.derivatives(curve, of, g)[0]
            a = curve.cubic[of, 0]
            b = a + curve.cubic[of, 1:].sum(axis=1) - a
            share = ((at - a) * b).sum(1) / (b * b).sum(1)
            assert np.linalg.norm(at - a - share[:, None] * b, axis=1).max() < 1.0


def test_time_is_shared_by_length() -> None:
    program = drawn('text "HI" height 20 mm samples 1000')
    counts = [s.timing.count for s in program.segments if isinstance(s.timing, Samples)]
    assert sum(counts) == 1000
    assert len(counts) == len(program.segments)
    assert all(isinstance(s.timing, CruiseSpeed) for s in drawn('text "HI" height 9 mm').segments)


def test_a_gradient_runs_over_all() -> None:
    lit = strokes(drawn('text "HH" height 20 mm light red to blue'))
    assert lit[0].light is not None
    assert lit[-1].light is not None
    assert lit[0].light.first == (1, 0, 0)
    assert lit[-1].light.last == pytest.approx((0, 0, 1))
    for one, other in pairwise(lit):
        assert one.light.last == pytest.approx(other.light.first)


def test_a_tool_that_is_turned_turns_on_the_way_there() -> None:
    program = drawn(
        'start at (0, 0) tool rpy(0, 0, 0)\ntext "H" height 9 mm at (9, 0) mm tool rpy(0, 0, 1 rad)'
    )
    first, *others = program.segments
    assert first.start.orientation == (1, 0, 0, 0)
    assert first.light is None
    assert all(s.start.orientation == first.end.orientation for s in others)
    assert first.end.orientation == pytest.approx((np.cos(0.5), 0, 0, np.sin(0.5)))


def test_a_tool_that_looks_looks() -> None:
    program = drawn('text "Ad" height 9 mm tool look (0, 0, 300) mm up y')
    assert program.notes == ()
    assert len({s.end.orientation for s in program.segments}) == len(program.segments)


def test_signs_from_typesetting() -> None:
    plain, set_ = (drawn(f'text "{t}" height 9 mm') for t in ("a'b-c", "a’b–c"))
    assert [s.path for s in plain.segments] == [s.path for s in set_.segments]


@pytest.mark.parametrize(
    ("line", "instead"),
    [("3 €", "3 EUR"), ("…café", "...café"), ("日", "")],
)
def test_replacements(line: str, instead: str) -> None:
    assert lettering.with_substitutes(line, lettering.read_font("futural")) == instead


LATIN = [chr(code) for code in (*range(0xA1, 0xAD), *range(0xAE, 0x180))]


@pytest.mark.parametrize("name", [name for name in FONTS if name != "greeks"])
def test_every_font_has_all_of_latin_1_and_latin_extended_a(name: str) -> None:
    """Each different from the others and from what it is made of, none out of all bounds."""
    font = lettering.read_font(name)
    assert [letter for letter in LATIN if not font.has(letter)] == []
    drawn_as = {}
    for letter in (*LATIN, *font.glyphs):
        glyph = font.glyph(letter)
        points = np.concatenate([*glyph.strokes, np.zeros((0, 2))])
        if letter != " ":
            assert -12 <= points[:, 1].min() <= points[:, 1].max() <= 32, letter
            assert -12 < points[:, 0].min() <= points[:, 0].max() < glyph.width + 12, letter
            assert np.isfinite(points).all()
        drawn_as[letter] = (glyph.width, points.tobytes())
    alike = {drawn_as[letter] for letter in LATIN if letter not in "Đĺ"}  # as Ð; as Í, if I is l
    assert len(alike) == len(LATIN) - 2
    ascii_ = {drawn_as[letter] for letter in font.glyphs if letter.isascii()}
    assert not alike & ascii_


def ink(font: lettering.Font, letter: str) -> tuple[np.ndarray, np.ndarray]:
    points = np.concatenate(font.glyph(letter).strokes)
    return points.min(axis=0), points.max(axis=0)


@pytest.mark.parametrize("name", [name for name in FONTS if name != "greeks"])
def test_marks_stand_where_they_belong(name: str) -> None:
    """Above without touching, below the baseline; the dot of an i gives way to its accent."""
    font = lettering.read_font(name)
    for letter, base in (*zip("éÉöÖůŻñ", "eEoOuZn", strict=True), ("î", "ı")):
        extra = font.glyph(letter).strokes[len(font.glyph(base).strokes) :]
        assert np.concatenate(extra)[:, 1].min() == ink(font, base)[1][1] + 2.5
    stem = font.glyph("ı").strokes
    assert all(any(part is own for own in font.glyph("i").strokes) for part in stem)
    assert ink(font, "ı")[1][1] < ink(font, "i")[1][1]
    for letter, base in zip("çşąęņ", "csaen", strict=True):
        extra = font.glyph(letter).strokes[len(font.glyph(base).strokes) :]
        assert np.concatenate(extra)[:, 1].max() <= 0.0
        assert np.concatenate(extra)[:, 1].min() < -4.0


def test_greek_has_its_accents() -> None:
    font = lettering.read_font("greeks")
    assert all(font.has(letter) for letter in "Καλημέρα κόσμε ΐΰάέήίόύώΆΈΉΊΌΎΏς")
    assert not font.has("é")
    assert parse('text "Καλημέρα" font "greeks" height 9 mm').segments


@pytest.mark.slow
def test_all_letters_of_all_fonts_can_be_drawn() -> None:
    for name in FONTS:
        known = "".join(sorted(set(lettering.read_font(name).glyphs) - {'"'}))
        assert parse(f'text "{known}" font "{name}" height 3 mm').segments

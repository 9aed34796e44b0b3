"""Fill: lines inside of closed strokes, by areas, by another way to tell inside, and by travel."""

import math

import numpy as np
import pytest

from dqpaint.language import ScriptError, parse
from dqpaint.language.strokes.fill import hatch
from dqpaint.program import Light, PiecewiseCurve, Program, colours, piecewise

MM = 1e-3


def fillings(program: Program, outlines: int) -> list[PiecewiseCurve]:
    """The strokes behind the outlines."""
    lit = [segment for segment in program.segments if segment.light is not None]
    curves = [segment.path for segment in lit if isinstance(segment.path, PiecewiseCurve)]
    return curves[outlines:]


def lines_of(curve: PiecewiseCurve) -> np.ndarray:
    """Every second piece: what lies between are the ways along the outline. (N, 2, 3) [mm]."""
    starts, ways = curve.cubic[::2, 0], curve.cubic[::2, 1]
    return np.stack([starts, starts + ways], axis=1) / MM


def test_a_circle_is_filled_by_its_chords_in_one_stroke() -> None:
    circle = "circle radius 15 mm at (5, -7, 3) mm fill 1 mm angle 30 deg"
    text = f"corner jump\nwith scale 2\n{circle}\nend"
    (filling,) = fillings(parse(text, "a.traj"), 1)
    lines = lines_of(filling) - 2 * np.array([5, -7, 3])
    np.testing.assert_allclose(np.linalg.norm(lines, axis=2), 30, rtol=2e-4)
    along, across = np.array([math.sqrt(0.75), 0.5, 0]), np.array([-0.5, math.sqrt(0.75), 0])
    np.testing.assert_allclose(lines[:, 0] @ across, lines[:, 1] @ across, atol=1e-9)
    heights = lines[:, 0] @ across
    np.testing.assert_allclose(np.diff(heights), 2.0, atol=1e-9)
    ways = np.diff(lines @ along, axis=1)[:, 0]
    assert (ways[1:] * ways[:-1] < 0).all()  # to and fro
    assert 2 * np.abs(ways).sum() == pytest.approx(math.pi * 30**2, rel=2e-3)


RING = (
    '<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 100 100">'
    '<path stroke="{}" d="M10 10H90V90H10Z"/><path stroke="red" d="M30 30H70V70H30Z"/></svg>'
)


@pytest.mark.parametrize(("colour", "area"), [("red", 80**2 - 40**2), ("blue", 80**2 + 40**2)])
def test_holes_stay_empty_within_one_colour(tmp_path, colour: str, area: float) -> None:
    (tmp_path / "ring.svg").write_text(RING.format(colour), "utf-8")
    path = tmp_path / "a.traj"
    text = 'corner jump\nsvg "ring.svg" height 80 mm fill 1 mm'
    path.write_text(text, "utf-8")
    program = parse(text, "a.traj", path)
    made = fillings(program, 2)
    size = sum(np.linalg.norm(np.diff(lines_of(one), axis=1), axis=2).sum() for one in made)
    assert size == pytest.approx(area)
    assert len(made) <= 4  # below, left, right, above of the hole
    for one in made:  # no way leads across the hole
        np.testing.assert_allclose(np.linalg.norm(one.cubic[1::2, 1], axis=1) / MM, 1.0)
    shades = {segment.light for segment in program.segments if segment.light is not None}
    assert len(shades) == (1 if colour == "red" else 2)


def inside(points: np.ndarray, corners: np.ndarray) -> np.ndarray:
    """Even-odd by the winding angle: a way that has no rays, crossings or order."""
    to = corners[None] - points[:, None]
    angle = np.arctan2(to[..., 1], to[..., 0])
    turns = np.diff(angle, axis=1, append=angle[:, :1])
    winding = np.round(((turns + np.pi) % (2 * np.pi) - np.pi).sum(axis=1) / (2 * np.pi))
    return winding % 2 == 1


@pytest.mark.parametrize("seed", range(4))
def test_lines_of_a_polygon_that_crosses_itself_lie_inside(seed: int) -> None:
    draw = np.random.default_rng(seed)
    corners, angle, spacing = draw.normal(size=(9, 2)), draw.uniform(-3, 3), 0.02
    ways = hatch(np.stack([corners, np.roll(corners, -1, axis=0)], axis=1), spacing, angle)
    lines = np.concatenate([way[:, :2].reshape(-1, 2, 2) for way in ways])
    share = draw.uniform(0.02, 0.98, size=(len(lines), 1))
    assert inside(lines[:, 0] + share * (lines[:, 1] - lines[:, 0]), corners).all()
    points = draw.uniform(corners.min(0), corners.max(0), size=(20000, 2))
    area = inside(points, corners).mean() * np.ptp(corners, axis=0).prod()
    filled = spacing * np.linalg.norm(np.diff(lines, axis=1), axis=2).sum()
    assert filled == pytest.approx(area, rel=0.05)


def test_corners_and_sides_along_the_lines_count_once() -> None:
    square = np.array([[0, 0.5], [1, 0.5], [1, 1.5], [0, 1.5]])  # sides lie on lines
    (way,) = hatch(np.stack([square, np.roll(square, -1, axis=0)], axis=1), 1.0, 0.0)
    np.testing.assert_allclose(way, [[0, 0.5, 0], [1, 0.5, 0]])
    diamond = np.array([[0, 0], [1, 0.5], [0, 1.0], [-1, 0.5]])  # two corners lie on one
    (way,) = hatch(np.stack([diamond, np.roll(diamond, -1, axis=0)], axis=1), 1.0, 0.0)
    assert sorted(way[:, 0].tolist()) == [-1, 1]


def test_a_line_that_only_grazes_is_none() -> None:
    """Rounding may leave a line of no length, which no arm can be timed over."""
    tip = np.array([[0, 0], [1, 0], [0.5, 1.5 + 1e-6]])
    (way,) = hatch(np.stack([tip, np.roll(tip, -1, axis=0)], axis=1), 1.0, 0.0)
    assert len(way) == 2


def test_letters_of_several_strokes_are_closed_where_these_touch() -> None:
    text = 'text "A" font "futuram" height 30 mm{}'
    outlines = len(fillings(parse(text.format(""), "a.traj"), 0))
    assert fillings(parse(text.format(" fill 0.5 mm"), "a.traj"), outlines)


def test_time_and_light_are_shared_with_the_outline() -> None:
    text = "corner jump\nrect width 20 mm height 20 mm fill 5 mm in 4 s light red to blue"
    first, *_, last = (s for s in parse(text, "a.traj").segments if s.light is not None)
    assert isinstance(first.light, Light)
    assert isinstance(last.light, Light)
    assert (first.light.first, last.light.last) == (colours.NAMES["red"], colours.NAMES["blue"])
    assert first.light.last == last.light.first
    lengths = piecewise.lengths([first.path, last.path])  # type: ignore[list-item]
    assert lengths == pytest.approx([0.08, 0.08 + 0.015])


@pytest.mark.parametrize(("text", "code"), [
    ('text "L" height 30 mm fill 1 mm', "E269"),
    ("circle radius 30 mm fill 0.001 mm", "E269"),
    ("circle radius 30 mm fill -1 mm", "E220"),
    ("circle radius 30 mm angle 3 deg", "E248"),
    ("line to (3, 0) mm fill 1 mm", "E110"),
    ("stroke\ncircle radius 30 mm fill 1 mm\nend", "E283"),
])  # fmt: skip
def test_what_can_not_be_filled(text: str, code: str) -> None:
    with pytest.raises(ScriptError) as caught:
        parse(text, "a.traj")
    assert caught.value.diagnostics[0].code == code


def test_outlines_that_are_met_too_often_are_refused_before_they_are(tmp_path):
    """A comb of a thousand teeth, each met by thousands of lines."""
    teeth = "".join(f"L{x} 100 L{x + 0.05} 0 " for x in np.arange(0.1, 100.0, 0.1))
    (tmp_path / "comb.svg").write_text(
        "<svg xmlns='http://www.w3.org/2000/svg' viewBox='0 0 100 100'>"
        f"<path d='M0 0 {teeth} L100 -5 L0 -5 Z' stroke='red'/></svg>"
    )
    here = tmp_path / "a.traj"
    text = 'move to (0, 0) mm\nsvg "comb.svg" height 100 mm fill {} mm\n'
    parse(text.format(2), "a", here)
    with pytest.raises(ScriptError) as caught:
        parse(text.format(0.03), "a", here)
    assert [one.code for one in caught.value.diagnostics] == ["E269"]

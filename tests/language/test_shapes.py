"""Shapes: closed, around their middle; and the names that drawings had for them before."""

import numpy as np
import pytest

from dqpaint.language import ScriptError, parse
from dqpaint.language.writing.formatter import formatted
from dqpaint.program import PiecewiseCurve, Program, colours, piecewise
from tests.support.drawn import matrix, rotation

MM = 1e-3


def shape(line: str) -> PiecewiseCurve:
    """The one stroke of a line that also sets the start, with its corners as they are."""
    (segment,) = parse(f"corner jump\n{line}", "a.traj").segments
    assert isinstance(segment.path, PiecewiseCurve)
    np.testing.assert_allclose(segment.start.position, segment.end.position, atol=1e-15)
    return segment.path


def along(curve: PiecewiseCurve, count: int = 500) -> np.ndarray:
    """Points all along (N, 3) [mm]."""
    g = np.linspace(0.0, len(curve.cubic) - 1e-9, count)
    return piecewise.derivatives(curve, g.astype(int), g % 1.0)[0] / MM


def test_round_shapes_keep_their_equations() -> None:
    x, y, z = (along(shape("circle radius 30 mm at (5, -7, 9) mm")) - (5, -7, 9)).T
    np.testing.assert_allclose(x**2 + y**2, 900.0, rtol=1e-12)
    np.testing.assert_allclose(z, 0.0, atol=1e-12)
    assert np.all(np.diff(np.unwrap(np.arctan2(y, x))) > 0)
    x, y, z = along(shape("ellipse width 60 mm height 20 mm")).T
    np.testing.assert_allclose((x / 30) ** 2 + (y / 10) ** 2, 1.0, rtol=1e-12)


def test_a_rectangle() -> None:
    points = along(shape("rect width 60 mm height 20 mm at (1, 2) mm")) - (1, 2, 0)
    np.testing.assert_allclose(np.maximum(np.abs(points[:, 0]) / 30, np.abs(points[:, 1]) / 10), 1)
    assert piecewise.lengths([shape("rect width 60 mm height 20 mm")])[0] == pytest.approx(0.16)


@pytest.mark.parametrize("count", [3, 4, 7])
def test_a_polygon_has_equal_sides_and_its_first_corner_on_top(count: int) -> None:
    curve = shape(f"polygon {count} radius 30 mm")
    corners = curve.cubic[:, 0] / MM
    np.testing.assert_allclose(corners[0], (0, 30, 0), atol=1e-12)
    np.testing.assert_allclose(np.linalg.norm(corners, axis=1), 30, rtol=1e-12)
    sides = np.linalg.norm(curve.cubic[:, 1], axis=1) / MM
    np.testing.assert_allclose(sides, 60 * np.sin(np.pi / count), rtol=1e-12)


def test_a_star_by_itself_has_its_sides_in_line() -> None:
    """Each point, the next inner corner but one and the point beyond lie on one line."""
    corners = shape("star 5 radius 30 mm").cubic[:, 0]
    for i in range(0, 10, 2):
        a, b, c = corners[i], corners[(i + 1) % 10], corners[(i + 4) % 10]
        assert np.linalg.norm(np.cross(b - a, c - a)) < 1e-16
    inner = np.linalg.norm(shape("star 4 radius 30 mm inner 11 mm").cubic[1::2, 0], axis=1)
    np.testing.assert_allclose(inner, 11 * MM)


def test_shapes_are_turned_and_scaled_with_their_block() -> None:
    text = "with shift (3, 4, 5) mm rotate rpy(20 deg, 30 deg, 40 deg) scale 2\n{}\nend"
    plain = along(shape("star 5 radius 30 mm at (1, 2, 3) mm"))
    turn = rotation((0, 0, 1), 40) @ rotation((0, 1, 0), 30) @ rotation((1, 0, 0), 20)
    inside = along(shape(text.format("star 5 radius 30 mm at (1, 2, 3) mm")))
    np.testing.assert_allclose(inside, 2 * plain @ turn.T + (3, 4, 5), atol=1e-12)


def test_blending_rounds_all_corners() -> None:
    points = along(shape("rect width 60 mm height 20 mm blend 2 mm"), 8000)
    corners = np.array([(x, y, 0.0) for x in (-30, 30) for y in (-10, 10)])
    off = np.linalg.norm(points[None] - corners[:, None], axis=2).min(axis=1)
    np.testing.assert_allclose(off, off[0], rtol=1e-2)  # the corner where it begins, too
    assert 0.4 < off[0] < 2.0


def strokes(program: Program) -> list[float]:
    return [max(map(abs, segment.end.position)) for segment in program.segments]


@pytest.mark.parametrize("word", ["circle", "ellipse", "rect", "polygon", "star"])
def test_older_drawings_may_have_their_own(word: str) -> None:
    """A `def` of that name is called with brackets; a value may have it, too."""
    text = f"def {word}(r)\nline by (r, 0)\nend\n{word}(20 mm)\n"
    assert strokes(parse(text, "a.traj")) == [0.02]
    assert formatted(text) == text.replace("\nline", "\n  line")
    assert strokes(parse(f"let {word} = 7 mm\nline by ({word}, 0)", "a.traj")) == [0.007]


def test_round_shapes_say_what_a_tool_can_follow() -> None:
    with pytest.raises(ScriptError) as caught:
        parse("circle radius 9 mm tool follow", "a.traj")
    assert caught.value.diagnostics[0].code == "E254"
    assert "arc centre" in caught.value.diagnostics[0].help


@pytest.mark.parametrize("line", ["let x = 3 mm", "let x = 1"])
def test_x_may_be_a_value_and_is_an_axis_still(line: str) -> None:
    text = f"{line}\nmove to (0, 20) mm\narc centre (0, 0) axis x angle 90 deg"
    (arc,) = parse(text, "a.traj").segments
    np.testing.assert_allclose(arc.end.position, (0, 0, 0.02), atol=1e-15)
    (turn,) = parse(f"{line}\nline by (0, 0) tool rot(x, 90 deg)", "a.traj").segments
    np.testing.assert_allclose(matrix(turn.end.orientation), rotation((1, 0, 0), 90), atol=1e-15)


def test_x_may_be_a_value_of_its_own() -> None:
    assert strokes(parse("let x = 3 mm\nline by (2*x, 0)", "a.traj")) == [0.006]
    own = "let x = (0, 1, 0)\nmove to (0, 20) mm\narc centre (5, 20) mm axis x angle 180 deg"
    (arc,) = parse(own, "a.traj").segments
    np.testing.assert_allclose(arc.end.position, (0.01, 0.02, 0), atol=1e-15)
    assert len(parse("curve (x, x^2/m) for x from 0 to 9 mm", "a.traj").segments) == 1
    assert len(parse("repeat y from 1 to 3\nline by (y*mm, 0)\nend", "a.traj").segments) == 3


def test_rgb_is_srgb() -> None:
    """As in CSS: rgb(1, 0.5, 0) is #ff8000 up to the rounding of the digits."""
    (segment,) = parse("line by (9, 0) mm light rgb(1, 128/255, 0)", "a.traj").segments
    assert segment.light is not None
    assert segment.light.first == pytest.approx(colours.from_hex("ff8000"))

"""SVG drawings: their geometry against hand-made points, their colours, what can't be read."""

import math
import re
from pathlib import Path

import numpy as np
import pytest

from dqpaint.language import Program, ScriptError, parse
from dqpaint.program import piecewise
from dqpaint.program.program import Light, PiecewiseCurve, Segment
from tests.support.svg import WITH, nested_uses
from tests.support.work import Calls

PX = 'width="100" height="100" viewBox="0 0 100 100"'
PIXEL = 0.0254 / 96


def made(folder: Path, body: str, clause: str = "", root: str = PX) -> Program:
    # a dot in two corners keeps the middle of the drawing where it is
    marks = '<path d="M0 0h1e-6M100 100h-1e-6" stroke="red"/>' if root == PX else ""
    (folder / "a.svg").write_text(f"{WITH.format(root)}{marks}{body}</svg>", "utf-8")
    return parse(f'svg "a.svg" {clause} corner jump', "a.traj", folder / "a.traj")


def strokes(program: Program) -> list[Segment]:
    """What is drawn, but for the marks."""
    drawn = [s for s in program.segments if isinstance(s.path, PiecewiseCurve)]
    return [s for s in drawn if piecewise.lengths([s.path])[0] > 1e-8]


def places(path: PiecewiseCurve, count: int = 101) -> np.ndarray:
    """Places (N, 2) along a stroke, in the drawing's own pixels, y down."""
    pieces = len(path.cubic)
    g = np.tile(np.linspace(0, 1, count), pieces)
    at = piecewise.derivatives(path, np.repeat(np.arange(pieces), count), g)[0]
    assert not at[:, 2].any()
    return at[:, :2] * [1 / PIXEL, -1 / PIXEL] + 50


def drawn(folder: Path, body: str) -> np.ndarray:
    (stroke,) = strokes(made(folder, body))
    return places(stroke.path)


def corners(points: np.ndarray) -> np.ndarray:
    return np.vstack([points[::101], points[-1:]])


def same_way(one: np.ndarray, other: object) -> bool:
    other = np.array(other, dtype=float)
    return np.allclose(one, other, atol=1e-9) or np.allclose(one[::-1], other, atol=1e-9)


# Shapes.


@pytest.mark.parametrize(
    ("body", "points"),
    [
        ('<path d="M10 20 L30 40 H50 V10" stroke="red"/>',
         [[10, 20], [30, 40], [50, 40], [50, 10]]),
        ('<path d="m10 20 l20 20 h20 v-30 z" stroke="red"/>',
         [[10, 20], [30, 40], [50, 40], [50, 10], [10, 20]]),
        ('<line x1="1" y1="2" x2="3" y2="5" stroke="red"/>', [[1, 2], [3, 5]]),
        ('<polyline points="1,2 3,5 9,5" stroke="red"/>', [[1, 2], [3, 5], [9, 5]]),
        ('<polygon points="1,2 3,5 9,5" stroke="red"/>', [[1, 2], [3, 5], [9, 5], [1, 2]]),
        ('<rect x="5" y="6" width="7" height="8" stroke="red"/>',
         [[5, 6], [12, 6], [12, 14], [5, 14], [5, 6]]),
        ('<path d="M1 1 L1 1 L2 2 L2 2 Z" stroke="red"/>', [[1, 1], [2, 2], [1, 1]]),
        ('<svg x="10" y="20" width="20" height="20" viewBox="0 0 2 2"><line x2="2" y2="1" '
         'stroke="red"/></svg>', [[10, 20], [30, 30]]),
        ('<defs><line id="l" x2="2" y2="1"/></defs><use href="#l" x="5" y="6" stroke="red"/>',
         [[5, 6], [7, 7]]),
        ('<g transform="translate(10 20)"><g transform="rotate(90)"><line x1="1" x2="3" '
         'stroke="red" transform="scale(2 5)"/></g></g>', [[10, 22], [10, 26]]),
        ('<line x1="1" y1="2" x2="3" y2="5" stroke="red" transform="matrix(1 2 3 4 5 6)"/>',
         [[12, 16], [23, 32]]),
        ('<line x1="0" y1="10" x2="0" y2="20" stroke="red" transform="skewX(45)"/>',
         [[10, 10], [20, 20]]),
        ('<line x1="0.5in" y1="1pc" x2="36pt" y2="20" stroke="red"/>', [[48, 16], [48, 20]]),
    ],
)  # fmt: skip
def test_straight_lines(tmp_path: Path, body: str, points: list[list[float]]) -> None:
    wanted = np.array(points, dtype=float)
    assert same_way(corners(drawn(tmp_path, body)), wanted), corners(drawn(tmp_path, body))


@pytest.mark.parametrize(
    ("d", "control"),
    [
        ("M10 10 C20 40 50 0 60 30", [[10, 10], [20, 40], [50, 0], [60, 30]]),
        ("M10 10 c10 30 40 -10 50 20", [[10, 10], [20, 40], [50, 0], [60, 30]]),
        ("M10 10 Q40 70 60 30", [[10, 10], [30, 50], [140 / 3, 170 / 3], [60, 30]]),
    ],
)
def test_bezier_curves(tmp_path: Path, d: str, control: list[list[float]]) -> None:
    p = np.array(control)
    t = np.linspace(0, 1, 101)[:, None]
    b = (1 - t) ** 3, 3 * t * (1 - t) ** 2, 3 * t**2 * (1 - t), t**3
    wanted = sum(w * c for w, c in zip(b, p, strict=True))
    for matrix in ((1, 0, 0, 1, 0, 0), (0.5, 0.3, -0.7, 0.2, 40, 10)):
        body = f'<path d="{d}" stroke="red" transform="matrix{matrix}"/>'
        m = np.array(matrix).reshape(3, 2)
        assert same_way(drawn(tmp_path, body), wanted @ m[:2] + m[2])


def test_smooth_curves_continue(tmp_path: Path) -> None:
    """S and T mirror the handle before."""
    for short, long in (
        ("M0 0 C1 9 8 9 9 5 S 20 2 30 9", "M0 0 C1 9 8 9 9 5 C 10 1 20 2 30 9"),
        ("M0 0 Q5 9 9 5 T 30 9", "M0 0 Q5 9 9 5 Q 13 1 30 9"),
    ):
        one, other = (drawn(tmp_path, f'<path d="{d}" stroke="red"/>') for d in (short, long))
        assert same_way(one, other)


def test_circles_and_ellipses(tmp_path: Path) -> None:
    at = drawn(tmp_path, '<circle cx="40" cy="60" r="20" stroke="red"/>')
    np.testing.assert_allclose(np.hypot(*(at - [40, 60]).T), 20, atol=1e-9)
    assert np.ptp(np.unwrap(np.arctan2(*(at - [40, 60]).T))) == pytest.approx(2 * math.pi)
    at = drawn(tmp_path, '<ellipse cx="40" cy="60" rx="20" ry="5" stroke="red"/>')
    np.testing.assert_allclose(np.hypot(*((at - [40, 60]) / [20, 5]).T), 1, atol=1e-9)


@pytest.mark.parametrize("flags", ["0 0", "0 1", "1 0", "1 1"])
@pytest.mark.parametrize("turned", [0, 30])
def test_arcs(tmp_path: Path, flags: str, turned: int) -> None:
    """The ends, the ellipse, the long way round or the short one, and which way round."""
    matrix = (0.8, 0.3, -0.5, 1.1, 30, 5)  # a skewed frame: arcs stay arcs of another ellipse
    d = f"M20 30 A15 10 {turned} {flags} 32 41"
    body = f'<path d="{d}" stroke="red" transform="matrix{matrix}"/>'
    (stroke,) = strokes(made(tmp_path, body))
    m = np.array(matrix).reshape(3, 2)
    back = (places(stroke.path) - m[2]) @ np.linalg.inv(m[:2])
    if not np.allclose(back[0], [20, 30]):
        back = back[::-1]
    np.testing.assert_allclose(back[[0, -1]], [[20, 30], [32, 41]], atol=1e-9)
    a = math.radians(turned)
    flat = back @ np.array([[math.cos(a), -math.sin(a)], [math.sin(a), math.cos(a)]]) / [15, 10]
    # all on one unit circle: its centre by least squares
    design = np.hstack([2 * flat, np.ones((len(flat), 1))])
    solution = np.linalg.lstsq(design, (flat**2).sum(1), rcond=None)[0]
    centre = solution[:2]
    np.testing.assert_allclose(np.hypot(*(flat - centre).T), 1, atol=1e-9)
    turn = np.ptp(np.unwrap(np.arctan2(*(flat - centre).T[::-1])))
    assert (turn > math.pi) == (flags[0] == "1")
    cross = np.linalg.det([flat[1] - flat[0], flat[2] - flat[1]])
    assert (cross > 0) == (flags[2] == "1")


def test_radii_too_small_are_scaled_up_as_svg_says(tmp_path: Path) -> None:
    at = drawn(tmp_path, '<path d="M20 30 A1 1 0 0 1 40 30" stroke="red"/>')
    np.testing.assert_allclose(np.hypot(*(at - [30, 30]).T), 10, atol=1e-9)
    assert corners(drawn(tmp_path, '<path d="M2 3 A0 5 0 0 1 9 3" stroke="red"/>')).shape == (2, 2)


def test_rounded_rectangles(tmp_path: Path) -> None:
    (stroke,) = strokes(made(tmp_path, '<rect width="30" height="20" rx="5" stroke="red"/>'))
    assert piecewise.lengths([stroke.path])[0] == pytest.approx(
        PIXEL * (60 + 10 * math.pi), rel=1e-6
    )
    assert stroke.path.angles[:, 1].astype(bool).sum() == 4


# Size and place.


def test_its_own_size(tmp_path: Path) -> None:
    """Without a size it is as large as it says, 96 pixels to the inch."""
    body = '<line x1="10" y1="20" x2="58" y2="20" stroke="red"/>'
    for root, wanted in (
        ("", 12.7),
        ('viewBox="0 0 96 96"', 12.7),
        ('width="100%" height="100%" viewBox="0 0 96 96"', 12.7),
        ('width="2in" viewBox="0 0 96 96"', 25.4),
        ('height="2in" viewBox="0 0 192 96"', 25.4),
        ('width="192mm" height="192mm" viewBox="0 0 96 96"', 96),
    ):
        (stroke,) = strokes(made(tmp_path, body, root=root))
        assert 1e3 * piecewise.lengths([stroke.path])[0] == pytest.approx(wanted, rel=1e-5)


def test_fitted_and_placed(tmp_path: Path) -> None:
    body = '<rect x="7" y="9" width="30" height="20" stroke="red"/>'

    def box(clause: str) -> list[float]:
        (stroke,) = strokes(made(tmp_path, body, clause, root=""))
        least, most = piecewise.bounding_box([stroke.path])
        return (1e3 * np.concatenate([least[:2], most[:2]])).tolist()

    assert box("height 40 mm") == pytest.approx([-30, -20, 30, 20])
    assert box("width 40 mm at (5, 6) mm") == pytest.approx([-15, 6 - 40 / 3, 25, 6 + 40 / 3])
    assert box("width 30 mm height 40 mm") == pytest.approx([-15, -10, 15, 10])


def test_y_is_up(tmp_path: Path) -> None:
    (stroke,) = strokes(made(tmp_path, '<path d="M50 50 L60 40" stroke="red"/>'))
    ends = np.array(piecewise.ends(stroke.path))
    np.testing.assert_allclose(np.sort(ends[:, 1]), [0, 10 * PIXEL], atol=1e-12)
    np.testing.assert_allclose(np.sort(ends[:, 0]), [0, 10 * PIXEL], atol=1e-12)


# Light.


def light(folder: Path, attributes: str, clause: str = "") -> Light | None:
    (stroke,) = strokes(made(folder, f'<line x1="5" x2="9" {attributes}/>', clause))
    return stroke.light


def test_colours(tmp_path: Path) -> None:
    def colour(attributes: str, clause: str = "") -> tuple[float, ...] | None:
        made_light = light(tmp_path, attributes, clause)
        return made_light and made_light.first

    half = ((128 / 255 + 0.055) / 1.055) ** 2.4  # IEC 61966-2-1
    assert colour('stroke="#ff0080"') == pytest.approx((1, 0, half))
    assert colour('stroke="rgb(0,255,0)" fill="red"') == (0, 1, 0)
    assert colour('style="stroke:blue"') == (0, 0, 1)
    assert colour('fill="aqua"') == (0, 1, 1)
    assert colour('stroke="red" stroke-opacity="0.5"') == pytest.approx((0.5, 0, 0), abs=3e-3)
    assert colour('stroke="red"', "light blue") == (0, 0, 1)  # the clause's goes before
    assert colour('stroke="black"') == (1, 1, 1)  # ink is no light: the one that holds
    assert colour('stroke="#111"') == (1, 1, 1)
    assert light(tmp_path, 'stroke="red"').even  # type: ignore[union-attr]


def test_colours_from_a_style_sheet_and_from_groups(tmp_path: Path) -> None:
    sheet = "<style>.a{stroke:lime} #b{stroke:blue}</style>"
    for line, wanted in (
        ('<line class="a" x2="9"/>', (0, 1, 0)),
        ('<line id="b" x2="9"/>', (0, 0, 1)),
        ('<line x2="9"/>', (1, 0, 0)),
    ):
        (stroke,) = strokes(made(tmp_path, f'{sheet}<g stroke="red">{line}</g>'))
        assert stroke.light is not None
        assert stroke.light.first == wanted


@pytest.mark.parametrize(
    "hidden",
    [
        '<line x2="9" stroke="none" fill="none"/>',
        '<line x2="9" stroke="red" visibility="hidden"/>',
        '<line x2="9" stroke="red" display="none"/>',
        '<g style="display:none"><line x2="9" stroke="red"/></g>',
        '<style>.h{display:none}</style><line class="h" x2="9" stroke="red"/>',
        '<defs><line x2="9" stroke="red"/></defs>',
        '<symbol id="s"><line x2="9" stroke="red"/></symbol>',
        '<mask><line x2="9" stroke="red"/></mask><marker><line x2="9" stroke="red"/></marker>',
        '<clipPath><line x2="9"/></clipPath><pattern><line x2="9" stroke="red"/></pattern>',
        '<rect width="100" height="100" fill="white"/>',  # the paper
        '<line x2="9" stroke="red" stroke-opacity="0" fill="none"/>',
    ],
)
def test_what_is_not_seen(tmp_path: Path, hidden: str) -> None:
    program = made(tmp_path, f'{hidden}<line x1="5" x2="7" y1="5" y2="5" stroke="red"/>')
    assert len(strokes(program)) == 1


@pytest.mark.parametrize(
    "rectangle",
    [
        '<rect x="2" width="100" height="100" fill="red"/>',
        '<rect width="98" height="100" fill="red"/>',
        '<rect width="100" height="98" fill="red"/>',
        '<rect width="100" height="100" fill="red" stroke="blue"/>',
        '<rect width="100" height="100" transform="rotate(10)" fill="red"/>',
        '<path d="M0 0H100V100H0Z" fill="red"/>',
    ],
)
def test_what_is_no_paper(tmp_path: Path, rectangle: str) -> None:
    assert len(strokes(made(tmp_path, rectangle))) == 1


@pytest.mark.parametrize("stroke", ["", 'stroke="red" stroke-opacity="0"'])
def test_paper(tmp_path: Path, stroke: str) -> None:
    turned = f'<rect x="-1" width="101" height="200" {stroke} transform="rotate(-90) scale(-1 1)"/>'
    body = f'<rect y="-5" width="999" height="999" {stroke}/>{turned}'
    assert len(strokes(made(tmp_path, f'{body}<line x2="9" stroke="red"/>'))) == 1


def test_a_symbol_shows_where_it_is_used(tmp_path: Path) -> None:
    body = '<symbol id="s"><line x2="9" stroke="red"/></symbol><use href="#s" x="20" y="30"/>'
    assert same_way(corners(drawn(tmp_path, body)), [[20, 30], [29, 30]])


# What can't be read.


def fault(folder: Path, body: str) -> str:
    with pytest.raises(ScriptError) as caught:
        made(folder, body)
    (diagnostic,) = caught.value.diagnostics
    assert diagnostic.code == "E298"
    return diagnostic.message


def test_a_file_that_asks_for_too_much(tmp_path: Path) -> None:
    (tmp_path / "b.svg").write_text(nested_uses(30))
    with Calls(100_000), pytest.raises(ScriptError, match=r"E298.*'use'"):
        parse('svg "b.svg"', "a.traj", tmp_path / "a.traj")


@pytest.mark.parametrize(
    "body",
    [
        '<line x2="1e999" stroke="red"/>',
        '<line x2="nan" stroke="red"/>',
        '<path d="M0 0 L1e300 1e300" stroke="red"/>',
        '<line x2="9" stroke="red" transform="scale(1e300)"/>',
        '<circle r="1e400" stroke="red"/>',
        '<circle r="-2" stroke="red"/>',
        '<rect width="inf" height="3" stroke="red"/>',
        '<path d="M0 0 L9 9" stroke="red" transform="scale(1e400)"/>',
        '<g transform="scale(1e8)"><line x2="1e8" stroke="red"/></g>',
    ],
)
def test_numbers_that_are_none(tmp_path: Path, body: str) -> None:
    """Refused, as no number of the file, or as too large by what stands around."""
    message = fault(tmp_path, body)
    assert re.search(
        r"line 1: \w+ of a <\w+>: '\w+' is|'-2' is negative|a place in it is not finite", message
    )

"""Paths and shapes of SVG against the library's own reading of them, and how much work they are."""

import random

import numpy as np
import pytest
import svgelements
from numpy.typing import NDArray

from dqpaint.language.imports.svg import paths, values
from dqpaint.program import piecewise
from tests.support.svg import G, by_library, outline

Floats = NDArray[np.float64]
UNIT = np.eye(3)[None], np.zeros((1, 3))


def read(data: str) -> list[Floats]:
    pieces = paths.Pieces()
    pieces.begin()
    paths.draw_path(pieces, values.path(data))
    return [outline(line) for _, line in pieces.lines(*UNIT)]


def wanted(data: str) -> list[Floats]:
    """The same, as svgelements has it."""
    return by_library(svgelements.Path(data))


@pytest.mark.parametrize(
    "data",
    [
        "M10 20 L30 40 H50 V10 z m1 1 2 3",
        "M.5.5-1-1 3,4",
        "m1e1-2E-1c1 2 3 4 5 6 7 8 9 10 11 12",
        "M0 0 a1 2 30 0011 12 3 4 0 1,0 5 6",
        "M0,0A5 5 0 01 7,8Q1 2 3 4T5 6 9 9L3 4",
        "M0 0C1 9 8 9 9 5S20 2 30 9 1 2 3 4z",
        "M0 0Q1 9 8 9T5 5 1 2L3 3T9 9",
        "\n M 0\t0\r\nL +1 -1 \n",
        "M1 1h5v5zl2 2zm3 3l1 1",
        "M1 1L1 1L2 2",
    ],
)
def test_paths_are_as_the_library_has_them(data: str) -> None:
    made, others = read(data), wanted(data)
    assert len(made) == len(others)
    for one, other in zip(made, others, strict=True):
        # radii that do not reach are made larger: there the library has seven digits
        np.testing.assert_allclose(
            one, other, atol=1e-6 if "a1 2" in data or "A5" in data else 1e-9
        )


@pytest.mark.parametrize(
    ("data", "plainly"),
    [  # S and T mirror the handle of their own kind alone; the library mirrors any
        ("M0 0C1 9 8 9 9 5T5 5", "M0 0C1 9 8 9 9 5Q9 5 5 5"),
        ("M0 0Q1 9 8 9S5 5 1 2", "M0 0Q1 9 8 9C8 9 5 5 1 2"),
        ("M0 0L8 9S5 5 1 2", "M0 0L8 9C8 9 5 5 1 2"),
        ("M0 0A0 5 0 0 1 9 9a5 5 0 0 0 0 0l1 1", "M0 0L9 9 10 10"),
        ("M0 0A5 5 0 0 1 30 0", "M0 0A15 15 0 0 1 30 0"),
        ("M0 0A-15 15 0 0 1 30 0", "M0 0A15 15 0 0 1 30 0"),
    ],
)
def test_paths_that_mean_the_same(data: str, plainly: str) -> None:
    (one,), (other,) = read(data), read(plainly)
    np.testing.assert_allclose(one, other, atol=1e-12)


@pytest.mark.parametrize("large", [0, 1])
@pytest.mark.parametrize("sweep", [0, 1])
@pytest.mark.parametrize("size", [1e-7, 1e-10, 1e-14, 6e-17])
def test_an_arc_to_almost_its_start_is_all_round_or_nothing(
    large: int, sweep: int, size: float
) -> None:
    """As programs write a circle as one arc, whose end differs by rounding alone."""
    (line,) = read(f"M{size} -50A50 50 0 {large} {sweep} {-size} -50L9 9")
    length = np.linalg.norm(np.diff(line, axis=0), axis=1).sum()
    chords = 8 * 100 * np.sin(np.pi / 8) if large else 0.0
    assert length - np.hypot(9, 59) == pytest.approx(chords, abs=1e-5)
    if large:  # to the right first, round below if clockwise, as y goes down
        np.testing.assert_allclose(line[2], [50, 0 if sweep else -100], atol=1e-5)


def test_random_paths_too() -> None:
    chance = random.Random(3)
    for _ in range(60):
        data, last = f"M{chance.random()} {chance.random()}", "m"
        for _ in range(8):
            letter = chance.choice("MLHVCQAZmlhvcqaz" + {"c": "Ss", "q": "Tt"}.get(last, ""))
            last = letter.lower()
            count = values.COUNTS.get(letter.lower(), 0)
            own = [f"{chance.uniform(-9, 9):.3f}" for _ in range(count)]
            if letter in "aA":
                own[:2] = [f"{chance.uniform(50, 90):.3f}" for _ in range(2)]
                own[3:5] = [chance.choice("01") for _ in range(2)]
            data += letter + " ".join(own)
        for one, other in zip(read(data), wanted(data), strict=True):
            np.testing.assert_allclose(one, other, atol=1e-6, err_msg=data)


def test_shapes_run_as_svg_says() -> None:
    """From where SVG begins them, and clockwise."""
    pieces = paths.Pieces()
    pieces.begin()
    paths.draw_ellipse(pieces, (3.0, 4.0), 2.0, 1.0)
    paths.draw_rectangle(pieces, 1.0, 2.0, (30.0, 20.0), 5.0, 50.0)
    (_, ellipse), (_, rectangle) = pieces.lines(*UNIT)
    round_ = np.stack([3 + 2 * np.cos(np.pi * 2 * G), 4 + np.sin(np.pi * 2 * G)], axis=1)
    np.testing.assert_allclose(outline(ellipse), round_, atol=1e-12)
    # the radii are at most half a side; then two sides have no length
    same = "M6 2H26A5 10 0 0 1 31 12 5 10 0 0 1 26 22H6A5 10 0 0 1 1 12 5 10 0 0 1 6 2"
    np.testing.assert_allclose(outline(rectangle), wanted(same)[0], atol=1e-9)


def test_pieces_meet_to_the_last_digit() -> None:
    """The end of an arc is found from its centre, which may be far away."""
    pieces = paths.Pieces()
    pieces.begin()
    paths.draw_path(pieces, values.path("M0 0A1e7 1e7 0 0 0 1 1a9e6 9e6 0 0 1 1 1l3 4"))
    ((_, line),) = pieces.lines(*UNIT)
    at = outline(line)
    ends, starts = at[len(G) - 1 :: len(G)][:-1], at[len(G) :: len(G)]
    assert np.abs(ends[-1] - [2, 2]).max() > 1e-11  # of 1e7
    np.testing.assert_allclose(ends[-1], starts[-1], rtol=0.0, atol=1e-15)
    np.testing.assert_allclose(at[-1], [5, 6], atol=1e-12)


def test_each_shape_has_its_own_transform() -> None:
    pieces = paths.Pieces()
    for _ in range(2):
        pieces.begin()
        paths.draw_line(pieces, (1.0, 0.0), (1.0, 1.0), (3.0, 1.0))
    matrices, shifts = np.stack([np.eye(3), np.diag([2.0, 0.0, 0.0])]), np.zeros((2, 3))
    shifts[1] = 5.0, 7.0, 0.0
    (first, one), (second, other) = pieces.lines(matrices, shifts)
    assert (first, second) == (0, 1)
    assert outline(one)[[0, -1]].tolist() == [[1, 0], [3, 1]]
    assert outline(other)[[0, -1]].tolist() == [[7, 7], [11, 7]]
    assert len(other.cubic) == 1  # what the transform leaves no length is left out


def test_the_work_on_arrays_is_the_same_for_few_pieces_and_for_many(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """Arrays are made of all pieces at once: one by one they took eight seconds of 20,000 dots."""
    count = 0
    for name in (
        "coefficients",
        "_at",
        "_move",
        "concatenate",
        "derivatives",
        "speeds",
        "transform",
    ):
        inner = getattr(piecewise, name)

        def counted(*given: object, inner: object = inner) -> object:
            nonlocal count
            count += 1
            return inner(*given)  # type: ignore[operator]

        monkeypatch.setattr(piecewise, name, counted)

    def work(lines: int) -> int:
        nonlocal count
        count = 0
        pieces = paths.Pieces()
        for number in range(lines):
            pieces.begin()
            paths.draw_path(pieces, values.path(f"M{number} 0l1 1q1 1 2 2c1 1 2 2 3 4"))
        many = np.repeat(np.eye(3)[None], lines, axis=0), np.zeros((lines, 3))
        made = [curve for _, curve in pieces.lines(*many)]
        assert len(made) == lines
        piecewise.lengths(made)
        return count

    assert work(2) == work(200) < 20

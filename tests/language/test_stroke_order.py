"""The order of lines: what touches is joined, and the dark ways get no longer."""

from itertools import permutations, product

import numpy as np
import pytest

from dqpaint.language import ScriptError, parse
from dqpaint.language.imports import stroke_order
from dqpaint.language.imports.shorter_order import _Search, shorter
from dqpaint.motion import summary_line, survey
from dqpaint.program import piecewise
from dqpaint.program.program import PiecewiseCurve

RED, BLUE = (1.0, 0.0, 0.0), (0.0, 0.0, 1.0)


def line(*points: tuple[float, float]) -> PiecewiseCurve:
    return piecewise.straight(np.array([(*p, 0.0) for p in points]))


def corners(curve: PiecewiseCurve) -> list[tuple[float, float]]:
    ends = np.vstack([curve.cubic[:, 0], piecewise.ends(curve)[1]])
    return [(round(x, 6), round(y, 6)) for x, y, _ in ends.tolist()]


def dark(lines: list[tuple[PiecewiseCurve, object]]) -> float:
    ends = np.array([piecewise.ends(curve) for curve, _ in lines])
    return float(np.linalg.norm(ends[1:, 0] - ends[:-1, 1], axis=1).sum())


def test_what_touches_is_joined_whichever_way_it_was_drawn() -> None:
    lines = [(line((2, 0), (1, 0)), RED), (line((0, 0), (1, 0)), RED), (line((2, 0), (2, 5)), RED)]
    ((whole, colour),) = stroke_order.order_lines(lines).lines
    assert colour == RED
    way = corners(whole)
    assert way in ([(0, 0), (1, 0), (2, 0), (2, 5)], [(2, 5), (2, 0), (1, 0), (0, 0)])


def test_colours_stay_apart_and_closed_lines_alone() -> None:
    lines = [
        (line((0, 0), (1, 0)), RED),
        (line((1, 0), (2, 0)), BLUE),
        (line((1, 0), (1, 9)), None),
    ]
    assert len(stroke_order.order_lines(lines).lines) == 3
    square = line((0, 0), (1, 0), (1, 1), (0, 0))
    assert len(stroke_order.order_lines([(square, RED), (line((0, 0), (-5, 0)), RED)]).lines) == 2


def test_a_ring_of_lines_closes() -> None:
    lines = [(line((0, 0), (1, 0)), RED), (line((1, 1), (1, 0)), RED), (line((1, 1), (0, 0)), RED)]
    ((whole, _),) = stroke_order.order_lines(lines).lines
    assert corners(whole)[0] == corners(whole)[-1]
    assert len(whole.cubic) == 3


def test_where_lines_cross_they_go_straight_on() -> None:
    arms = [((1, 0), (0, 0)), ((0, 1), (0, 0)), ((0, 0), (-1, 0)), ((0, 0), (0, -1))]
    ways = [
        corners(curve)
        for curve, _ in stroke_order.order_lines([(line(*arm), RED) for arm in arms]).lines
    ]
    assert len(ways) == 2
    for way in ways:
        (a, b), (c, d) = np.diff(way, axis=0)
        assert a * d == b * c
        assert a * c + b * d > 0


def test_a_small_gap_is_closed_a_larger_one_is_not() -> None:
    def count(gap: float) -> int:
        lines = [(line((0, 0), (1, 0)), RED), (line((1 + gap, 0), (2, 0)), RED)]
        made = stroke_order.order_lines(lines).lines
        for curve, _ in made:
            ends = piecewise.derivatives(
                curve, np.arange(len(curve.cubic)), np.ones(len(curve.cubic))
            )
            np.testing.assert_allclose(ends[0][:-1], curve.cubic[1:, 0], atol=1e-15)
        return len(made)

    assert count(1e-5) == 1
    assert count(1e-4) == 2


def scattered(rng: np.random.Generator, count: int) -> list[tuple[PiecewiseCurve, None]]:
    starts = rng.uniform(0, 1, (count, 2))
    return [(line(tuple(p), tuple(p + rng.normal(0, 0.02, 2))), None) for p in starts]


def test_the_order_is_never_worse_than_the_file_s(rng: np.random.Generator) -> None:
    for count in (1, 2, 3, 10, 200):
        lines = scattered(rng, count)
        made = stroke_order.order_lines(lines).lines
        assert len(made) == count
        assert dark(made) <= dark(lines)
        both = [{frozenset(map(tuple, corners(c))) for c, _ in some} for some in (lines, made)]
        assert both[0] == both[1]
    assert dark(made) < 0.15 * dark(lines)


def test_a_good_order_is_kept() -> None:
    lines = [(line((i, 0), (i + 0.5, 0)), None) for i in range(9)]
    assert [corners(c) for c, _ in stroke_order.order_lines(lines).lines] == [
        corners(c) for c, _ in lines
    ]


def test_the_nearest_is_the_nearest(rng: np.random.Generator) -> None:
    """The search by cells, against looking at all."""
    for count in (2, 7, 400):
        ends = np.array([piecewise.ends(curve) for curve, _ in scattered(rng, count)])
        order, flipped = stroke_order._nearest(ends)
        left = set(range(1, count))
        for before, line, back, was in zip(order, order[1:], flipped[1:], flipped, strict=False):
            at = ends[before, 0 if was else 1]
            far = {k: np.linalg.norm(ends[k] - at, axis=1) for k in left}
            assert far[line][int(back)] == min(d.min() for d in far.values())
            left.remove(line)


def test_the_file_s_order_stays_where_it_is_better(monkeypatch: pytest.MonkeyPatch) -> None:
    """At 0, -1, 0.9, 10 the nearest comes too early."""
    monkeypatch.setattr(stroke_order, "MOST_SEARCHED", 0)
    lines = [(line((x, 0), (x, 1e-3)), None) for x in (0, -1, 0.9, 10)]
    assert [c.cubic[0, 0, 0] for c, _ in stroke_order.order_lines(lines).lines] == [0, -1, 0.9, 10]


@pytest.mark.slow
def test_twenty_thousand_lines(rng: np.random.Generator) -> None:
    lines = scattered(rng, 20_000)
    assert dark(stroke_order.order_lines(lines).lines) < 0.05 * dark(lines)


def loose_ends(rng: np.random.Generator, count: int) -> np.ndarray:
    return np.array([piecewise.ends(curve) for curve, _ in scattered(rng, count)])


def searched(ends: np.ndarray) -> tuple[float, float, list[int]]:
    """The dark way of the nearest-first order and of the search, and its order."""
    first = stroke_order._nearest(ends)
    order, flipped = shorter(ends, first[0].tolist(), first[1].tolist())
    found = stroke_order._dark(ends, np.array(order), np.array(flipped))
    return stroke_order._dark(ends, *first), found, order


def test_a_few_lines_are_nearly_in_the_best_of_all_orders(rng: np.random.Generator) -> None:
    shares = []
    for _ in range(6):
        ends = loose_ends(rng, 6)
        best = min(
            stroke_order._dark(ends, np.array([0, *order]), np.array([False, *flips]))
            for order in permutations(range(1, 6))
            for flips in product((False, True), repeat=5)
        )
        shares.append(searched(ends)[1] / best)
    assert min(shares) > 1 - 1e-12
    assert max(shares) < 1.15
    assert np.mean(shares) < 1.03


def test_the_search_is_a_tenth_shorter_than_the_nearest_first(rng: np.random.Generator) -> None:
    for count in (100, 2_500):
        ends = loose_ends(rng, count)
        nearest, found, order = searched(ends)
        assert found < 0.9 * nearest
        assert sorted(order) == list(range(count))
        assert order[0] == 0
        assert searched(ends)[2] == order  # and the same each time


def test_what_a_change_is_said_to_save_it_saves(rng: np.random.Generator) -> None:
    ends = loose_ends(rng, 40)
    search = _Search(ends, [2 * line for line in range(40)])

    def way() -> float:
        tour = np.array(search.tour)
        return stroke_order._dark(ends, tour >> 1, (tour & 1).astype(bool))

    for low, high in ((3, 9), (1, 39), (12, 12), (5, 39)):
        before, gain = way(), search._reversed_gain(low, high)
        search._reverse(low, high)
        assert before - way() == pytest.approx(gain, abs=1e-12)
    for place in range(1, 40):
        before = way()
        assert not search._improve(place) or way() < before
        assert [search._at[end >> 1] for end in search.tour] == list(range(40))


def test_the_order_can_be_kept_and_what_it_saves_is_told(tmp_path) -> None:
    rows = "".join(
        f'<path d="M{x} 0 V9" stroke="red"/>' for x in (0, 30, 10, 50, 20, 60, 40)
    )  # every other line is far away
    (tmp_path / "a.svg").write_text(
        f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 60 9">{rows}</svg>'
    )

    def drawn(clause: str):
        text = f'with scale 2\nsvg "a.svg" width 60 mm {clause}\nend'
        return parse(text, "a.traj", tmp_path / "a.traj")

    def dark_way(program) -> float:
        ways = [s for s in program.segments if s.light is None]
        return sum(np.linalg.norm(np.subtract(s.end.position, s.start.position)) for s in ways)

    kept, made = drawn("order as drawn"), drawn("")
    assert kept.dark_saved == 0.0
    assert made.dark_saved == pytest.approx(dark_way(kept) - dark_way(made))
    assert made.dark_saved > 0.2
    assert "mm of dark ways saved by the order" in summary_line(survey(made))
    assert "saved" not in summary_line(survey(kept))
    starts = [s.start.position[0] for s in kept.segments if s.light is not None]
    np.testing.assert_allclose(np.diff(starts) * 500, [30, -20, 40, -30, 40, -20], atol=1e-9)
    with pytest.raises(ScriptError, match="E109"):
        drawn("order drawn")

"""The order of lines: what touches is joined, and the dark ways get no longer."""

import numpy as np
import pytest

from dqpaint.language.imports import stroke_order
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
    ((whole, colour),) = stroke_order.order_lines(lines)
    assert colour == RED
    way = corners(whole)
    assert way in ([(0, 0), (1, 0), (2, 0), (2, 5)], [(2, 5), (2, 0), (1, 0), (0, 0)])


def test_colours_stay_apart_and_closed_lines_alone() -> None:
    lines = [
        (line((0, 0), (1, 0)), RED),
        (line((1, 0), (2, 0)), BLUE),
        (line((1, 0), (1, 9)), None),
    ]
    assert len(stroke_order.order_lines(lines)) == 3
    square = line((0, 0), (1, 0), (1, 1), (0, 0))
    assert len(stroke_order.order_lines([(square, RED), (line((0, 0), (-5, 0)), RED)])) == 2


def test_a_ring_of_lines_closes() -> None:
    lines = [(line((0, 0), (1, 0)), RED), (line((1, 1), (1, 0)), RED), (line((1, 1), (0, 0)), RED)]
    ((whole, _),) = stroke_order.order_lines(lines)
    assert corners(whole)[0] == corners(whole)[-1]
    assert len(whole.cubic) == 3


def test_where_lines_cross_they_go_straight_on() -> None:
    arms = [((1, 0), (0, 0)), ((0, 1), (0, 0)), ((0, 0), (-1, 0)), ((0, 0), (0, -1))]
    ways = [
        corners(curve) for curve, _ in stroke_order.order_lines([(line(*arm), RED) for arm in arms])
    ]
    assert len(ways) == 2
    for way in ways:
        (a, b), (c, d) = np.diff(way, axis=0)
        assert a * d == b * c
        assert a * c + b * d > 0


def test_a_small_gap_is_closed_a_larger_one_is_not() -> None:
    def count(gap: float) -> int:
        lines = [(line((0, 0), (1, 0)), RED), (line((1 + gap, 0), (2, 0)), RED)]
        made = stroke_order.order_lines(lines)
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
        made = stroke_order.order_lines(lines)
        assert len(made) == count
        assert dark(made) <= dark(lines)
        both = [{frozenset(map(tuple, corners(c))) for c, _ in some} for some in (lines, made)]
        assert both[0] == both[1]
    assert dark(made) < 0.15 * dark(lines)


def test_a_good_order_is_kept() -> None:
    lines = [(line((i, 0), (i + 0.5, 0)), None) for i in range(9)]
    assert [corners(c) for c, _ in stroke_order.order_lines(lines)] == [
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
    monkeypatch.setattr(stroke_order, "MOST_TURNED", 0)
    lines = [(line((x, 0), (x, 1e-3)), None) for x in (0, -1, 0.9, 10)]
    assert [c.cubic[0, 0, 0] for c, _ in stroke_order.order_lines(lines)] == [0, -1, 0.9, 10]


def test_turning_stretches_round_helps(rng: np.random.Generator) -> None:
    lines = scattered(rng, 300)
    ends = np.array([piecewise.ends(curve) for curve, _ in lines])
    near = stroke_order._nearest(ends)
    better = stroke_order._turned(ends, *near)
    assert sorted(better[0]) == list(range(300))
    assert stroke_order._dark(ends, *better) < 0.97 * stroke_order._dark(ends, *near)


@pytest.mark.slow
def test_twenty_thousand_lines(rng: np.random.Generator) -> None:
    lines = scattered(rng, 20_000)
    assert dark(stroke_order.order_lines(lines)) < 0.05 * dark(lines)

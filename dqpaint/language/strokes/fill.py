"""Closed strokes -> the hatching inside them: lines from side to side, strung to few strokes."""

import math
from collections import defaultdict
from collections.abc import Sequence

import numpy as np

from dqpaint.diagnostics import problem
from dqpaint.language.imports import stroke_order
from dqpaint.language.syntax.tree import Statement
from dqpaint.language.values import typed_values
from dqpaint.language.values.scope import Scope
from dqpaint.program import Colour, Floats, PiecewiseCurve, piecewise

ColouredCurve = tuple[PiecewiseCurve, Colour | None]

CLOSED = 1e-6  # of its size: as near are the ends of a closed stroke
TURN = 256  # chords of a full circle
BEND = 32  # of a Bezier curve
SHORTEST = 1e-3  # of the spacing: shorter lines, as at a corner, are left out
MOST_LINES = 5000  # from one side of the whole to the other
MOST_CROSSINGS = 1_000_000  # of lines and outlines
Row = list[tuple[float, float]]  # left and right ends of the hatching at one height


def filled(
    statement: Statement, scope: Scope, lines: Sequence[ColouredCurve], scale: float
) -> list[ColouredCurve]:
    """The lines and, if the statement has a `fill`, the hatching inside those that are closed.

    Inside is what an odd number of the strokes of one colour go around, as in a letter with holes.

    Args:
        statement: with `fill`, the distance between the lines, and optionally `angle`.
        scope: of its values.
        lines: in the plane of x and y.
        scale: of the lines, to metres.
    """
    node, angle = statement.value("fill"), statement.value("angle")
    if node is None:
        return list(lines)
    spacing = typed_values.positive(node, scope, "fill") / scale
    turn = typed_values.number(angle, scope, "angle") if angle else 0.0
    outlines: dict[Colour | None, list[PiecewiseCurve]] = defaultdict(list)
    for curve, colour in stroke_order.order_lines(list(lines)).lines:  # joined where they touch
        start, end = np.array(piecewise.ends(curve))
        least, most = piecewise.bounding_box([curve])
        if np.abs(end - start).max() <= CLOSED * (most - least).max():
            outlines[colour].append(curve)
    if not outlines:
        message = f"this '{statement.word}' has no closed line, so nothing is inside"
        help = "a closed line ends where it begins"
        raise problem("E269", message, node.span, "", help)
    out = list(lines)
    for colour, curves in outlines.items():
        edges = np.concatenate([chords(curve) for curve in curves])
        size = float(np.ptp(edges.reshape(-1, 2), axis=0).max())
        if size / spacing > MOST_LINES:
            message = f"this fill would have more than {MOST_LINES:,} lines"
            help = f"the least is: fill {math.ceil(1e6 * size * scale / MOST_LINES) / 1e3:g} mm"
            raise problem("E269", message, node.span, "", help)
        if crossings(edges, spacing, turn) > MOST_CROSSINGS:
            message = f"the lines of this fill would meet its outlines {MOST_CROSSINGS:,} times"
            raise problem("E269", message, node.span, "", "a larger distance has fewer lines")
        made = [(piecewise.straight(way), colour) for way in hatch(edges, spacing, turn)]
        out += stroke_order.order_lines(made).lines if made else []
    return out


def chords(curve: PiecewiseCurve) -> Floats:
    """The sides (N, 2, 2) of a polygon through points of a closed curve, seen along z."""
    bent = np.any(curve.cubic[:, 2:] != 0.0, axis=(1, 2))
    turned = np.any(curve.ellipse != 0.0, axis=(1, 2))
    count = np.where(bent, BEND, 1)
    round_ = np.ceil(np.abs(curve.angles[:, 1]) / (2.0 * math.pi) * TURN).astype(int)
    count = np.maximum(count, np.where(turned, round_, 1))
    piece = np.repeat(np.arange(len(count)), count)
    within = np.arange(len(piece)) - np.repeat(np.cumsum(count) - count, count)
    points = piecewise.derivatives(curve, piece, within / count[piece])[0][:, :2]
    return np.stack([points, np.roll(points, -1, axis=0)], axis=1)


def crossings(edges: Floats, spacing: float, angle: float) -> float:
    """About how often lines of a hatching meet the edges (N, 2, 2) of polygons."""
    way = edges[:, 1] - edges[:, 0]
    return float(np.abs(way @ (-math.sin(angle), math.cos(angle))).sum()) / spacing


def hatch(edges: Floats, spacing: float, angle: float) -> list[Floats]:
    """The strokes (N, 3) of the hatching inside closed polygons.

    Args:
        edges: of the polygons (N, 2, 2); inside is what an odd number of them lie around.
        spacing: of the lines, which lie on one grid whatever the polygons are.
        angle: of the lines [rad], left from x.
    """
    cosine, sine = math.cos(angle), math.sin(angle)
    back = np.array([[cosine, sine], [-sine, cosine]])  # rows: along the lines, across
    x, y = np.moveaxis(edges @ back.T, 2, 0)
    # Line k is at (k + 1/2) spacing. An edge has its lower end and not its upper one, so that a
    # corner counts once and an edge along the lines not at all.
    first, end = np.ceil(np.sort(y, axis=1) / spacing - 0.5).astype(np.int64).T
    count = end - first
    edge = np.repeat(np.arange(len(edges)), count)
    line = np.arange(len(edge)) - np.repeat(np.cumsum(count) - count, count) + first[edge]
    share = ((line + 0.5) * spacing - y[edge, 0]) / (y[edge, 1] - y[edge, 0])
    crossing = x[edge, 0] + share * (x[edge, 1] - x[edge, 0])
    order = np.lexsort((crossing, line))
    ends, lines = crossing[order].reshape(-1, 2), line[order][::2]
    rows: dict[int, Row] = defaultdict(list)
    for number, (left, right) in zip(lines.tolist(), ends.tolist(), strict=True):
        if right - left > SHORTEST * spacing:
            rows[number].append((left, right))
    ways = [np.array(way) * (1.0, spacing) @ back for way in _strung(rows)]
    return [np.column_stack([way, np.zeros(len(way))]) for way in ways]


def _strung(rows: dict[int, Row]) -> list[list[tuple[float, float]]]:
    """Lines to and fro, as long as one lies beside the next alone; (x, height / spacing) each."""
    ways: list[list[tuple[float, float]]] = []
    before: list[int] = []  # the way that each line of the row below belongs to
    for number in sorted(rows):
        row, below = rows[number], rows.get(number - 1, [])
        beside = [_beside(below, here) for here in row]
        above = [_beside(row, there) for there in below]
        now = []
        for i, (left, right) in enumerate(row):
            alone = len(beside[i]) == 1 and len(above[beside[i][0]]) == 1
            way = before[beside[i][0]] if alone else len(ways)
            if not alone:
                ways.append([])
            from_left = len(ways[way]) // 2 % 2 == 0
            height = number + 0.5
            pair = (left, height), (right, height)
            ways[way] += pair if from_left else pair[::-1]
            now.append(way)
        before = now
    return ways


def _beside(row: Row, line: tuple[float, float]) -> list[int]:
    """Which lines of a row overlap another line."""
    return [i for i, (left, right) in enumerate(row) if left < line[1] and line[0] < right]

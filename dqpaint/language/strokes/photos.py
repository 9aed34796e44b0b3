"""Photographs -> segments: the strokes of a style, and what is wanted of their light.

How brightly they shine is not said here: it is solved for once the motion is known, see
`light.inverse`; until then they shine evenly.
"""

import hashlib
import math
from functools import lru_cache

import numpy as np

from dqpaint.core.arrays import Floats
from dqpaint.diagnostics import problem
from dqpaint.language.imports.file_access import contents
from dqpaint.language.pen.pen import Pen
from dqpaint.language.strokes import imported_strokes
from dqpaint.language.syntax.tree import Literal, Name, Quoted, Statement
from dqpaint.language.values import typed_values, vectors
from dqpaint.language.values.scope import Scope
from dqpaint.program import (
    Colour,
    Photo,
    PiecewiseCurve,
    colours,
    piecewise,
)

LONG_SIDE = 0.2  # [m] of a photo that says no size
LINES = 200  # distances between strokes on the longer side, unless `detail` says it
DARK = 0.05  # sRGB tone below which it stays black
FINEST = 5000  # distances between strokes on the longer side at most
MOST_LAMPS = 1  # colours of a lamp that has not all of them
SLACK = 1.03  # of `max`, for turns and ends
COARSEST = 0.25  # of the shorter side that strokes may be apart
COARSER = 4  # times that `detail` is made coarser for `max`


def photo(statement: Statement, pen: Pen, scope: Scope) -> None:
    """`photo`: the strokes of a style over a photograph, centred at `at`."""
    (node,) = statement.values
    style = statement.value("as")
    assert isinstance(node, Quoted)
    assert isinstance(style, Name)
    if pen.state.light is None:
        part = statement.part("light")
        span = part.span if part else statement.span
        raise problem("E297", "a photo is painted with light, and it is off", span)
    picture = _read(node, pen)
    high, wide = picture.shape[:2]
    sized = statement.part("height") or statement.part("width")
    scale = LONG_SIDE / max(high, wide)
    if sized:
        scale = imported_strokes.scale_to(statement, scope, (float(wide), float(high)))
    width, height = scale * wide, scale * high
    shift = imported_strokes.place_of(statement, pen, scope, np.zeros(3))
    curves, detail = _curves(statement, pen, scope, picture, (width, height))
    number = len(pen.photos) + 1
    lamp, shade = _lamp(statement, pen)
    traces = imported_strokes.placed([(curve, None) for curve in curves], pen, 1.0, shift)
    traces = [trace._replace(photo=number, colour=shade) for trace in traces]
    corner = pen.frame.vector((-0.5 * width, -0.5 * height, 0.0))
    pen.photos.append(
        Photo(
            name=node.text,
            picture=picture,
            corner=vectors.plus(shift, corner),
            right=pen.frame.vector((width, 0.0, 0.0)),
            up=pen.frame.vector((0.0, height, 0.0)),
            colours=lamp,
            colour=shade,
            style=style.name,
            detail=detail * pen.frame.scale,
            span=statement.span,
        )
    )
    imported_strokes.draw_traces(statement, pen, scope, traces)


def _read(node: Quoted, pen: Pen) -> Floats:
    from dqpaint.photo import MOST_BYTES, PhotoError

    data = contents(node, pen, MOST_BYTES)
    try:
        return _decoded(hashlib.sha256(data).digest(), data)
    except PhotoError as fault:
        raise problem("E297", f"{node.text} {fault}", node.span, "", fault.help) from None


@lru_cache(maxsize=2)  # as in a `repeat`
def _decoded(_key: bytes, data: bytes) -> Floats:
    from dqpaint.photo import read

    return read(data)


def _curves(
    statement: Statement, pen: Pen, scope: Scope, picture: Floats, size: tuple[float, float]
) -> tuple[list[PiecewiseCurve], float]:
    """The curves of the style, and the distance between them; coarser if `max` asks for it."""
    from dqpaint.photo import STYLES, Subject

    style, node = statement.value("as"), statement.value("detail")
    assert isinstance(style, Name)
    detail = typed_values.positive(node, scope, "detail") if node else max(size) / LINES
    wrong = f"finer than a {FINEST}th" if max(size) / detail > FINEST else ""
    wrong = "coarser than a quarter" if detail > COARSEST * min(size) else wrong
    if wrong and node:
        help = f"for example: {1e3 * max(size) / LINES:.2g} mm"
        raise problem("E297", f"this is {wrong} of the photo", node.span, "", help)
    dark, angle = statement.value("dark"), statement.value("angle")
    share = dark.value if isinstance(dark, Literal) else DARK
    turn = typed_values.number(angle, scope, "angle") if angle else 0.0
    limit = statement.value("max")
    most = typed_values.positive(limit, scope, "max") if limit else math.inf
    asked = detail
    for _ in range(COARSER):
        subject = Subject(picture, *size, detail, share, turn, statement.part("cross") is not None)
        curves = STYLES[style.name](subject)
        if not curves:
            message = "nothing of this photo is bright enough"
            help = "a lower dark, or a brighter photo"
            raise problem("E297", message, statement.span, "", help)
        seconds = SLACK * sum(piecewise.lengths(curves)) * pen.frame.scale / pen.state.speed
        if seconds <= most:
            break
        detail *= seconds / most
        if detail > COARSEST * min(size):
            assert limit is not None
            least = seconds * asked / (COARSEST * min(size))
            message = (
                f"in this time it would be too coarse: it takes {max(least, 1.0):.0f} s or more"
            )
            raise problem("E297", message, limit.span, "", "a higher speed, or a smaller photo")
    if detail > asked:
        assert limit is not None
        message = f"within this time its strokes are {1e3 * detail:.2g} mm apart"
        help = f"not {1e3 * asked:.2g} mm: a higher speed, or a longer max, keeps them"
        pen.warn("W423", message, limit.span, "", help)
    return curves, detail


def _lamp(statement: Statement, pen: Pen) -> tuple[int | None, Colour]:
    """How many colours the lamp has (None: any), and the colour of a lamp that has one."""
    node = statement.value("colours")
    if node is None or isinstance(node, Name):
        return None, colours.WHITE
    assert isinstance(node, Literal)
    assert pen.state.light is not None
    if node.value != MOST_LAMPS:
        help = "colours 1 is the light that holds, dimmed; colours full any colour"
        raise problem("E297", "a lamp has one colour, or any", node.span, "", help)
    return 1, pen.state.light.first

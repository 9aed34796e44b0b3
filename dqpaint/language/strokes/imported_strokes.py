"""Text, tables of points and SVG drawings -> segments.

What is drawn without lifting the pen is one stroke, a `program.PiecewiseCurve`: it runs through its
corners without a stop, and its light is even, so that nothing in it glows but what crosses.
"""

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from dqpaint.core import replaced
from dqpaint.diagnostics import Diagnostic, ErrorLimitError, Fix, Problem, Span, closest, problem
from dqpaint.language.imports import lettering
from dqpaint.language.pen import tool_orientation
from dqpaint.language.pen.durations import divide_timing, timing
from dqpaint.language.pen.pen import FARTHEST, SAME_PLACE, Pen, pose_problem
from dqpaint.language.pen.stroke_state import TurnTo
from dqpaint.language.strokes.curves import GAP
from dqpaint.language.strokes.fill import filled
from dqpaint.language.syntax.tree import Name, Quoted, Statement
from dqpaint.language.values import typed_values, vectors
from dqpaint.language.values.scope import Scope
from dqpaint.language.vocabulary.units import UNITS
from dqpaint.program import (
    LOOK_MODES,
    Colour,
    FixedOrientation,
    Floats,
    FollowHeading,
    Light,
    PiecewiseCurve,
    Pose,
    Timing,
    Vector,
    colours,
    piece_corners,
    piecewise,
)

SMALLEST = 1e-6  # [m] that a text, a path or an SVG is made to fit
MOST_PIECES = 2_000_000  # lines, curves and arcs, of all statements
LOOKED_AT = 20_000  # places of a stroke, where a tool that looks is looked at


class Trace(NamedTuple):
    """A line drawn without lifting the pen, and its own colour, if it has one."""

    curve: PiecewiseCurve
    colour: Colour | None = None
    photo: int = 0


# The three statements.


def text(statement: Statement, pen: Pen, scope: Scope) -> None:
    """`text`: one line of letters for each text; `height` is that of a capital."""
    nodes = [node for node in statement.values if isinstance(node, Quoted)]
    lines = tuple(node.text for node in nodes)
    font = _font(statement)
    if sum(map(len, lines)) > lettering.LONGEST:
        message = f"a text has at most {lettering.LONGEST:,} letters"
        label = f"this has {sum(map(len, lines)):,}"
        raise problem("E262", message, nodes[0].span, label, "write it in several statements")
    for number, place in lettering.missing(lines, font):
        raise _no_letter(nodes[number], place, font)
    align = statement.value("align")
    made = lettering.lay_out(lines, font.name, align.name if isinstance(align, Name) else "left")
    if not made.strokes:
        help = "to wait, use: hold 1 s"
        raise problem("E262", "this text has no letters", nodes[0].span, "", help)
    scale = scale_to(statement, scope, (made.width, font.cap))
    at = statement.value("at")
    shift = (
        pen.pose.position if at is None else pen.frame.point(typed_values.place(at, scope, "at"))
    )
    if at is not None:
        pen.lost = False
    strokes = filled(statement, scope, [(curve, None) for curve in made.strokes], scale)
    draw_traces(statement, pen, scope, placed(strokes, pen, scale, shift))


def path(statement: Statement, pen: Pen, scope: Scope) -> None:
    """`path`: a line through the points of a file, at its own position or fitted."""
    nodes = [node for node in statement.values if isinstance(node, Quoted)]
    from dqpaint.language.imports import point_files

    points = point_files.read(nodes, pen)
    new = np.concatenate([[True], np.any(np.diff(points, axis=0) != 0.0, axis=1)])
    points = points[new]
    if len(points) < 2:
        help = "to wait, use: hold 1 s"
        pen.warn("W401", "this path has no length", nodes[0].span, "", help)
        return
    curve = piecewise.straight(points)
    if statement.part("smooth"):
        curve = piecewise.smooth_curve(points)
    unit = statement.value("unit")
    if isinstance(unit, Name):
        scale, origin = UNITS[unit.name][0], np.zeros(3)
    else:
        scale, origin = _fitted(statement, pen, scope, [curve])
    shift = place_of(statement, pen, scope, scale * origin)
    (trace,) = placed([(curve, None)], pen, scale, shift)
    start = piecewise.ends(trace.curve)[0]
    gap = vectors.length(vectors.minus(start, pen.pose.position))
    if pen.started and gap > GAP and not statement.part("at") and not pen.in_stroke:
        message = f"the path starts {1e3 * gap:.3g} mm away from where the tool is"
        help = "a light-off move is added; write a move to choose its speed"
        pen.warn("W402", message, nodes[0].span, "", help)
    draw_traces(statement, pen, scope, [trace])


def svg(statement: Statement, pen: Pen, scope: Scope) -> None:
    """`svg`: a drawing's lines in its own colours, centred at `at`."""
    (node,) = statement.values
    assert isinstance(node, Quoted)
    from dqpaint.language.imports.svg import reader

    drawing = reader.read(node, pen, statement.part("order") is not None)
    loose = [curve for curve, _ in drawing.lines]
    scale, origin = _fitted(statement, pen, scope, loose)
    shift = place_of(statement, pen, scope, scale * origin)
    lines = filled(statement, scope, drawing.lines, scale)
    pen.dark_saved += drawing.saved * scale * pen.frame.scale
    draw_traces(statement, pen, scope, placed(lines, pen, scale, shift))


# Where and how large.


def _font(statement: Statement) -> lettering.Font:
    node = statement.value("font")
    if not isinstance(node, Quoted):
        return lettering.read_font(lettering.PLAINEST)
    known = lettering.font_names()
    if node.text not in known:
        meant = closest(node.text, known)
        question = f'did you mean "{meant}"?' if meant else f"the fonts are: {', '.join(known)}"
        fix = Fix(f'write "{meant}"', node.span, f'"{meant}"') if meant else None
        help = f"{question} (dqpaint list fonts shows all)" if meant else question
        raise problem("E260", f'there is no font "{node.text}"', node.span, "", help, fix)
    return lettering.read_font(node.text)


def _no_letter(node: Quoted, place: int, font: lettering.Font) -> Problem:
    letter = node.text[place]
    span = Span(node.span.start + 1 + place, node.span.start + 2 + place)
    shown = f"'{letter}'" if letter.isprintable() else f"U+{ord(letter):04X}"
    instead, others = lettering.with_substitutes(node.text, font), lettering.fonts_with(letter)
    cures = []
    if instead.strip():
        cures.append(f'use "{instead}"')
    if others:
        cures.append(f'font "{others[0]}" has it')
    help = (
        ", or: ".join(cures)
        or "take it away; the fonts have Latin letters with their accents, and Greek"
    )
    fix = Fix(f'write "{instead}"', node.span, f'"{instead}"') if instead.strip() else None
    message = f'font "{font.name}" has no letter {shown}'
    return problem("E261", message, span, "here", help, fix)


def scale_to(statement: Statement, scope: Scope, size: tuple[float, float]) -> float:
    """The largest scale with which (width, height) is no larger than the given size."""
    scales = []
    for word, extent in zip(("width", "height"), size, strict=True):
        node = statement.value(word)
        if node is None:
            continue
        wanted = typed_values.positive(node, scope, word)
        if wanted < SMALLEST:
            message = f"'{word}' needs at least {SMALLEST * 1e3:g} mm: no arm draws finer"
            raise problem("E220", message, node.span, f"this is {wanted * 1e3:.3g} mm")
        if extent > 0.0:
            scales.append(wanted / extent)
        elif not statement.value("height" if word == "width" else "width"):
            message = f"its {word} is 0, so it can't be scaled to {scope.written(node)}"
            other = "height" if word == "width" else "width"
            raise problem("E263", message, node.span, "", f"say its {other} instead")
    return min(scales, default=1.0)


def _fitted(
    statement: Statement, pen: Pen, scope: Scope, loose: list[PiecewiseCurve]
) -> tuple[float, Floats]:
    """The scale of a drawing, and minus the middle of its box."""
    least, most = piecewise.bounding_box(loose)
    width, height, _ = (most - least).tolist()
    return scale_to(statement, scope, (width, height)), -0.5 * (least + most)


def place_of(statement: Statement, pen: Pen, scope: Scope, origin: Floats) -> Vector:
    """The position of the file's own origin, in the drawing frame."""
    at = statement.value("at")
    x, y, z = typed_values.place(at, scope, "at") if at is not None else vectors.ZERO
    pen.lost = False
    a, b, c = origin.tolist()
    return pen.frame.point((x + a, y + b, z + c))


def placed(
    lines: Sequence[tuple[PiecewiseCurve, Colour | None]], pen: Pen, scale: float, shift: Vector
) -> list[Trace]:
    """Lines in the drawing frame."""
    columns = [pen.frame.vector(axis) for axis in ((1.0, 0.0, 0.0), vectors.Y, vectors.Z)]
    whole, starts, _ = piecewise.concatenate([curve for curve, _ in lines])
    there = piecewise.transform(whole, scale * np.array(columns).T, np.array(shift))
    colours_of = (colour for _, colour in lines)
    return list(map(Trace, piecewise.split(there, starts), colours_of))


# The strokes.


def draw_traces(statement: Statement, pen: Pen, scope: Scope, traces: list[Trace]) -> None:
    """The strokes one after the other, with dark moves between them.

    Time and a gradient of the light are spread over all by their lengths: the time over the ways
    between the strokes, too, but not over the way to the first.
    """
    traces = _rounded(traces, pen)
    mode, span = pen.state.tool, statement.span
    if isinstance(mode, FollowHeading):
        message = f"the tool can't follow a '{statement.word}': it would jump at every corner"
        help, part = "use: tool keep", statement.part("tool")
        if statement.word in ("circle", "ellipse"):
            message = f"the tool can't follow a '{statement.word}'"
            help = "use: tool keep; a tool can follow: arc centre POINT angle 360 deg"
        raise pose_problem("E254", message, part.value.span if part else span, "", help)
    pen.pieces += sum(len(trace.curve.cubic) for trace in traces)
    check_pieces(pen.pieces, pen, span)
    if not piecewise.largest_coordinate([trace.curve for trace in traces]) <= FARTHEST:
        raise pose_problem("E201", "this goes too far away", span)
    ends = piecewise.all_ends([trace.curve for trace in traces]).tolist()
    starts, stops = ([_vector(pair[side]) for pair in ends] for side in (0, 1))
    if pen.stroke is not None and len(traces) > 1:
        raise _pen_up_error(statement, len(traces))
    _set_start(pen, starts[0], span)
    lengths = piecewise.lengths([trace.curve for trace in traces])
    ways = [
        vectors.length(vectors.minus(b, a))
        for a, b in zip(stops, (*starts[1:], stops[-1]), strict=True)
    ]
    times = _times(timing(statement, pen.state, scope), lengths, ways, span)
    glows = _stroke_lights(statement, pen, traces, lengths)
    for number, trace in enumerate(traces):
        _travel(pen, starts[number], span, times[2 * number - 1] if number else None)
        tool_orientation.look_at_start(pen, mode, span)
        if isinstance(mode, LOOK_MODES):
            tool_orientation.check_orientations(mode, _places(trace.curve), span)
        tool, orientation = tool_orientation.orientation_at_end(
            pen, mode, stops[number], span, vectors.Z, 0.0
        )
        end = Pose(stops[number], orientation)
        pen.draw(trace.curve, tool, times[2 * number], glows[number], end, span)


def _rounded(traces: list[Trace], pen: Pen) -> list[Trace]:
    """The lines with their corners rounded, as far as `blend` or `corner` says so."""
    distance, deviation = pen.state.blend * pen.frame.scale, pen.deviation
    if not distance and not deviation:
        return traces
    whole, starts, _ = piecewise.concatenate([trace.curve for trace in traces])
    made = piecewise.split(*piece_corners.rounded(whole, starts, deviation, distance))
    return [trace._replace(curve=curve) for curve, trace in zip(made, traces, strict=True)]


def check_pieces(pieces: int, pen: Pen, span: Span) -> None:
    """Raises if the program would have too many pieces."""
    if pieces > MOST_PIECES:
        message = f"more than {MOST_PIECES:,} pieces of lines from elsewhere in all"
        help = "draw it less often, or with fewer points"
        pen.findings.add(Diagnostic("E299", message, span, "", help))
        raise ErrorLimitError


def _pen_up_error(statement: Statement, count: int) -> Problem:
    """An error: a `stroke` never stops, so the pen can't be lifted in it."""
    word = statement.word
    message = f"this '{word}' lifts its pen between its {count} lines, and a 'stroke' does not stop"
    span = Span(statement.span.start, statement.span.start + len(word))
    help = (
        f"write it outside of the stroke: each of its lines runs through by itself; {word} … in 5 s"
    )
    return problem("E283", message, span, "", help)


def _set_start(pen: Pen, start: Vector, span: Span) -> None:
    """Starts the drawing here if its start is not set."""
    if pen.started:
        return
    pen.started, pen.moved = True, span
    pen.start_at(start, tool_orientation.orientation_of_mode(pen.state.tool, start, span))


def _times(whole: Timing, lengths: list[float], ways: list[float], span: Span) -> list[Timing]:
    """The time of each stroke and of the move after it, alternating."""
    both = [size for pair in zip(lengths, ways, strict=True) for size in pair]
    there = [i for i, size in enumerate(both) if size > SAME_PLACE]
    given = iter(divide_timing(whole, [both[i] for i in there], span))
    return [next(given) if size > SAME_PLACE else whole for size in both]


def _stroke_lights(
    statement: Statement, pen: Pen, traces: list[Trace], lengths: list[float]
) -> list[Light | None]:
    """The light of each stroke: the clause's, else its own colour, else the current one."""
    light = pen.state.light
    done = np.concatenate([[0.0], np.cumsum(lengths)]) / sum(lengths)
    out: list[Light | None] = []
    for number, trace in enumerate(traces):
        if trace.photo:
            shade = trace.colour or colours.WHITE
            out.append(Light(shade, shade, True, trace.photo))
        elif trace.colour is not None and statement.part("light") is None:
            out.append(Light(trace.colour, trace.colour, even=True))
        elif light is None:
            out.append(None)
        else:
            own = light.part(float(done[number]), float(done[number + 1]))
            out.append(replaced(own, even=True))
    return out


def _travel(pen: Pen, to: Vector, span: Span, time: Timing | None) -> None:
    """The dark move to a stroke; a tool that rotates or looks does so on it."""
    mode = pen.state.tool
    far = vectors.length(vectors.minus(to, pen.pose.position)) > SAME_PLACE
    wanted = mode.orientation if isinstance(mode, TurnTo) else pen.pose.orientation
    tool, orientation = tool_orientation.rotation_between(pen.pose.orientation, wanted)
    if far and not isinstance(mode, FixedOrientation | TurnTo):
        tool_orientation.look_at_start(pen, mode, span)
        tool, orientation = tool_orientation.orientation_at_end(pen, mode, to, span, vectors.Z, 0.0)
    if far or not isinstance(tool, FixedOrientation):
        pen.check_no_stop(span)
        pen.travel(to, span, tool, orientation, time, pen.state.dark_way)


def _vector(numbers: list[float]) -> Vector:
    x, y, z = numbers
    return x, y, z


def _places(curve: PiecewiseCurve) -> list[Vector]:
    """Points along a whole curve."""
    count = len(curve.cubic)
    whole = np.linspace(0.0, count, min(16 * count, LOOKED_AT), endpoint=False)
    at = piecewise.derivatives(curve, whole.astype(np.intp), whole % 1.0)[0]
    return [(x, y, z) for x, y, z in at.tolist()]

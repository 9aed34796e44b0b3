"""Current pose of the tool and its strokes so far -> segments of the program."""

import math
from dataclasses import replace
from pathlib import Path as FilePath

from dqpaint.core import record, replaced
from dqpaint.diagnostics import (
    Diagnostic,
    DiagnosticCollector,
    ErrorLimitError,
    SourceLine,
    Span,
    UnknownPositionProblem,
    file_at,
    file_number,
    problem,
)
from dqpaint.language.pen.stroke_state import (
    CORNER,
    REST_TO_REST,
    StrokeState,
    TurnTo,
)
from dqpaint.language.syntax.tree import Part
from dqpaint.language.values import vectors
from dqpaint.language.vocabulary.words import PARTS, TIMING_WORDS
from dqpaint.program import (
    IDENTITY,
    STANDING,
    ContinuousStroke,
    CruiseSpeed,
    Dwell,
    FixedOrientation,
    Light,
    Look,
    LookLine,
    Path,
    Photo,
    PiecewiseCurve,
    Pose,
    Profile,
    Quaternion,
    Segment,
    SlerpOrientation,
    Step,
    Straight,
    Timing,
    Tool,
    Vector,
)

MOST_SEGMENTS = 50_000
FARTHEST = 1e9  # [m]
SAME_PLACE = 1e-12  # [m] below this two points are one
SAME_TURN = 1e-12  # [rad] below this two orientations are one
LOOKS_ALREADY = 1e-9  # [rad] what rounding may leave between a look and the stroke before


@record
class Rounding:
    """How the end of a segment is rounded, where the next one goes on from there.

    Attributes:
        blend: within what distance [m]; 0 for not at all.
        deviation: how far from the corner [m], within a stroke that is not blended.
        acceleration: of what is joined by `blend` [m/s^2]; 0 for its profile alone.
    """

    blend: float = 0.0
    deviation: float = 0.0
    acceleration: float = 0.0


NOT_ROUNDED = Rounding()


class Pen:
    """The state of the drawing; `state` and `frame` are set from outside."""

    def __init__(
        self, name: str, text: str, findings: DiagnosticCollector, path: FilePath | None = None
    ) -> None:
        self.file = name, text
        self.path = path  # of the main file, if the text is one
        self.text = text
        self.findings = findings
        self.state = StrokeState()
        self.frame = vectors.WORLD
        self.pose = IDENTITY
        self.start = IDENTITY
        self.segments: list[Segment] = []
        self.corners: list[Rounding] = []  # at the end of each
        self.stroke: ContinuousStroke | None = None  # of the `stroke` that is being drawn
        self._strokes = 0
        self.pieces = 0  # of curves
        self.dark_saved = 0.0  # [m] of dark ways, by the order of lines that come from elsewhere
        self.photos: list[Photo] = []
        self.placed = False  # the file has set the start of the drawing
        self.started = False  # something has moved
        self.oriented = False  # the file has set the orientation at the start
        self.moved = Span(0, 0)  # the first movement
        self.lost = False  # after a mistake in a movement nobody knows where the tool is
        self._lines = _LineCounter(text)

    def begin(self, span: Span) -> None:
        """Settles the start pose before a movement."""
        if self.started:
            return
        self.started, self.moved = True, span
        mode = self.state.tool
        if isinstance(mode, TurnTo) and not self.oriented:
            self._adopt(mode.orientation)

    def start_at(self, position: Vector, orientation: Quaternion | None) -> None:
        """Sets the start of the drawing, and optionally its orientation."""
        self.placed = True
        self.pose = self.start = Pose(position, orientation or self.pose.orientation)
        self.oriented = self.oriented or orientation is not None

    def _adopt(self, orientation: Quaternion) -> None:
        self.pose = self.start = Pose(self.pose.position, orientation)
        self.oriented = True

    def line_of(self, span: Span) -> SourceLine:
        """The line of some words."""
        return self._lines.line(span)

    def draw(
        self, path: Path, tool: Tool, timing: Timing, light: Light | None, end: Pose, span: Span
    ) -> None:
        """Adds a stroke from the current pose to `end`."""
        if len(self.segments) >= MOST_SEGMENTS:
            self.findings.add(_too_many(span))
            raise ErrorLimitError
        if max(map(abs, end.position)) > FARTHEST:
            raise pose_problem("E201", "this ends too far away", span)
        line, words = self._lines.line(span), first_line(self.text, span)
        state, stroke = self.state, self.stroke
        if stroke is not None:
            self._check_moves(path, span)
            timing = stroke.timing
        profile = stroke.profile if stroke is not None else state.profile
        if isinstance(path, PiecewiseCurve) and stroke is None:
            profile = state.through_corners
        if profile.acceleration:
            light = evenly(light)
        brush, strobe, start = state.brush, state.strobe, self.pose
        jumps = state.corner is not None and state.corner.jump
        self.segments.append(
            Segment(
                *(path, tool, profile, timing, light, start, end, words, line),
                *(brush, strobe, stroke, jumps),
            )
        )
        self.corners.append(self._rounding())
        self.pose = end
        self.oriented = True

    @property
    def deviation(self) -> float:
        """How far the path may be from a corner that is run through [m]; 0 for not at all."""
        corner = self.state.look_ahead
        if corner is None or corner is CORNER:
            return 0.0 if corner is None else corner.deviation
        return corner.deviation * self.frame.scale

    def _rounding(self) -> Rounding:
        state = self.state
        if not state.blend and self.stroke is None:
            return NOT_ROUNDED
        deviation = self.deviation if self.stroke is not None else 0.0
        return Rounding(state.blend * self.frame.scale, deviation, state.acceleration)

    # Strokes of several lines.

    @property
    def in_stroke(self) -> bool:
        """Whether the movements of a `stroke` have begun."""
        segments = self.segments
        return self.stroke is not None and bool(segments) and segments[-1].stroke is self.stroke

    def check_no_stop(self, span: Span) -> None:
        """Raises if an automatic move or rotation would interrupt a `stroke`."""
        if self.in_stroke:
            message = "the tool would have to stop within this stroke"
            help = "let this line begin where the one before it ends, and the tool look there"
            raise pose_problem("E283", message, span, "", help)

    def begin_stroke(self, timing: Timing, light: Light | None) -> None:
        """Begins segments that share a profile, and `light` if it is a gradient."""
        self._strokes += 1
        profile = self.state.through_corners
        self.stroke = ContinuousStroke(self._strokes, profile, timing, light)

    def check_no_time(self, part: Part) -> None:
        """Raises if a movement within a `stroke` has a time of its own."""
        if self.stroke is not None and part.word in TIMING_WORDS:
            message = f"'{part.word}' belongs to the whole stroke"
            help = f"write it on its first line: stroke {PARTS[part.word].example}"
            raise problem("E281", message, part.span, "", help)

    def _check_moves(self, path: Path, span: Span) -> None:
        """Raises if the point rests within a `stroke`."""
        if isinstance(path, STANDING) or path == Straight(vectors.ZERO):
            what = {Dwell: "a pause", Step: "a jump"}.get(type(path), "a turn on the spot")
            message = f"{what} can't be part of a stroke, which does not stop"
            raise problem("E282", message, span, "", "end the stroke before it")

    def warn(self, code: str, message: str, span: Span, label: str = "", help: str = "") -> None:
        """Warns of an assumption, unless it only follows from an earlier error."""
        follows = self.lost or (code == "W401" and self.findings.error_before(span))
        if not follows:
            self.findings.add(Diagnostic(code, message, span, label, help))

    def travel(
        self,
        to: Vector,
        span: Span,
        tool: Tool | None = None,
        orientation: Quaternion | None = None,
        timing: Timing | None = None,
        profile: Profile = REST_TO_REST,
    ) -> None:
        """An automatic dark move; by default the tool's orientation is constant."""
        by = vectors.minus(to, self.pose.position)
        timing = timing or CruiseSpeed(self.state.speed, self.state.turnspeed)
        end = Pose(to, orientation or self.pose.orientation)
        self._add_automatic(Straight(by), tool or FixedOrientation(), timing, end, span, profile)

    def look(self, mode: Look | LookLine, orientation: Quaternion, span: Span) -> None:
        """Rotates the tool in the dark to the orientation a stroke needs at its start."""
        angle = vectors.turn_between(self.pose.orientation, orientation)
        if angle <= LOOKS_ALREADY:
            return
        if not self.oriented or self.lost:
            self._adopt(orientation)
            return
        self.check_no_stop(span)
        what, how = ("point", "look") if isinstance(mode, Look) else ("line", "look line")
        degrees = math.degrees(angle)
        message = f"the tool turns by {degrees:.3g} deg before this, to look at the {what}"
        help = f"a light-off turn is added; to avoid it, write: start at (…) tool {how} …"
        self.warn("W404", message, span, "", help)
        speed = CruiseSpeed(self.state.speed, self.state.turnspeed)
        end = Pose(self.pose.position, orientation)
        self._add_automatic(Straight(vectors.ZERO), SlerpOrientation(), speed, end, span)

    def _add_automatic(
        self,
        path: Path,
        tool: Tool,
        timing: Timing,
        end: Pose,
        span: Span,
        profile: Profile = REST_TO_REST,
    ) -> None:
        """An automatic stroke, from rest to rest whatever profile the file's strokes have."""
        state, stroke = self.state, self.stroke
        self.state, self.stroke = replace(state, profile=profile, blend=0.0), None
        self.draw(path, tool, timing, None, end, span)
        self.state, self.stroke = state, stroke


def evenly(light: Light | None) -> Light | None:
    """The same light, dimmed where the tool is slow."""
    return light if light is None or light.even else replaced(light, even=True)


def first_line(text: str, span: Span) -> Span:
    """The part of a span on its first line."""
    newline = text.find("\n", span.start, span.end)
    return span if newline < 0 else Span(span.start, newline)


class _LineCounter:
    """Line numbers of increasing offsets, without counting from the top each time."""

    def __init__(self, text: str) -> None:
        self._text = text
        self._known: dict[int, SourceLine] = {}
        self._last = (0, SourceLine(0, 1))

    def line(self, span: Span) -> SourceLine:
        known = self._known.get(span.start)
        if known is not None:
            return known
        offset, (file, line) = self._last
        begin, _ = file_at(self._text, span.start, "")
        if not begin <= offset <= span.start:
            offset, file, line = begin, file_number(self._text, begin), 1
        found = SourceLine(file, line + self._text.count("\n", offset, span.start))
        self._last = (span.start, found)
        self._known[span.start] = found
        return found


def _too_many(span: Span) -> Diagnostic:
    return Diagnostic(
        "E301",
        f"more than {MOST_SEGMENTS:,} strokes in all",
        span,
        "",
        "draw less, or draw a formula: curve … for t from … to …",
    )


def pose_problem(
    code: str, message: str, span: Span, label: str = "", help: str = ""
) -> UnknownPositionProblem:
    """An error that depends on the tool's pose."""
    return UnknownPositionProblem(problem(code, message, span, label, help).diagnostic)

"""Statements -> Program: names evaluated, blocks expanded, movements turned into segments."""

from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

from dqpaint.diagnostics import (
    Diagnostic,
    DiagnosticCollector,
    ErrorLimitError,
    Problem,
    Span,
    UnknownPositionProblem,
    at_call,
    file_at,
    locate,
    problem,
)
from dqpaint.language.expansion import blocks
from dqpaint.language.expansion.definitions import (
    call_scope,
    called_procedure,
    frame_of,
    function_of,
    procedure_of,
)
from dqpaint.language.pen import tool_orientation
from dqpaint.language.pen.durations import timing
from dqpaint.language.pen.pen import Pen, evenly
from dqpaint.language.strokes import corner_blending, curves, imported_strokes, strokes, walls
from dqpaint.language.strokes.modal_words import apply_clause, tool_mode
from dqpaint.language.syntax.tree import Part, Statement, ToolWords
from dqpaint.language.values import typed_values
from dqpaint.language.values.evaluate import evaluate
from dqpaint.language.values.scope import BUILTINS, Scope, UnknownError
from dqpaint.language.values.values import Quantity, Value
from dqpaint.language.values.vectors import Frame
from dqpaint.language.vocabulary.units import PLAIN
from dqpaint.language.vocabulary.words import MODAL, STATEMENTS, TASKS
from dqpaint.program import AutoPlacement, Pose, Program, Segment, Step, Wall

PERIOD = 0.008  # [s]
# Statements whose first value is not a name that they define.
NAMELESS = ("robot", "task", "wall", "keep", "face", "place", "curve", "repeat", "call")
ALIKE = ("text", "path", "svg", "photo", "move")  # in each pass as much as in the first
SHORTEST_PERIOD = 1e-5  # [s]
LONGEST_PERIOD = 10.0
DEEPEST = 64  # blocks, calls and files within each other


class Expander:
    """Processes the statements of a file in order."""

    def __init__(
        self, name: str, text: str, findings: DiagnosticCollector, path: Path | None = None
    ) -> None:
        self._name, self._text, self._findings = name, text, findings
        self._pen = Pen(name, text, findings, path)
        self._scope = Scope(text)
        self._depth = 0  # of blocks, calls and files
        self._including = 0  # of them: files
        self._calls: list[Span] = []  # those that are being drawn
        self._expanded = 0  # statements so far
        self._failed = 0  # of them
        self._once: dict[str, Span] = {}  # statements that may come once
        self._period = PERIOD
        self._robot: str | None = None
        self._robot_span: Span | None = None
        self._task: str | None = None
        self._walls: list[Wall] = []
        self._placement: Pose | AutoPlacement | None = None
        self.at: Span | None = None  # the statement being worked on

    def program(self, statements: tuple[Statement, ...]) -> Program:
        """The program of all statements; errors go to the findings."""
        self._run(statements)
        if not self._pen.segments and not self._findings.errors:
            self._findings.add(_nothing())
        self._check_last()
        return Program(
            self._name,
            self._text,
            self._period,
            self._robot,
            self._robot_span,
            self._placement,
            self._pen.start,
            self._rounded(),
            self._findings.ordered(),
            walls=tuple(self._walls),
            task=self._task,
            dark_saved=self._pen.dark_saved,
            photos=tuple(self._pen.photos),
        )

    def _check_last(self) -> None:
        """Warns of a jump at the end, which no arm has time to follow."""
        segments = self._pen.segments
        if segments and isinstance(segments[-1].path, Step):
            message = "the drawing ends with this step, and leaves no time to answer it"
            help = "write 'hold 1 s' behind it"
            self._pen.warn("W406", message, segments[-1].span, "", help)

    def _rounded(self) -> tuple[Segment, ...]:
        """The strokes with their corners rounded where `blend` or `corner` says so."""
        pen = self._pen
        if not any(one.blend or one.deviation for one in pen.corners) or self._findings.errors:
            return tuple(pen.segments)
        return tuple(corner_blending.round_corners(pen.segments, pen.corners, self._findings))

    def _run(self, statements: tuple[Statement, ...]) -> None:
        for statement in statements:
            self._statement(statement)

    def _statement(self, statement: Statement) -> None:
        self.at = statement.span
        self._expanded += 1
        self._check_size(statement, self._expanded)
        if statement.broken:
            self._skip(statement)
            return
        try:
            if statement.word in _HANDLERS:
                _HANDLERS[statement.word](self, statement)
            elif statement.word in MODAL:
                self._change(statement.parts[0], self._pen.frame)
            elif STATEMENTS[statement.word].moves:
                strokes.draw(statement, self._pen, self._scope)
        except Problem as mistake:
            if not (isinstance(mistake, UnknownPositionProblem) and self._pen.lost):
                for call in reversed(self._calls):
                    mistake = at_call(mistake, call)
                self._findings.add(mistake.diagnostic)
            self._skip(statement)
        except UnknownError:  # its cause was reported
            self._skip(statement)

    def _check_size(self, statement: Statement, size: int) -> None:
        """Raises before a block is expanded if it is too large."""
        if size > blocks.MOST_STATEMENTS:
            self._findings.add(blocks.too_many_statements(statement, size))
            raise ErrorLimitError

    def _skip(self, statement: Statement) -> None:
        """Continues after an error without reporting its consequences."""
        self._failed += 1
        known = STATEMENTS.get(statement.word)
        if known is None or known.moves or statement.word == "start":
            self._pen.lost = self._pen.placed = self._pen.oriented = True
        if statement.word in ("robot", "task", "place", "period", "start"):
            self._once.setdefault(statement.word, statement.span)
        name = statement.name
        if name is not None and statement.word not in NAMELESS:
            self._scope.names.setdefault(name.text, None)
        if statement.body and statement.word != "def" and self._depth < DEEPEST:
            outside = self._open_block()
            if name is not None:
                self._scope.names.setdefault(name.text, None)
            lost, self._pen.lost = self._pen.lost, True
            self._run(statement.body)
            self._close_block(outside)
            self._pen.lost = lost or self._pen.lost

    # Names and blocks.

    def _check_depth(self, statement: Statement) -> None:
        if self._depth >= DEEPEST:
            message = f"more than {DEEPEST} blocks, calls and files within each other"
            raise problem("E127", message, statement.span)

    def _expand_body(self, statement: Statement, body: tuple[Statement, ...]) -> None:
        """Expands the lines of a block."""
        self._check_depth(statement)
        outside = self._open_block()
        self._run(body)
        self._close_block(outside)

    def _open_block(self) -> int:
        """Begins a block; returns what `_close_block` needs to restore the names."""
        self._depth += 1
        return len(self._scope.names)

    def _close_block(self, outside: int) -> None:
        self._depth -= 1
        self._scope.forget_all_but(outside)

    def _define(self, statement: Statement, value: Value | None = None) -> None:
        """Checks that a name is new, and defines it if there is a value."""
        name = statement.name
        assert name is not None
        if name.text in self._scope.places:
            again = self._scope.places[name.text] == name.span  # of a file included twice
            if again and value is not None and self._scope.names.get(name.text) == value:
                return
            raise problem(
                "E230",
                f"'{name.text}' already has a value",
                name.span,
                f"(first: {self._location(self._scope.places[name.text], name.span)})",
                "values never change; choose another name",
            )
        if value is not None:
            self._scope.names[name.text] = value
            self._scope.places[name.text] = name.span

    def _let(self, statement: Statement) -> None:
        if statement.params is None:
            value = evaluate(statement.values[0], self._scope, BUILTINS)
        else:
            value = function_of(statement, self._scope)
        self._define(statement, value)

    def _def(self, statement: Statement) -> None:
        self._define(statement, procedure_of(statement, self._scope))

    def _frame(self, statement: Statement) -> None:
        self._define(statement, frame_of(statement, self._scope))

    def _call(self, statement: Statement) -> None:
        drawing = called_procedure(statement, self._scope)
        inner = call_scope(drawing, statement, self._scope)
        self._check_size(statement, self._expanded + drawing.size)
        scope, state, failed = self._scope, self._pen.state, self._failed
        self._scope = inner
        self._calls.append(statement.span)
        self._expand_body(statement, drawing.body)
        self._calls.pop()
        self._scope = scope
        self._pen.state = replace(state, shone=self._pen.state.shone)
        if self._failed > failed:
            self._pen.lost = True

    def _include(self, statement: Statement) -> None:
        self._check_depth(statement)
        self._depth += 1
        self._including += 1
        self._run(statement.body)
        self._including -= 1
        self._depth -= 1

    def _repeat(self, statement: Statement) -> None:
        if statement.name is not None:
            self._define(statement)
        passes = blocks.passes(statement, self._scope)
        size = blocks.size(statement, len(passes), self._scope)
        self._check_size(statement, self._expanded + size)
        self._check_depth(statement)
        pieces = self._pen.pieces
        for value in passes if statement.body else ():
            outside, failed = self._open_block(), self._failed
            if statement.name is not None:
                self._scope.names[statement.name.text] = Quantity(float(value), PLAIN)
                self._scope.places[statement.name.text] = statement.name.span
            self._run(statement.body)
            self._close_block(outside)
            if self._failed > failed:  # the other passes would only repeat the errors
                self._pen.lost = True
                break
            if value == passes[0] and all(line.word in ALIKE for line in statement.body):
                total = pieces + len(passes) * (self._pen.pieces - pieces)
                span = next((line.span for line in statement.body if line.word != "move"), None)
                imported_strokes.check_pieces(total, self._pen, span or statement.span)

    def _with(self, statement: Statement) -> None:
        pen = self._pen
        frame, state = pen.frame, pen.state
        inner = blocks.inner_frame(statement, frame, self._scope)
        for part in statement.parts:
            if part.word in MODAL:
                self._change(part, inner)
        pen.frame = inner
        self._expand_body(statement, statement.body)
        pen.frame = frame
        pen.state = replace(state, shone=pen.state.shone)

    def _change(self, part: Part, frame: Frame) -> None:
        pen = self._pen
        pen.check_no_time(part)
        pen.state = apply_clause(pen.state, part, self._scope, pen, frame)

    def _stroke(self, statement: Statement) -> None:
        pen = self._pen
        if pen.stroke is not None:
            help = "one 'stroke' takes any number of lines"
            raise problem("E280", "a stroke within a stroke", statement.span, "", help)
        state = pen.state
        for part in statement.parts:
            if part.word in MODAL:
                self._change(part, pen.frame)
        if pen.state.look_ahead is not None:
            pen.state = replace(pen.state, light=evenly(pen.state.light))
        light = pen.state.light if statement.part("light") else None
        pen.begin_stroke(timing(statement, pen.state, self._scope), light)
        try:
            self._expand_body(statement, statement.body)
        finally:
            pen.stroke = None
        pen.state = replace(state, shone=pen.state.shone)

    def _curve(self, statement: Statement) -> None:
        self._define(statement)
        try:
            strokes.draw(statement, self._pen, self._scope)
        except Problem as mistake:
            raise curves.outside_of_formula(mistake, statement, self._text) from None

    def _location(self, span: Span, seen_from: Span) -> str:
        """`line:column`, and the file if it is another one."""
        line, column = locate(self._text, span.start)
        begin, file = file_at(self._text, span.start, self._name)
        here = file_at(self._text, seen_from.start, self._name)[0]
        return f"{line}:{column}" if begin == here else f"{file}:{line}:{column}"

    # Statements that come once, at the top.

    def _first(self, statement: Statement, inside: bool = False) -> None:
        """Checks that a statement comes once, outside blocks, before the first movement."""
        word = statement.word
        span = Span(statement.span.start, statement.span.start + len(word))
        if self._depth > self._including and not inside:
            message = f"'{word}' stands outside of all blocks"
            raise problem("E123", message, span, "", "write it at the top of the file")
        if word in self._once:
            first = self._location(self._once[word], span)
            message, label = f"'{word}' is given twice", f"second (first: {first})"
            raise problem("E113", message, span, label, "keep one of them")
        if self._pen.started:
            message = f"'{word}' comes too late: the tool has moved already"
            label = f"(first movement: {self._location(self._pen.moved, span)})"
            raise problem("E124", message, span, label, "write it before the first movement")
        self._once[word] = statement.span

    def _traj(self, statement: Statement) -> None:
        if self._including:  # it is of its own file
            return
        self._first(statement)
        if self._expanded > 1:
            help = "the version of the language comes before all other lines"
            raise problem("E119", "'traj' is not the first statement", statement.span, "", help)

    def _robot_line(self, statement: Statement) -> None:
        self._first(statement)
        assert statement.name is not None
        self._robot, self._robot_span = statement.name.text, statement.name.span

    def _task_line(self, statement: Statement) -> None:
        self._first(statement)
        assert statement.name is not None
        if statement.name.text not in TASKS:
            message = f"there is no task '{statement.name.text}'"
            help = "what is controlled: task pose, task beam, task point or task place first"
            raise problem("E267", message, statement.name.span, "", help)
        self._task = statement.name.text

    def _wall(self, statement: Statement) -> None:
        if self._depth > self._including:
            span = Span(statement.span.start, statement.span.start + len(statement.word))
            message = f"'{statement.word}' stands outside of all blocks"
            raise problem("E123", message, span, "", "it holds for the whole drawing")
        self._walls.append(walls.wall(statement, self._pen, self._scope))

    def _period_line(self, statement: Statement) -> None:
        self._first(statement)
        self._period = typed_values.positive(statement.values[0], self._scope, "period")
        if not SHORTEST_PERIOD <= self._period <= LONGEST_PERIOD:
            message = f"a period is from {SHORTEST_PERIOD * 1e3:g} ms to {LONGEST_PERIOD:g} s"
            help = "an arm is controlled every few milliseconds: period 8 ms"
            raise problem("E257", message, statement.values[0].span, "", help)

    def _place(self, statement: Statement) -> None:
        self._first(statement)
        turned = statement.value("turned")
        given = None if turned is None else typed_values.rotation(turned, self._scope, "turned")
        if statement.name is not None:
            self._placement = AutoPlacement(given, statement.span)
            return
        position = typed_values.place(statement.required("at"), self._scope, "at")
        self._placement = Pose(position, given or (1.0, 0.0, 0.0, 0.0))

    def _start(self, statement: Statement) -> None:
        self._first(statement, inside=True)
        pen = self._pen
        at, tool = statement.required("at"), statement.part("tool")
        position = pen.frame.point(typed_values.place(at, self._scope, "at"))
        orientation = None
        if tool is not None:
            assert isinstance(tool.value, ToolWords)
            mode = tool_mode(tool.value, self._scope, pen.frame)
            orientation = tool_orientation.orientation_of_mode(mode, position, tool.value.span)
            if orientation is None:
                message = "'start' needs to know how the tool is held"
                help = "write: tool rpy(0 deg, 0 deg, 0 deg), or tool look (0, 0, 0)"
                raise problem("E255", message, tool.value.span, "", help)
        pen.start_at(position, orientation)


_HANDLERS: dict[str, Callable[[Expander, Statement], None]] = {
    "traj": Expander._traj,
    "robot": Expander._robot_line,
    "task": Expander._task_line,
    "wall": Expander._wall,
    "keep": Expander._wall,
    "face": Expander._wall,
    "let": Expander._let,
    "place": Expander._place,
    "start": Expander._start,
    "period": Expander._period_line,
    "include": Expander._include,
    "def": Expander._def,
    "call": Expander._call,
    "frame": Expander._frame,
    "stroke": Expander._stroke,
    "curve": Expander._curve,
    "repeat": Expander._repeat,
    "with": Expander._with,
}


def _nothing() -> Diagnostic:
    return Diagnostic(
        "E140",
        "this file draws nothing",
        None,
        "",
        "a drawing can be as short as: line to (100, 0) mm",
    )

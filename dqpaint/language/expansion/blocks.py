"""`repeat` -> values of its passes; `with` -> inner frame."""

from dqpaint.diagnostics import Diagnostic, Problem, Span, problem
from dqpaint.language.syntax.tree import Part, Statement
from dqpaint.language.values import typed_values, vectors
from dqpaint.language.values.evaluate import evaluate
from dqpaint.language.values.scope import Scope, UnknownError
from dqpaint.language.values.values import PointValue, Procedure
from dqpaint.language.values.vectors import Frame
from dqpaint.language.vocabulary.units import PLAIN

MOST_PASSES = 10_000
MOST_STATEMENTS = 1_000_000


def passes(statement: Statement, scope: Scope) -> range:
    """The value of the loop's name in each pass."""
    nodes = statement.values
    if len(nodes) == 1:
        number = typed_values.count(nodes[0], scope, "repeat", least=1)
        lower, upper = 1, number
    else:
        lower = typed_values.count(nodes[0], scope, "from", least=-MOST_STATEMENTS)
        upper = typed_values.count(nodes[1], scope, "to", least=-MOST_STATEMENTS)
        number = upper - lower + 1
        if number < 1:
            message = f"'repeat' counts up, but {upper} is less than {lower}"
            name = statement.name.text if statement.name else "i"
            back = f"{lower + upper} - {name}" if lower + upper else f"-{name}"
            help = f"write: repeat {name} from {upper} to {lower}, and count down with {back}"
            raise problem("E222", message, nodes[1].span, "", help)
    if number > MOST_PASSES:
        message = f"more than {MOST_PASSES:,} passes of one 'repeat'"
        help = "draw a formula instead: curve … for t from … to …"
        raise problem("E303", message, nodes[-1].span, f"this is {number:,}", help)
    return range(lower, upper + 1)


def size(statement: Statement, count: int, scope: Scope) -> int:
    """A lower bound of the number of statements that a block expands to."""
    return count * _size(statement.body, scope)


def _size(body: tuple[Statement, ...], scope: Scope) -> int:
    """A lower bound of the number of statements that a body expands to."""
    size = 0
    for statement in body:
        size += 1
        if statement.body and statement.word != "def":
            count = _known_count(statement, scope) if statement.word == "repeat" else 1
            size += count * _size(statement.body, scope)
        elif statement.word == "call" and statement.name is not None:
            drawing = scope.names.get(statement.name.text)
            size += drawing.size if isinstance(drawing, Procedure) else 0
    return size


def _known_count(statement: Statement, scope: Scope) -> int:
    """The passes of an inner loop, or 1 if they depend on unknown values."""
    try:
        return len(passes(statement, scope)) if not statement.broken else 1
    except (Problem, UnknownError):
        return 1


def too_many_statements(statement: Statement, size: int) -> Diagnostic:
    """E304."""
    return Diagnostic(
        "E304",
        f"more than {MOST_STATEMENTS:,} statements in all",
        Span(statement.span.start, statement.span.start + max(1, len(statement.word))),
        f"with this there are {size:,}",
        "repeat less often, or draw a formula: curve … for t from … to …",
    )


def inner_frame(statement: Statement, outer: Frame, scope: Scope) -> Frame:
    """The frame of a `with`: its parts in written order, the outermost first."""
    frame, parts = outer, statement.parts
    for i, part in enumerate(parts):
        if part.word == "rotate":
            frame = frame.within(_rotation(part, _about(parts, i), scope))
        elif part.word == "shift":
            frame = frame.within(Frame(shift=typed_values.place(part.expression, scope, "shift")))
        elif part.word == "mirror":
            normal = typed_values.direction(part.expression, scope, "mirror")
            about = _about(parts, i)
            point = typed_values.place(about.expression, scope, "about") if about else vectors.ZERO
            frame = frame.within(vectors.mirror(normal, point))
        elif part.word == "scale":
            frame = frame.within(
                Frame(scale=typed_values.positive(part.expression, scope, "scale"))
            )
        elif part.word == "frame":
            frame = frame.within(typed_values.frame(part.expression, scope))
    if not 1.0 / typed_values.LARGEST <= frame.scale <= typed_values.LARGEST:
        raise problem("E201", "this scale is too extreme", statement.span)
    return frame


def _about(parts: tuple[Part, ...], i: int) -> Part | None:
    """The `about` that stands behind a part."""
    return parts[i + 1] if i + 1 < len(parts) and parts[i + 1].word == "about" else None


def _rotation(part: Part, about: Part | None, scope: Scope) -> Frame:
    """A rotation about z, about a direction, or about a point: a value with a unit is a point."""
    if about is None:
        return Frame(turn=typed_values.rotation(part.expression, scope, "rotate"))
    where = evaluate(about.expression, scope)
    if isinstance(where, PointValue) and where.dimension == PLAIN and any(where.xyz):
        axis = typed_values.direction(about.expression, scope, "about")
        angle = typed_values.number(part.expression, scope, "rotate")
        return Frame(turn=vectors.turn_about(axis, angle))
    turn = typed_values.rotation(part.expression, scope, "rotate")
    point = typed_values.place(about.expression, scope, "about")
    return Frame(turn=turn, shift=vectors.minus(point, vectors.turned(turn, point)))

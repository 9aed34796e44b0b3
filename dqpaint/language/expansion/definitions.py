"""Statements `let f`, `def` and `frame`, and calls -> functions, procedures, frames and scopes."""

from dqpaint.diagnostics import Problem, problem
from dqpaint.language.expansion import blocks
from dqpaint.language.syntax.parser import unknown_statement
from dqpaint.language.syntax.tree import Statement, names_in, size_of
from dqpaint.language.values import typed_values
from dqpaint.language.values.evaluate import evaluate
from dqpaint.language.values.scope import DEEPEST_CALLS, Scope, UnknownError
from dqpaint.language.values.values import FrameValue, Function, Procedure, Value
from dqpaint.language.values.vectors import Frame


def function_of(statement: Statement, scope: Scope) -> Function:
    """`let f(x) = …`. Its formula knows the names defined here and its parameters."""
    assert statement.name is not None
    assert statement.params is not None
    name, body = statement.name.text, statement.values[0]
    params = tuple(param.text for param in statement.params)
    used = names_in(body)
    if name in used - set(params):
        message = f"'{name}' can't call itself"
        raise problem("E232", message, body.span, "", "repeat and curve go through many values")
    size, depth = size_of(body)
    if depth > DEEPEST_CALLS:
        message = "this formula has too many parts within each other"
        raise problem("E308", message, body.span, "", "give a part of it a name: let a = …")
    return Function(name, params, body, scope.values_of(used.difference(params)), size, depth)


def procedure_of(statement: Statement, scope: Scope) -> Procedure:
    """`def star(r) … end`. Its lines know the names defined here and its parameters."""
    assert statement.name is not None
    assert statement.params is not None
    name = statement.name
    call = _call_of(name.text, statement.body)
    if call is not None:
        message = f"'{name.text}' can't call itself"
        raise problem("E232", message, call.span, "", "repeat draws its lines several times")
    known = scope.values_of(names_in(statement.body).difference(p.text for p in statement.params))
    size = blocks.size(statement, 1, scope)
    return Procedure(name.text, statement.params, statement.body, known, size)


def _call_of(name: str, body: tuple[Statement, ...]) -> Statement | None:
    """The first line of a body that calls this name."""
    for statement in body:
        if statement.word == "call" and statement.name is not None and statement.name.text == name:
            return statement
        inner = _call_of(name, statement.body)
        if inner is not None:
            return inner
    return None


def frame_of(statement: Statement, scope: Scope) -> FrameValue:
    """`frame leaf at P turned O`."""
    at, turned = statement.value("at"), statement.value("turned")
    frame = Frame()
    if at is not None:
        frame = Frame(shift=typed_values.place(at, scope, "at"))
    if turned is not None:
        frame = frame._replace(turn=typed_values.rotation(turned, scope, "turned"))
    return FrameValue(frame)


def called_procedure(statement: Statement, scope: Scope) -> Procedure:
    """The `def` called by a line."""
    assert statement.name is not None
    word = statement.name
    value = scope.names.get(word.text)
    if isinstance(value, Procedure):
        return value
    if word.text in scope.names and value is None:
        raise UnknownError
    if isinstance(value, Function):
        message = f"'{word.text}' is a function: it gives a value and draws nothing"
        raise problem("E206", message, word.span, "", "use it in a value, or write a 'def'")
    if value is not None:
        message = f"'{word.text}' is no 'def', so it can't be drawn"
        raise problem("E206", message, word.span)
    defs = [name for name, known in scope.names.items() if isinstance(known, Procedure)]
    mistake, meant = unknown_statement(word.text, word.span, defs)
    if not meant:
        mistake = problem(
            mistake.code,
            mistake.message,
            word.span,
            "",
            f"a call stands below the 'end' of its def: def {word.text}(…)",
        ).diagnostic
    raise Problem(mistake)


def call_scope(drawing: Procedure, statement: Statement, scope: Scope) -> Scope:
    """The scope of a `def`'s lines for a call."""
    wanted, given = len(drawing.params), len(statement.values)
    if wanted != given:
        params = ", ".join(param.text for param in drawing.params)
        noun = "value" if wanted == 1 else "values"
        message = f"{drawing.name} takes {wanted or 'no'} {noun}, not {given}"
        help = f"write: {drawing.name}({params})"
        raise problem("E207", message, statement.span, "", help)
    names: dict[str, Value | None] = dict(drawing.known)
    for param, node in zip(drawing.params, statement.values, strict=True):
        names[param.text] = evaluate(node, scope)
    inner = scope.with_names(names)
    inner.places = {param.text: param.span for param in drawing.params}
    return inner

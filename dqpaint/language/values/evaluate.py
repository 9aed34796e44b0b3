"""Expression and scope -> value."""

from collections.abc import Callable, Iterable

from dqpaint.diagnostics import Problem, Span, at_call, problem
from dqpaint.language.syntax.tree import (
    Bracket,
    Call,
    Expression,
    Literal,
    Name,
    Negation,
    Power,
    Quoted,
    SumOrProduct,
)
from dqpaint.language.values import expression_errors, functions, values
from dqpaint.language.values.scope import BUILTINS, DEEPEST_CALLS, UNIT_VALUES, Scope, UnknownError
from dqpaint.language.values.values import (
    Function,
    PointValue,
    Procedure,
    Quantity,
    TextValue,
    Value,
    checked_finite,
    describe,
    is_zero,
)
from dqpaint.language.vocabulary.units import PLAIN, UNITS, Dimension, dimension_name
from dqpaint.program import Taylor
from dqpaint.program import Value as Scalar


def evaluate(node: Expression, scope: Scope, words: Iterable[str] = ()) -> Value:
    """The value of an expression; raises a `Problem` if it has none.

    `words` are allowed in its place; the message about an unknown name lists them.
    """
    if words and type(node) is Name and not scope.defines(node.name):
        raise expression_errors.unknown(node, scope, words)
    return _EVALUATORS[type(node)](node, scope)


def _literal(node: Literal, _scope: Scope) -> Value:
    if not node.unit:
        return Quantity(node.value, PLAIN)
    unit = UNIT_VALUES[node.unit]
    assert not isinstance(unit.value, Taylor)
    return Quantity(node.value * unit.value, unit.dimension)


def _quoted(node: Quoted, _scope: Scope) -> Value:
    return TextValue(node.text)


def _name(node: Name, scope: Scope) -> Value:
    names = scope.names
    if node.name in names:
        value = names[node.name]
        if value is None:
            raise UnknownError
        if isinstance(value, Function | Procedure):
            raise expression_errors.no_value_of(node, value)
        return value
    if node.name in BUILTINS:
        return BUILTINS[node.name]
    raise expression_errors.unknown(node, scope)


def _bracket(node: Bracket, scope: Scope) -> Value:
    count = len(node.values)
    if count == 1:
        value = evaluate(node.values[0], scope)
        if not node.unit:
            return value
        if isinstance(value, Quantity) and value.dimension == PLAIN:
            return checked_finite(_with_unit(value, node.unit), node.span)
        raise expression_errors.second_unit(node, describe(value))
    numbers, dimension = _coordinates(node, scope)
    x, y = numbers[0], numbers[1]
    point = PointValue((x, y, numbers[2] if count == 3 else 0.0), dimension)
    if not node.unit:
        return point
    if dimension != PLAIN:
        raise expression_errors.second_unit(node, f"already {dimension_name(dimension)}")
    factor, kind, _ = UNITS[node.unit]
    x, y, z = point.xyz
    return checked_finite(PointValue((x * factor, y * factor, z * factor), kind), node.span)


def _coordinates(node: Bracket, scope: Scope) -> tuple[list[Scalar], Dimension]:
    """The numbers of a point and their common dimension; a zero fits any."""
    if len(node.values) > 3:
        raise expression_errors.too_many(node, scope)
    dimension = None
    coordinates: list[Quantity] = []
    for child in node.values:
        value = _EVALUATORS[type(child)](child, scope)
        if not isinstance(value, Quantity):
            message = f"a point is made of numbers, but this is {describe(value)}"
            raise problem("E204", message, child.span)
        coordinates.append(value)
        if dimension is None and not is_zero(value):
            dimension = value.dimension
    dimension = PLAIN if dimension is None else dimension
    for value in coordinates:
        if value.dimension != dimension and not is_zero(value):
            raise expression_errors.mixed(node, coordinates, scope)
    return [value.value for value in coordinates], dimension


def _with_unit(value: Quantity, unit: str) -> Value:
    factor, kind, _ = UNITS[unit]
    return Quantity(value.value * factor, kind)


def _call(node: Call, scope: Scope) -> Value:
    if node.name in scope.names:
        own = scope.names[node.name]
        if own is None:
            raise UnknownError
        if isinstance(own, Function):
            return _own_call(own, node, scope)
    if node.name not in functions.TABLE:
        raise expression_errors.unknown_function(node, scope)
    given = [evaluate(child, scope) for child in node.values]
    arguments = functions.Arguments(node.name, given, node.values, node.span, scope.text)
    return checked_finite(functions.call(arguments), node.span)


def _own_call(function: Function, node: Call, scope: Scope) -> Value:
    """The value of a call of the file's own function; errors are reported inside its formula."""
    given = [evaluate(child, scope) for child in node.values]
    if len(given) != len(function.params):
        raise expression_errors.wrong_count(function, node)
    budget = scope.budget
    budget.steps -= function.size
    if budget.steps < 0:
        message = "the functions of this file have too much to do"
        raise problem("E309", message, node.span, "", "let them call each other less often")
    if budget.depth + function.depth > DEEPEST_CALLS:
        message = "too many functions that call each other in turn"
        raise problem("E308", message, node.span, "", "write some of them out")
    names = {**function.known, **dict(zip(function.params, given, strict=True))}
    budget.depth += function.depth
    try:
        return evaluate(function.body, scope.with_names(names))
    except Problem as mistake:
        raise at_call(mistake, node.span) from None
    finally:
        budget.depth -= function.depth


def _sign(node: Negation, scope: Scope) -> Value:
    value = evaluate(node.value, scope)
    result = values.negative(value)
    if result is None:
        raise problem("E209", f"{describe(value)} has no sign", node.span)
    return result


def _sum_or_product(node: SumOrProduct, scope: Scope) -> Value:
    result, start = evaluate(node.first, scope), node.first
    for sign, child in node.rest:
        operand = evaluate(child, scope)
        if sign in "+-":
            combined = values.sum_of(result, operand, sign)
            if combined is None:
                raise expression_errors.no_sum(result, operand, sign, start, child, scope)
        elif sign == "*":
            combined = values.product_of(result, operand)
            if combined is None:
                raise expression_errors.no_product(result, operand, "multiply", "by", child)
        else:
            combined = values.quotient_of(result, operand, child.span)
            if combined is None:
                raise expression_errors.no_product(result, operand, "divide", "by", child)
        result = checked_finite(combined, Span(node.span.start, child.span.end))
    return result


def _power(node: Power, scope: Scope) -> Value:
    base, exponent = evaluate(node.base, scope), evaluate(node.exponent, scope)
    if not isinstance(base, Quantity):
        raise problem("E211", f"{describe(base)} has no powers", node.base.span)
    if not isinstance(exponent, Quantity) or exponent.dimension != PLAIN:
        message = f"an exponent is a plain number, this is {describe(exponent)}"
        help = "a unit binds tightest; to give it to the power, write: (2^3) mm"
        raise problem("E211", message, node.exponent.span, "", help)
    try:
        result = values.power_of(base, exponent)
    except ZeroDivisionError:
        raise problem("E203", "division by zero", node.span, "0 to a negative power") from None
    except OverflowError:
        raise problem("E201", "this number is too large", node.span) from None
    except ValueError:
        message = "a negative number has only whole powers"
        raise problem("E212", message, node.span) from None
    if result is None:
        message = f"{describe(base)} can't have this exponent"
        raise problem("E211", message, node.exponent.span, "", "divide the base by its unit first")
    return checked_finite(result, node.span)


# Each evaluator takes the node type of its key, which the type of a table can't express.
_EVALUATORS: dict[type, Callable[..., Value]] = {
    Literal: _literal,
    Quoted: _quoted,
    Name: _name,
    Bracket: _bracket,
    Call: _call,
    Negation: _sign,
    SumOrProduct: _sum_or_product,
    Power: _power,
}

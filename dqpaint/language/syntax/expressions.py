"""Tokens -> expression, by operator precedence (Pratt); units bind tightest."""

import math

from dqpaint.diagnostics import Fix, Problem, Span, problem
from dqpaint.language.syntax.cursor import Cursor, found, no_value
from dqpaint.language.syntax.lexer import Token
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
from dqpaint.language.vocabulary.units import FOREIGN_UNITS, SAME_UNITS, UNITS, instead_of
from dqpaint.language.vocabulary.words import FUNCTIONS, RESERVED

DEEPEST = 64  # brackets and signs within each other
_SUMS, _PRODUCTS = ("+", "-"), ("*", "/")
_OPERATORS = (*_SUMS, *_PRODUCTS, "^")


def expression(cursor: Cursor, after: str) -> Expression:
    """Reads an expression; `after` is the word before it, for messages."""
    first = _number(cursor) if cursor.token.kind == "number" else _signed(cursor, after)
    token = cursor.token
    if token.kind != "sign" or token.text not in _OPERATORS:
        return first
    return _sum(cursor, _product(cursor, _power(cursor, first)))


def _sum(cursor: Cursor, first: Expression) -> Expression:
    rest: list[tuple[str, Expression]] = []
    token = cursor.token
    while token.kind == "sign" and token.text in _SUMS:
        cursor.take()
        rest.append((token.text, _product(cursor, _signed(cursor, token.text))))
        token = cursor.token
    return SumOrProduct(first, tuple(rest), cursor.span_from(first.span.start)) if rest else first


def _product(cursor: Cursor, first: Expression) -> Expression:
    rest: list[tuple[str, Expression]] = []
    token = cursor.token
    while token.kind == "sign" and token.text in _PRODUCTS:
        cursor.take()
        rest.append((token.text, _signed(cursor, token.text)))
        token = cursor.token
    return SumOrProduct(first, tuple(rest), cursor.span_from(first.span.start)) if rest else first


def _signed(cursor: Cursor, after: str) -> Expression:
    token = cursor.token
    if token.kind != "sign" or token.text not in _SUMS:
        return _power(cursor, _value(cursor, after))
    cursor.take()
    _deeper(cursor, token)
    value = _signed(cursor, token.text)
    cursor.depth -= 1
    return Negation(value, cursor.span_from(token.start)) if token.text == "-" else value


def _power(cursor: Cursor, base: Expression) -> Expression:
    token = cursor.token
    if token.kind != "sign" or token.text != "^":
        return base
    cursor.take()
    _deeper(cursor, token)
    exponent = _signed(cursor, "^")
    cursor.depth -= 1
    return Power(base, exponent, cursor.span_from(base.span.start))


def _value(cursor: Cursor, after: str) -> Expression:
    token = cursor.token
    kind = token.kind
    if kind == "number":
        return _number(cursor)
    if kind == "sign" and token.text == "(":
        values = bracket(cursor)
        unit = cursor.token
        if unit.kind == "name" and unit.text in UNITS:
            cursor.take()
            return Bracket(values, unit.text, Span(token.start, unit.end))
        return Bracket(values, "", Span(token.start, cursor.before.end))
    if kind == "name" and token.text not in RESERVED:
        cursor.take()
        if not cursor.is_sign("("):
            return _name(cursor, token.text, token.span)
        values = bracket(cursor, of=token.text)
        return Call(token.text, values, cursor.span_from(token.start))
    if kind == "text":
        cursor.take()
        return Quoted(token.text, token.span)
    raise no_value(cursor, after)


def _number(cursor: Cursor) -> Literal:
    token = cursor.take()
    value = float(token.text)
    if value == math.inf:
        raise problem("E201", "this number is too large", token.span)
    unit = cursor.token
    if unit.kind == "name" and unit.text in UNITS:
        cursor.take()
        return Literal(value, unit.text, Span(token.start, unit.end))
    return Literal(value, "", Span(token.start, token.end))


def _name(cursor: Cursor, name: str, span: Span) -> Expression:
    unit = cursor.token
    if unit.kind == "name" and unit.text in UNITS and name not in UNITS:
        raise problem(
            "E109",
            f"a unit follows a number or a bracket, not the name '{name}'",
            unit.span,
            "",
            f"write {name}*{unit.text} if '{name}' is a plain number, or take the unit away",
        )
    return Name(name, span)


def bracket(cursor: Cursor, of: str = "(") -> tuple[Expression, ...]:
    """Reads comma-separated values in brackets; `of` is the function's name before them."""
    opening = cursor.take()
    _deeper(cursor, opening)
    values: list[Expression] = []
    after = of if of == "(" else f"{of}("
    more = of == "(" or not cursor.is_sign(")")  # only a call may do without values
    while more:
        values.append(expression(cursor, after))
        after = ","
        if more := cursor.is_sign(","):
            cursor.take()
    if not cursor.is_sign(")"):
        raise _not_closed(cursor)
    cursor.take()
    cursor.depth -= 1
    return tuple(values)


def _not_closed(cursor: Cursor) -> Problem:
    token = cursor.token
    if token.text in FOREIGN_UNITS and cursor.before.kind == "number":
        raise foreign_unit(token)
    help = "the numbers of a point stand in brackets, with commas between: (10, 20) mm"
    fix = None
    if token.kind == "number" or token.kind == "name":
        help = "put a comma between the numbers of a point, a * between the factors of a product"
    if cursor.before.text in FUNCTIONS:
        help = f"write: {FUNCTIONS[cursor.before.text]}"
    if token.kind == cursor.before.kind == "number":
        end = cursor.before.end
        fix = Fix("put a comma between", Span(end, end), ",")
    message = f"expected ',' or ')' but found {found(token)}"
    return problem("E109", message, token.span, "", help, fix)


def foreign_unit(token: Token) -> Problem:
    """E102: a unit of other languages after a number."""
    unit = FOREIGN_UNITS[token.text]
    help = instead_of(token.text)
    fix = Fix(f"write {unit}", token.span, unit) if token.text in SAME_UNITS else None
    message = f"'{token.text}' is not a unit of this language"
    return problem("E102", message, token.span, "", help, fix)


def _deeper(cursor: Cursor, token: Token) -> None:
    cursor.depth += 1
    if cursor.depth > DEEPEST:
        raise problem(
            "E106",
            f"more than {DEEPEST} brackets or signs within each other",
            token.span,
            "",
            "give a part of it a name: let a = …",
        )

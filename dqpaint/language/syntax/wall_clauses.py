"""Tokens of `wall`, `keep` and `face` -> what stands between the word and its parts."""

from dqpaint.diagnostics import Problem, problem
from dqpaint.language.syntax.cursor import Cursor, example_of, found
from dqpaint.language.syntax.expressions import expression
from dqpaint.language.syntax.import_clauses import Reader, one_of
from dqpaint.language.syntax.tree import Expression, Quoted, Word

Head = tuple[Word | None, tuple[Expression, ...]]
OBSTACLES = ("sphere", "box", "capsule", "cylinder", "mesh")


def wall(cursor: Cursor) -> Head:
    """`below z = -50 mm`."""
    start = cursor.token.start
    side = _one(cursor, ("below", "above"), "wall")
    axis = _one(cursor, ("x", "y", "z"), "wall")
    name = Word(f"{side} {axis}", cursor.span_from(start))
    if not cursor.is_sign("="):
        raise _expected(cursor, "'='", "wall")
    cursor.take()
    return name, (expression(cursor, "="),)


def keep(cursor: Cursor) -> Head:
    """`inside box P`, `away from sphere`, `links apart D` and so on."""
    start = cursor.token.start
    way = _one(cursor, ("inside", "away", "links"), "keep")
    if way == "links":
        _one(cursor, ("apart",), "keep links")
        return Word("apart", cursor.span_from(start)), (expression(cursor, "apart"),)
    if way == "away":
        _one(cursor, ("from",), "keep away")
    kind = _one(cursor, OBSTACLES if way == "away" else ("box",), f"keep {way}")
    name = Word("inside box" if way == "inside" else kind, cursor.span_from(start))
    if kind == "mesh":
        if cursor.token.kind != "text":
            raise _expected(cursor, "a file in quotes", "keep away from mesh")
        token = cursor.take()
        return name, (Quoted(token.text, token.span),)
    return name, (expression(cursor, kind),) if kind in ("box", "capsule") else ()


def face(cursor: Cursor) -> Head:
    """`viewer`, or a direction."""
    if cursor.is_word("viewer"):
        token = cursor.take()
        return Word(token.text, token.span), ()
    return None, (expression(cursor, "face"),)


def _one(cursor: Cursor, words: tuple[str, ...], after: str) -> str:
    if cursor.token.text not in words:
        raise _expected(cursor, " or ".join(words), after)
    return cursor.take().text


def _expected(cursor: Cursor, what: str, after: str) -> Problem:
    span = cursor.token.span if not cursor.at_end else cursor.before.span
    message = f"expected {what} after '{after}' but found {found(cursor.token)}"
    return problem("E109", message, span, "", f"for example: {example_of(after.split()[0])}")


READERS: dict[str, Reader] = {"holder": one_of(("tool", "beam"), "for", {})}

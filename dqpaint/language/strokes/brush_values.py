"""Values of a `brush` clause -> `program.Brush`, validated by the brush's own model."""

from collections.abc import Callable
from functools import partial
from typing import TYPE_CHECKING

from dqpaint.core import LARGEST_IMAGE
from dqpaint.diagnostics import Problem, Span, problem
from dqpaint.language.imports.file_access import readable
from dqpaint.language.pen.pen import Pen
from dqpaint.language.syntax.tree import BrushPart, BrushWords, Expression, Quoted
from dqpaint.language.values import typed_values
from dqpaint.language.values.evaluate import evaluate
from dqpaint.language.values.scope import Scope
from dqpaint.language.values.values import TextValue, describe
from dqpaint.language.vocabulary.units import LENGTH, PLAIN, Dimension
from dqpaint.program import Brush, BrushValue

if TYPE_CHECKING:
    from pydantic import ValidationError

    from dqpaint.brushes import Brush as BrushModel

FURTHEST_COUNT = -(10**9)  # the brush itself checks the range of a count


def brush_of(words: BrushWords, scope: Scope, pen: Pen) -> Brush:
    """The brush of a clause, in the tool's frame: it is never scaled."""
    from pydantic import ValidationError

    from dqpaint.brushes import BRUSHES, takes

    model = BRUSHES[words.name.text]
    kinds = takes(model)
    given = {
        part.key.text: _READ[kinds[part.key.text]](part, scope, pen, words) for part in words.parts
    }
    try:
        made = model.model_validate(given)
    except ValidationError as fault:
        raise _invalid_value(words, fault, model) from None
    values = made.model_dump(exclude_defaults=True)
    return Brush(words.name.text, tuple(values.items()), model.several)


def _invalid_value(
    words: BrushWords, fault: "ValidationError", model: "type[BrushModel]"
) -> Problem:
    """E258: the model's message about the first invalid value."""
    from dqpaint.brushes import takes
    from dqpaint.core import pydantic_reason

    first = fault.errors()[0]
    key = str(first["loc"][0]) if first["loc"] else ""
    part = next((part for part in words.parts if part.key.text == key), None)
    bound = first["type"].startswith(("less_than", "greater_than"))
    unit = " m" if bound and takes(model).get(key) == "length" else ""
    message = " ".join(
        filter(None, (f"brush '{words.name.text}':", key, pydantic_reason(first) + unit))
    )
    field = model.model_fields.get(key)
    help = f"{key}: {field.description}" if field and field.description else ""
    return problem("E258", message, words.span if part is None else _span(part), "", help)


def _span(part: BrushPart) -> Span:
    return Span(part.values[0].span.start, part.values[-1].span.end)


def _label(part: BrushPart, words: BrushWords) -> str:
    """The word before a value: its own, or the brush's."""
    named = part.key.span != part.values[0].span
    return part.key.text if named else f"brush {words.name.text}"


def _number(
    part: BrushPart, scope: Scope, _pen: Pen, words: BrushWords, dimension: Dimension = PLAIN
) -> float:
    (node,) = part.values
    return typed_values.quantity(evaluate(node, scope), node, scope, _label(part, words), dimension)


def _count(part: BrushPart, scope: Scope, _pen: Pen, words: BrushWords) -> BrushValue:
    return typed_values.count(part.values[0], scope, _label(part, words), FURTHEST_COUNT)


def _direction(part: BrushPart, scope: Scope, _pen: Pen, words: BrushWords) -> BrushValue:
    return typed_values.direction(part.values[0], scope, _label(part, words))


def _colours(part: BrushPart, scope: Scope, _pen: Pen, words: BrushWords) -> BrushValue:
    label = _label(part, words)
    return tuple(
        typed_values.colour(node, scope, number > 0, label)
        for number, node in enumerate(part.values)
    )


def _text(part: BrushPart, scope: Scope, _pen: Pen, words: BrushWords) -> BrushValue:
    return _quoted(part.values[0], scope, part, words).text


def _file(part: BrushPart, scope: Scope, pen: Pen, words: BrushWords) -> BrushValue:
    node = _quoted(part.values[0], scope, part, words)
    return str(readable(node, pen, LARGEST_IMAGE))


def _quoted(node: Expression, scope: Scope, part: BrushPart, words: BrushWords) -> Quoted:
    if isinstance(node, Quoted):
        return node
    value = evaluate(node, scope)
    if isinstance(value, TextValue):
        return Quoted(value.text, node.span)
    label = _label(part, words)
    message = f"'{label}' needs a text in quotes, but this is {describe(value)}"
    raise problem("E218", message, node.span, "", f'for example: {label} "mine.png"')


_Reader = Callable[[BrushPart, Scope, Pen, BrushWords], BrushValue]
_READ: dict[str, _Reader] = {
    "length": partial(_number, dimension=LENGTH),
    "number": _number,
    "count": _count,
    "direction": _direction,
    "colours": _colours,
    "text": _text,
    "file": _file,
}

"""Expressions without a value -> diagnostics with a fix."""

from collections.abc import Iterable

from dqpaint.diagnostics import Fix, Problem, Span, closest, did_you_mean, join_words, problem
from dqpaint.language.syntax.tree import Bracket, Call, Expression, Literal, Name, Negation
from dqpaint.language.values import functions
from dqpaint.language.values.scope import BUILTINS, Scope
from dqpaint.language.values.values import (
    Function,
    PointValue,
    Procedure,
    Quantity,
    Value,
    describe,
    is_zero,
)
from dqpaint.language.vocabulary.aliases import FUNCTION_ALIASES, PROFILE_ALIASES
from dqpaint.language.vocabulary.units import (
    FOREIGN_UNITS,
    PLAIN,
    SAME_UNITS,
    Dimension,
    instead_of,
    plausible_unit,
)
from dqpaint.language.vocabulary.words import CONSTANTS, FUNCTIONS, PROFILES
from dqpaint.program import Taylor


def unknown(node: Name, scope: Scope, words: Iterable[str] = ()) -> Problem:
    """E205, or E206 for a function without brackets; `words` are allowed there as well."""
    name = node.name
    if name in FUNCTIONS:
        help = f"write: {FUNCTIONS[name]}" + ("; a minute is 60 s" if name == "min" else "")
        return problem("E206", f"'{name}' is a function", node.span, "", help)
    if name in FOREIGN_UNITS:
        help, same = instead_of(name), SAME_UNITS.get(name)
        fix = Fix(f"write {same}", node.span, same) if same else None
        return problem("E205", f"'{name}' is not known", node.span, "", help, fix)
    if name.lower() in ("rainbow", "spectrum"):
        help = "draw it in parts: repeat i from 0 to 35, each with light hsv(10*i deg)"
        return problem("E205", f"'{name}' is not known", node.span, "", help)
    words = list(words)
    aliases = PROFILE_ALIASES if set(PROFILES) <= set(words) else {}
    known = (*scope.names, *CONSTANTS, *words)
    meant = _abbreviation(name, scope) or closest(name, known, aliases)
    help = did_you_mean(meant) or f"name it first: let {name} = …"
    if scope.text[: node.span.start].rstrip().endswith("--"):
        meant, help = "", "a comment begins with #"
    if "keep" in words and not meant:
        help += ", or write an orientation: rot(x, 180 deg)"
    if not meant and set(words) == set(PROFILES):
        help = f"the profiles are: {join_words(PROFILES)}"
    fix = Fix(f"write {meant}", node.span, meant) if meant else None
    return problem("E205", f"'{name}' is not known", node.span, "", help, fix)


def _abbreviation(name: str, scope: Scope) -> str:
    """A name of the file that begins with the unknown one: `radius` for `r`."""
    short = [known for known in scope.names if len(known) <= 3 and name.startswith(known)]
    return max(short, key=len) if short else ""


def no_value_of(node: Name, value: Function | Procedure) -> Problem:
    """E206: the name of a function or of a `def` without a call."""
    if isinstance(value, Function):
        help = f"write: {value.name}({', '.join(value.params)})"
        return problem("E206", f"'{node.name}' is a function", node.span, "", help)
    return problem("E206", f"'{node.name}' is drawn, it has no value", node.span, "", _CALLED)


_CALLED = "a call of it is a line of its own"


def wrong_count(function: Function, node: Call) -> Problem:
    """E207."""
    count = len(function.params)
    noun = "value" if count == 1 else "values"
    message = f"{function.name} takes {count or 'no'} {noun}, not {len(node.values)}"
    help = f"write: {function.name}({', '.join(function.params)})"
    return problem("E207", message, node.span, "", help)


def too_many(node: Bracket, scope: Scope) -> Problem:
    """E202."""
    count, help = len(node.values), "write decimals with a point, not a comma: 0.5"
    fix, written = None, [scope.written(value) for value in node.values]
    if count in (4, 6) and all(isinstance(value, Literal) for value in node.values):
        pairs = zip(written[::2], written[1::2], strict=True)
        decimals = [f"{whole}.{part}" for whole, part in pairs]
        if all(text.isdigit() for text in written):
            help = f"write decimals with a point, not a comma: {decimals[0]}"
            unit = f" {node.unit}" if node.unit else ""
            fix = Fix("write decimal points", node.span, f"({', '.join(decimals)}){unit}")
    message = f"a point has 2 or 3 numbers, this has {count}"
    return problem("E202", message, node.span, "", help, fix)


def mixed(node: Bracket, coordinates: list[Quantity], scope: Scope) -> Problem:
    """E204, at the number without a unit, else at the first dimension that differs."""
    plain = [i for i, q in enumerate(coordinates) if q.dimension == PLAIN and not is_zero(q)]
    first = next(q.dimension for q in coordinates if not is_zero(q))
    others = [i for i, q in enumerate(coordinates) if q.dimension != first and not is_zero(q)]
    at = (plain or others)[0]
    literals = [child for child in node.values if isinstance(child, Literal)]
    units = {child.unit for child in literals if child.unit}
    help, fix = "give each of them a unit of the same kind", None
    if len(literals) == len(node.values) and len(units) == 1:
        numbers = ", ".join(
            scope.written(child).removesuffix(child.unit).rstrip() for child in literals
        )
        mended = f"({numbers}) {units.pop()}"
        help = f"one unit after the bracket is enough: {mended}"
        fix = Fix(f"write {mended}", node.span, mended)
    elif plain:
        help = f"{scope.written(node.values[at])} needs a unit too"
    return problem(
        "E204",
        "the numbers of one point must have the same unit",
        node.values[at].span,
        f"{scope.written(node.values[at])} is {describe(coordinates[at])}",
        help,
        fix,
    )


def second_unit(node: Bracket, what: str) -> Problem:
    """E210."""
    message = f"'{node.unit}' can't follow here: the value in the brackets is {what}"
    span = Span(node.span.end - len(node.unit), node.span.end)
    return problem("E210", message, span, "", "give the unit once: to each number, or here")


def unknown_function(node: Call, scope: Scope) -> Problem:
    """E206."""
    span = Span(node.span.start, node.span.start + len(node.name))
    if isinstance(scope.names.get(node.name), Procedure):
        message = f"'{node.name}' is drawn, it has no value"
        return problem("E206", message, span, "", _CALLED)
    if node.name in scope.names or node.name in BUILTINS:
        message = f"'{node.name}' is not a function"
        help = f"a product is written {node.name}*(…)"
        return problem("E206", message, span, "", help)
    if node.name in ("RGB", "rgba"):
        written = _hexadecimal(node.values)
        help = f'write the colour in quotes: "{written or "#ff8800"}"'
        fix = Fix(f'write "{written}"', node.span, f'"{written}"') if written else None
        return problem("E206", f"there is no function '{node.name}'", span, "", help, fix)
    own = [name for name, value in scope.names.items() if isinstance(value, Function)]
    known = (*own, *functions.TABLE)
    meant = closest(node.name, known, FUNCTION_ALIASES)
    fix = Fix(f"write {meant}", span, meant) if meant in known else None
    message = f"there is no function '{node.name}'"
    return problem("E206", message, span, "", did_you_mean(meant), fix)


def _hexadecimal(values: tuple[Expression, ...]) -> str:
    """The colour of `RGB(255, 0, 0)` as #ff0000; empty if its numbers are no such colour."""
    numbers = [value.value for value in values[:3] if isinstance(value, Literal) and not value.unit]
    if len(numbers) < 3 or not all(0.0 <= number <= 255.0 for number in numbers):
        return ""
    most = 1.0 if max(numbers) <= 1.0 else 255.0
    return "#" + "".join(f"{round(255.0 * number / most):02x}" for number in numbers)


def no_sum(
    left: Value, right: Value, sign: str, first: Expression, child: Expression, scope: Scope
) -> Problem:
    """E208, at the number without a unit if one of the two has none."""
    if sign == "+":
        message = f"can't add {describe(left)} and {describe(right)}"
    else:
        message = f"can't subtract {describe(right)} from {describe(left)}"
    at, lacking, other = child, right, left
    if isinstance(left, Quantity | PointValue) and left.dimension == PLAIN:
        at, lacking, other = first, left, right
    help, fix = "", None
    alike = isinstance(lacking, Quantity | PointValue) and type(lacking) is type(other)
    if alike and isinstance(lacking, Quantity | PointValue) and lacking.dimension == PLAIN:
        assert isinstance(other, Quantity | PointValue)
        if written := with_unit(at, lacking, other.dimension, scope):
            help = f"did you mean {written}?"
            fix = Fix(f"write {written}", at.span, written)
    elif {type(left), type(right)} == {PointValue, Quantity}:
        help = "a point goes with a point: (5, 0) mm"
    return problem("E208", message, at.span, describe(lacking), help, fix)


def with_unit(
    node: Expression,
    value: Quantity | PointValue,
    dimension: Dimension,
    scope: Scope,
    word: str = "",
) -> str:
    """A value without a unit, written with its most likely unit."""
    numbers = (value.value,) if isinstance(value, Quantity) else value.xyz
    sizes = [abs(number) for number in numbers if not isinstance(number, Taylor)]
    unit = plausible_unit(max(sizes, default=1.0), dimension, word)
    written = scope.written(node)
    if not unit or len(written) > 60:
        return ""
    if isinstance(node, Literal | Bracket) or (
        isinstance(node, Negation) and isinstance(node.value, Literal | Bracket)
    ):
        return f"{written} {unit}"
    if isinstance(node, Name | Call):
        return f"{written}*{unit}"
    return f"({written}) {unit}"


def no_product(left: Value, right: Value, verb: str, by: str, child: Expression) -> Problem:
    """E209."""
    message = f"can't {verb} {describe(left)} {by} {describe(right)}"
    help = ""
    if isinstance(left, PointValue) and isinstance(right, PointValue):
        help = "a point can be multiplied by a number; for one of its parts, write that part"
    return problem("E209", message, child.span, describe(right), help)

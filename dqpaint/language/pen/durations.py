"""Time clauses -> duration or speed of a stroke, and its division among legs."""

from dqpaint.diagnostics import Span, problem
from dqpaint.language.pen.stroke_state import StrokeState
from dqpaint.language.syntax.tree import Statement
from dqpaint.language.values import typed_values
from dqpaint.language.values.scope import Scope
from dqpaint.program import CruiseSpeed, Duration, Samples, Timing


def timing(statement: Statement, state: StrokeState, scope: Scope) -> Timing:
    """The timing of a statement by its own clauses or the state's."""
    for part in statement.parts:
        if part.word not in ("in", "samples"):
            continue
        if part.word == "in":
            return Duration(typed_values.positive(part.expression, scope, "in"))
        return Samples(typed_values.count(part.expression, scope, "samples", least=1))
    return CruiseSpeed(state.speed, state.turnspeed)


def divide_timing(whole: Timing, shares: list[float], span: Span) -> list[Timing]:
    """The timing of each leg: `shares` [any unit] are the legs' lengths."""
    if len(shares) == 1 or isinstance(whole, CruiseSpeed):
        return [whole] * len(shares)
    total = sum(shares)
    if isinstance(whole, Duration):
        return [Duration(whole.seconds * share / total) for share in shares]
    if whole.count < len(shares):
        message = f"{len(shares)} legs need at least {len(shares)} samples"
        raise problem("E256", message, span, "", f"write: samples {len(shares)}")
    return [Samples(count) for count in apportion(whole.count, shares)]


def apportion(count: int, shares: list[float]) -> list[int]:
    """Whole numbers in about these shares, each at least 1, with the exact sum `count`."""
    spare, total = count - len(shares), sum(shares)
    exact = [spare * share / total for share in shares]
    counts = [1 + int(part) for part in exact]
    most_left = sorted(range(len(shares)), key=lambda i: int(exact[i]) - exact[i])
    for i in most_left[: count - sum(counts)]:
        counts[i] += 1
    return counts

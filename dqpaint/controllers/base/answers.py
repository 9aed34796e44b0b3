"""The value that a user's law returns -> floats of the right shape, or an error."""

from typing import Any

import numpy as np

from dqpaint.controllers.base.controller import Commands
from dqpaint.core import AnswerError
from dqpaint.dq import Floats

COMMAND_NAMES = {
    "twist": "a twist",
    "rates": "joint rates",
    "acceleration": "an acceleration",
    "torque": "joint torques",
}


def check_answer(returned: Any, wanted: tuple[int, ...], kind: Commands, where: str) -> Floats:
    """The returned value as floats; its shape is checked before anything is copied.

    Args:
        returned: what the law returned.
        wanted: the shape, (6,) or (n,), with that of a batch before it.
        kind: what the law commands.
        where: the law's file and line, for messages.

    Raises:
        AnswerError: it is anything else.
    """
    if _is_masked(returned):
        raise AnswerError(
            f"{where}: the law returned masked numbers; fill them (numpy.ma.filled) or leave them "
            "out: what is under a mask is no command"
        )
    shape = _shape(returned)
    answer = np.zeros(0)
    if shape in (None, wanted[:1], wanted):
        try:
            answer = np.asarray(returned)
            shape = answer.shape or None
        except ValueError:  # a list of lists of several lengths
            shape = (*wanted, -1)
    if shape != wanted:
        count = f"{wanted[-1]} numbers" if len(wanted) == 1 else f"an array of shape {wanted}"
        raise AnswerError(
            f"{where}: a law that commands {COMMAND_NAMES[kind]} returns {count}, "
            f"this one returned {_describe(returned, shape)}"
        )
    if answer.dtype.kind == "c":
        raise AnswerError(f"{where}: the law returned complex numbers, not real ones")
    is_text = answer.dtype == object and any(isinstance(x, str | bytes) for x in answer.flat)
    if is_text or answer.dtype.kind not in "iufO":
        first = answer.flat[0]
        type_name = type(first if answer.dtype == object else first.item()).__name__
        raise AnswerError(f"{where}: the law returned values of type {type_name}, not numbers")
    try:
        if answer.dtype == object and None in answer.ravel().tolist():
            raise TypeError
        return np.array(answer, dtype=np.float64)
    except OverflowError:
        return np.full(wanted, np.inf)
    except (TypeError, ValueError):
        raise AnswerError(f"{where}: the law returned values that are not numbers") from None


def _is_masked(returned: Any) -> bool:
    """Whether it is a masked array, or a list with masked values; numpy.ma is not imported."""
    parts = returned if isinstance(returned, list | tuple) else (returned,)
    return any(isinstance(getattr(part, "mask", None), np.bool | np.ndarray) for part in parts)


def _shape(returned: Any) -> tuple[int, ...] | None:
    """Of an array or a list; None of anything else."""
    shape = getattr(returned, "shape", None)
    if isinstance(shape, tuple):
        return shape or None
    return (len(returned),) if isinstance(returned, list | tuple) else None


def _describe(returned: Any, shape: tuple[int, ...] | None) -> str:
    if returned is None:
        return "nothing"
    if shape and min(shape) < 0:
        return "rows of several lengths"
    return f"an array of shape {shape}" if shape else f"a {type(returned).__name__}"

"""A writer of files -> whether it describes itself and writes the same bytes each time."""

from functools import cache

from dqpaint.language import parse
from dqpaint.outputs import WRITERS, Writer
from dqpaint.painting import paint
from dqpaint.settings import Settings
from dqpaint.testing.runs import DRAWING, require


def check_writer(writer: str | Writer, drawing: str = DRAWING, repeats: bool = True) -> None:
    """Check what every writer promises.

    Its function has a docstring and its files have endings; a small painting by the default arm
    gives files that are not empty, with the same bytes when it is written again.

    Args:
        writer: its name, or the `Writer`.
        drawing: a text of the language that it can write; a short one of its own by default.
        repeats: whether the bytes must be the same each time, and not the lengths alone.

    Raises:
        AssertionError: a promise that is not kept.
    """
    one = WRITERS[writer] if isinstance(writer, str) else writer
    require(bool((one.function.__doc__ or "").strip()), "a writer has a docstring")
    painting = _painting(drawing)
    for need in one.needs:
        require(bool(need.words), "what a writer needs is said in words, for lists")
        need.check(painting)
    told: list[float] = []
    first, second = one.make(painting, told.append), one.make(painting, told.append)
    require(bool(first), "a writer makes a file")
    for ending, data in first.items():
        require(ending[:1] in (".", "-"), f"the ending '{ending}' begins with . or -")
        require(isinstance(data, bytes) and bool(data), f"the file '{ending}' has bytes")
    if repeats:
        require(first == second, "the same painting gives the same bytes")
    lengths = [{ending: len(data) for ending, data in made.items()} for made in (first, second)]
    require(lengths[0] == lengths[1], "the same painting gives files of the same length")
    require(all(0.0 <= part <= 1.0 for part in told), "progress is from 0 to 1")


@cache
def _painting(drawing: str) -> paint.Painting:
    return paint.paint(parse(drawing, "check.traj"), Settings(width=64, height=36))

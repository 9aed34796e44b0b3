"""A painting and the names of formats -> the bytes of their files: the writers, one registry."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from inspect import signature
from typing import TYPE_CHECKING, Any, NamedTuple, TypeVar

from dqpaint.core import Folder, Registry
from dqpaint.errors import UnknownNameError, UsageError

if TYPE_CHECKING:
    from dqpaint.painting import paint

Files = bytes | dict[str, bytes]
"""One file, or several by the endings that follow the stem."""
Progress = Callable[[float], None]
F = TypeVar("F", bound=Callable[..., Files])


class Need(NamedTuple):
    """What a painting must have for a writer.

    Attributes:
        words: for lists.
        check: raises a DqpaintError that says what a painting lacks.
        before: whether that is known before the run: then `check` takes a `PreparedRun`, too.
    """

    words: str
    check: Callable[[Any], None]
    before: bool = False


@dataclass(frozen=True)
class Writer:
    """A named format.

    Attributes:
        name: as `draw --save` takes it.
        ending: of its file, after the stem; of the first, if there are several.
        function: a painting -> its files; one with a parameter `progress` calls it with the part
            done, 0 to 1.
        needs: checked before anything is written.
        export_name: as `export --format` takes it; None: it is not for real arms.
    """

    name: str
    ending: str
    function: Callable[..., Files]
    needs: tuple[Need, ...] = ()
    export_name: str | None = None

    @property
    def about(self) -> str:
        """The first line of the function's docstring."""
        return (self.function.__doc__ or "").strip().splitlines()[0]

    def make(self, painting: "paint.Painting", progress: Progress) -> dict[str, bytes]:
        """Its files by their endings."""
        wants = "progress" in signature(self.function).parameters
        made = self.function(painting, **({"progress": progress} if wants else {}))
        return made if isinstance(made, dict) else {self.ending: made}


def _from_plugin(name: str, thing: object) -> Writer:
    if isinstance(thing, Writer):
        return thing
    raise UsageError(f"'{name}' is not registered by @dqpaint.outputs.writer under that name")


WRITERS: Registry[Writer] = Folder(
    "format", "dqpaint.outputs.formats", "dqpaint.formats", _from_plugin
)


def writer(name: str, ending: str, *needs: Need) -> Callable[[F], F]:
    """A decorator that registers the function below it; arguments as in `Writer`."""

    def record(function: F) -> F:
        WRITERS.add(name)(Writer(name, ending, function, needs))
        return function

    return record


def choose_writers(what: str) -> list[Writer]:
    """The writers of a list of names with commas.

    Raises:
        UsageError: an unknown format, or none at all.
    """
    names = [name.strip() for name in what.split(",") if name.strip()]
    if not names:
        raise UsageError(f"nothing to save in '{what}'; known: {', '.join(WRITERS)}")
    return [WRITERS[name] for name in names]


def choose_export_writer(form: str | None) -> Writer:
    """The writer of a format for real arms.

    Raises:
        UsageError: an unknown format, or none.
    """
    known = {one.export_name: one for one in WRITERS.values() if one.export_name}
    if form is None:
        raise UsageError(f"export needs a --format: {', '.join(sorted(known))}")
    if form not in known:
        raise UnknownNameError("format", form, sorted(known))
    return known[form]


def check_before_run(writers: Sequence[Writer], run: "paint.PreparedRun") -> None:
    """Check what writers need, as far as it is known before the run.

    Raises:
        DqpaintError: the run lacks what a writer needs.
    """
    for one in writers:
        for need in one.needs:
            if need.before:
                need.check(run)


def make_files(
    writers: Sequence[Writer], painting: "paint.Painting", progress: Progress = lambda _done: None
) -> dict[str, bytes]:
    """The files of some writers by their endings.

    Args:
        writers: from `choose_writers`.
        painting: what to write.
        progress: called by what takes long, with the part done, 0 to 1.

    Raises:
        DqpaintError: the painting lacks what a writer needs; raised before anything is written.
    """
    for one in writers:
        for need in one.needs:
            need.check(painting)
    files: dict[str, bytes] = {}
    for one in writers:
        files.update(one.make(painting, progress))
    return files

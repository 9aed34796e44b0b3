"""Contents and a place -> files, written whole or not at all."""

import os
import tempfile
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import TYPE_CHECKING

from dqpaint.core import finish_interrupted, log, make_folder, write_together
from dqpaint.errors import OutputError
from dqpaint.outputs.formats.pictures import encode_pictures
from dqpaint.outputs.registry import WRITERS

if TYPE_CHECKING:
    from dqpaint.painting import picture


def stem_for(out: str | None, name: str, note: Callable[[str], None] = lambda _text: None) -> Path:
    """The path of the files to write, without their endings.

    What a power cut or a kill left in their folder is finished.

    Args:
        out: a folder (that exists, or ends with a slash) or a stem; None is the current folder.
        name: of the files, where `out` is a folder.
        note: called with a sentence if something was finished.

    Raises:
        OutputError: the folder does not exist or cannot be written.
    """
    try:
        stem, folder = _stem_and_folder(out, name)
        with tempfile.TemporaryFile(dir=folder):
            pass
        for text in finished(folder):
            note(text)
        return stem
    except (OSError, ValueError) as problem:
        reason = problem.strerror if isinstance(problem, OSError) else str(problem)
        raise OutputError(f"'{(out or '.')[:60]}' cannot be written: {reason}") from None


def _stem_and_folder(out: str | None, name: str) -> tuple[Path, Path]:
    if not out:
        return Path(name), Path()
    target = Path(out)
    if out.endswith(("/", os.sep)):
        make_folder(target)
    if target.is_dir():
        return target / name, target
    # `--out star.png` names the picture, and its stem
    if target.suffix and target.suffix in {one.ending for one in WRITERS.values()}:
        target = target.with_suffix("")
    if target.exists() and not target.is_file():  # such as /dev/null
        raise OutputError(f"'{target}' is neither a folder nor a file")
    if target.parent.exists() and not target.parent.is_dir():
        raise OutputError(f"'{target.parent}' is a file, not a folder")
    if not target.parent.is_dir():
        made = "a path that ends with / is made"
        raise OutputError(f"folder '{target.parent}' does not exist; {made}")
    return target, target.parent


def finished(folder: Path) -> list[str]:
    """Finish what a power cut or a kill left in a folder; a sentence if it was any.

    Raises:
        OutputError: the folder cannot be written.
    """
    try:
        names = finish_interrupted(folder)
    except OSError as problem:
        raise OutputError(f"'{folder}' cannot be written: {problem.strerror}") from None
    if not names:
        return []
    return [
        f"an earlier command was cut off while it wrote to '{folder}'; its files are in "
        f"their places now: {', '.join(sorted(names))}"
    ]


def write(stem: Path, contents: dict[str, bytes]) -> list[Path]:
    """Write files beside each other, all of them or none; they are on the disk when it returns.

    Their folder is made if it is not there.

    Args:
        stem: path without endings.
        contents: the bytes of each file by its ending.

    Raises:
        OutputError: a file could not be written; every file there is whole, the old or the new one.
    """
    named = {f"{stem.name}{end}": data for end, data in contents.items()}
    try:
        write_together(stem.parent, named)
    except OSError as problem:
        raise OutputError(f"'{stem}' cannot be written: {problem.strerror}") from None
    for name, data in named.items():
        log("outputs", "wrote %s, %d bytes", stem.with_name(name), len(data))
    return [stem.with_name(name) for name in named]


def picture_files(taken: "Sequence[picture.Picture]") -> dict[str, bytes]:
    """The bytes of pictures alone, for `write`."""
    return encode_pictures(taken)

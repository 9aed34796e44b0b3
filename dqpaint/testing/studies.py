"""A study -> whether it is described, goes on where it stopped, and repeats itself."""

from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

from dqpaint.core import subclass
from dqpaint.studies.declared import STUDIES, Study, run_study
from dqpaint.testing.runs import DRAWING, require


def check_study(study: str | type[Study], subject: str | None = None, **given: Any) -> None:
    """Check what every study promises.

    It has a docstring; each of its parameters has a default and hides no setting; its tables and
    files are there; carried out again in the same folder it does no run again; and its files have
    the same bytes then, and in another folder with two workers.

    Args:
        study: its name, or its class.
        subject: what it is carried out with: a drawing of the checks' own by default.
        given: parameters and settings, as `dqpaint.study` takes them; choose few and short runs.

    Raises:
        AssertionError: a promise that is not kept.
    """
    kind = STUDIES[study] if isinstance(study, str) else subclass(Study, "study", study)  # type: ignore[type-abstract]
    require(bool((kind.__doc__ or "").strip()), "a study has a docstring")
    settings = {one.name for one in kind.settings()}
    for one in kind.parameters():
        require(not one.info.is_required(), f"its parameter '{one.name}' has a default")
        require(one.name not in settings, f"its parameter '{one.name}' hides no setting")
    with TemporaryDirectory(prefix="dqpaint-check-") as scratch:
        drawing = Path(scratch) / "check.traj"
        drawing.write_text(DRAWING)
        about = subject or str(drawing)
        place = Path(scratch) / "one"
        first = _contents(study, about, place, {"jobs": 1, **given})
        kept = _files(place)
        again = _contents(study, about, place, {"jobs": 1, **given})
        require(_files(place) == kept, "what its folder has is not run again")
        require(again == first, "the same folder gives the same files")
        other = _contents(study, about, Path(scratch) / "other", {"jobs": 2, **given})
    require(other == first, "another folder and two workers give the same files")


def _files(folder: Path) -> dict[Path, bytes]:
    """What lies in a folder, such as the journal of a study."""
    return {path: path.read_bytes() for path in folder.rglob("*") if path.is_file()}


def _contents(
    study: str | type[Study], subject: str, folder: Path, given: dict[str, Any]
) -> dict[str, bytes]:
    """The files of a finished study by their endings, without its page."""
    made = run_study(study, subject, given, folder)
    require(bool(made.table_text().strip()), "it has a table as text")
    files = made.contents()
    for ending, data in files.items():
        require(ending[:1] in (".", "-"), f"the ending '{ending}' begins with . or -")
        require(isinstance(data, bytes) and bool(data), f"the file '{ending}' has bytes")
    return files

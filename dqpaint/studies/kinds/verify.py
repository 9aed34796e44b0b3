"""A folder of regression pictures -> each drawn again and compared with its reference."""

import math
import tempfile
from collections.abc import Sequence
from contextlib import suppress
from dataclasses import dataclass
from pathlib import Path

from dqpaint.core import tables
from dqpaint.diagnostics import Annotation
from dqpaint.errors import DqpaintError, OutputError
from dqpaint.light.images import contact_sheet, difference_picture
from dqpaint.outputs import files
from dqpaint.studies.kinds.study_result import ANY_WIDTH, StudyResult
from dqpaint.studies.report.page import Page, Rows, Shot, Words, html
from dqpaint.studies.runner.engine import Workers, carry_out_study
from dqpaint.studies.runner.reporter import SILENT, Reporter
from dqpaint.studies.runner.run import Result
from dqpaint.studies.runner.run_arrays import read_arrays
from dqpaint.studies.verify.gates import GATES, GateResult, developed_from, failed_gates, measure
from dqpaint.studies.verify.references import (
    Arrays,
    Case,
    Reference,
    encode_reference,
    read_cases,
    read_reference,
    settings_of,
    sha256,
)


@dataclass(frozen=True)
class Verdict:
    """What came of one case.

    Attributes:
        case: what was drawn.
        result: of its run.
        reference: what it was compared with; None if there is none.
        made: film and picture; None where the run failed.
        measured: the comparison; None where there was nothing to compare.
        faults: what is wrong, in words: the gates that spoke, or why there is no picture.
        remarks: what else has changed.
    """

    case: Case
    result: Result
    reference: Reference | None
    made: Arrays | None
    measured: GateResult | None
    faults: tuple[str, ...]
    remarks: tuple[str, ...] = ()


@dataclass(frozen=True, kw_only=True)
class Verification(StudyResult):
    """A finished verification: a verdict a case; `changes` are of the references that were made."""

    verdicts: tuple[Verdict, ...]
    changes: tuple[str, ...] | None = None

    @property
    def remarks(self) -> list[str]:
        """What else has changed."""
        return remarks(self.verdicts)

    @property
    def passed(self) -> bool:
        """Whether all are alike, or now references."""
        return self.changes is not None or not any(one.faults for one in self.verdicts)

    def table_text(self, width: int = ANY_WIDTH) -> str:
        """The gates of each case, or what changed."""
        return table_text(self.verdicts) if self.changes is None else "\n".join(self.changes)

    @property
    def annotations(self) -> list[Annotation]:
        """Each fault at the drawing or the list of cases that it is of."""
        return [
            Annotation(one.case.run.name, "error", "verify", f"{one.case.name}: {fault}")
            for one in self.verdicts
            for fault in one.faults
        ]

    def save(self, command: str | None = None) -> list[Path]:
        """Write the pictures of what differs; returns their paths."""
        if self.changes is not None:
            return []
        return save_differences(self.verdicts, self.folder, command)


def verify(
    folder: Path,
    jobs: Workers = None,
    lenient: bool = False,
    reporter: Reporter = SILENT,
    trust: bool = False,
) -> list[Verdict]:
    """Draw every case of a folder again and compare.

    Args:
        folder: of drawings and references.
        jobs: how many processes, None is one a core; or the address of a Dask cluster.
        lenient: a reference that cannot be read counts as none, for it will be made again.
        reporter: is told how far it is.
        trust: whether cases may name code that lies outside of the folder.

    Raises:
        DqpaintError: the folder has no cases, or a reference is damaged.
        UsageError: a setting of a case is none.
    """
    with suppress(OutputError):  # one that cannot be written can be compared with
        for note in files.finished(folder) if folder.is_dir() else ():
            reporter.note(note)
    cases = read_cases(folder, trust)
    references = [_reference(folder, case, lenient) for case in cases]
    with tempfile.TemporaryDirectory(prefix="dqpaint-verify-") as scratch:
        results = carry_out_study(
            [case.run for case in cases], Path(scratch), jobs, "verify", reporter
        )
        return [
            _judge(case, result, reference, read_arrays(Path(scratch), result.key))
            if result.figures
            else Verdict(case, result, reference, None, None, (f"run {_why(result)}",))
            for case, result, reference in zip(cases, results, references, strict=True)
        ]


def _reference(folder: Path, case: Case, lenient: bool) -> Reference | None:
    try:
        return read_reference(folder, case)
    except DqpaintError:
        if lenient:
            return None
        raise


def _why(result: Result) -> str:
    return f"{result.status}: {result.message}" if result.message else result.status


def _judge(case: Case, result: Result, reference: Reference | None, made: Arrays) -> Verdict:
    if reference is None:
        hint = "there is nothing to compare it with yet; --update makes a reference"
        return Verdict(case, result, None, made, None, ("no reference",), (hint,))
    facts = reference.facts
    remarks = []
    if facts["sha256"] != sha256(case.run):
        remarks.append("the drawing's text has changed")
    if facts["settings"] != settings_of(case.run):
        remarks.append("its settings have changed")
    if not reference.alike:
        remarks.append("made by other versions of the libraries: the wider gates hold")
    if made["planes"].shape != reference.planes.shape:
        return Verdict(case, result, reference, made, None, ("size",), tuple(remarks))
    measured = measure(reference, result, made)
    faults = failed_gates(measured, reference.alike)
    if facts.get("status") != result.status:
        faults.insert(0, f"run {_why(result)}")
    return Verdict(case, result, reference, made, measured, tuple(faults), tuple(remarks))


def table_text(verdicts: Sequence[Verdict]) -> str:
    """The table for a terminal."""
    return "\n".join(tables.align(table(verdicts)))


def table(verdicts: Sequence[Verdict]) -> list[list[str]]:
    """Headings and rows: what was measured of each case, and the gate that spoke."""
    lines = [["case", *(gate.name for gate in GATES), "verdict"]]
    for one in verdicts:
        measured = one.measured
        numbers = ["-" if measured is None else f"{gate.measure(measured):.2g}" for gate in GATES]
        lines.append([one.case.name, *numbers, "differs: " + ", ".join(one.faults)]
                     if one.faults else [one.case.name, *numbers, "alike"])  # fmt: skip
    for limits, alike in (("same libraries, at most", True), ("other versions", False)):
        values = [gate.same if alike else gate.other for gate in GATES]
        shown = (f"{value:.2g}" if math.isfinite(value) else "-" for value in values)
        lines.append([limits, *shown, ""])
    return lines


def remarks(verdicts: Sequence[Verdict]) -> list[str]:
    """What else has changed, a sentence each."""
    return [f"{one.case.name}: {text}" for one in verdicts for text in one.remarks]


def save_differences(
    verdicts: Sequence[Verdict], out: Path, again: str | None = None
) -> list[Path]:
    """Reference, new and amplified difference of each case that differs; returns the paths.

    Args:
        verdicts: from `verify`.
        out: the folder; made if there is something to write.
        again: the command that does it again, for a report; None for no report.

    Raises:
        OutputError: the folder cannot be written.
    """
    written = []
    shots = []
    for one in verdicts:
        if not one.faults or one.reference is None or one.made is None or one.measured is None:
            continue
        lights = [developed_from(planes) for planes in (one.reference.planes, one.made["planes"])]
        gap, factor = difference_picture(*lights)
        labels = [f"{one.case.name}: reference", f"new: {', '.join(one.faults)}",
                  f"difference of the light, {factor:.3g} times"]  # fmt: skip
        pictures = [one.reference.picture, one.made["picture"], gap]
        data = contact_sheet.encode_png(contact_sheet.sheet(pictures, labels, columns=3))
        written += files.write(out / one.case.name, {"-differs.png": data})
        shots.append(Shot(f"{one.case.name}: reference, new, and where they differ", data))
    if again is not None:
        written += files.write(out / "verify", {"-report.html": html(page(verdicts, shots, again))})
    return written


def page(verdicts: Sequence[Verdict], shots: Sequence[Shot], again: str) -> Page:
    """The verdicts as a report."""
    bad = [one.case.name for one in verdicts if one.faults]
    said = f"{len(bad)} of {len(verdicts)} differ: {', '.join(bad)}." if bad else "All are alike."
    words = Words("\n".join([said, *remarks(verdicts)]))
    return Page(
        "Guarded pictures", [words, Rows("Gates", table(verdicts)), *shots],
        again=again,
    )  # fmt: skip


def update(verdicts: Sequence[Verdict], folder: Path) -> list[str]:
    """Write the references that are new or differ; says what changed, a line each.

    Raises:
        DqpaintError: a case has no picture to become a reference.
    """
    broken = [one for one in verdicts if one.made is None]
    if broken:
        one = broken[0]
        raise DqpaintError(f"{one.case.name}: {one.faults[0]}; no reference was changed")
    lines = []
    for one in verdicts:
        if one.made is None or not (one.faults or one.remarks):
            lines.append(f"{one.case.name}: unchanged")
            continue
        png = contact_sheet.encode_png(one.made["picture"])
        files.write(folder / one.case.name, encode_reference(one.case, one.result, one.made, png))
        lines.append(f"{one.case.name}: {_change(one)}")
    return lines


def _change(one: Verdict) -> str:
    if one.reference is None:
        return "new"
    parts = [*one.remarks, *one.faults]
    if one.measured is not None and one.measured.worst:
        name = one.measured.worst
        before = one.reference.facts["figures"].get(name)
        after = one.result.figures.get(name)
        if before is not None and after is not None and before != after:
            parts.append(f"{name} was {before:.6g}, is {after:.6g}")
    return "; ".join(parts)

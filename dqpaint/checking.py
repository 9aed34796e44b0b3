"""What `check` says of a drawing, for people and for programs."""

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

from dqpaint import __version__
from dqpaint.errors import DqpaintError, UsageError
from dqpaint.examples import find_drawing
from dqpaint.language import Diagnostic, ScriptError, read, render
from dqpaint.language.diagnostics import Severity, Span, file_at, place
from dqpaint.motion import Motion, plan, summary_line
from dqpaint.robots.card import Card
from dqpaint.robots.choose import card_for


@dataclass(frozen=True)
class Checked:
    """One drawing, read: what was found, and its figures where it can be drawn."""

    file: str
    source: str
    findings: tuple[Diagnostic, ...]
    motion: Motion | None
    fault: str = ""  # of a file that could not even be read
    reach: str = ""  # what the arm says of it, where an arm was asked

    @property
    def errors(self) -> int:
        """How many things stop this drawing."""
        stopping = sum(d.severity is Severity.ERROR for d in self.findings)
        return stopping + bool(self.fault)

    @property
    def text(self) -> str:
        """As a person reads it."""
        if self.fault:
            return f"error: {self.fault}"
        parts = [render(finding, self.file, self.source) for finding in self.findings]
        if self.motion is not None:
            parts.append(summary_line(self.motion) + self.reach + self._hint)
        return "\n\n".join(parts)

    @property
    def _hint(self) -> str:
        """Of beads at the ends of strokes, which a light painter sees first."""
        assert self.motion is not None
        times = self.motion.unevenness
        if times <= BEAD:
            return ""
        return (
            f"\nhint: near their ends strokes are {times:.2g} times as bright as in the middle, "
            "where the tool is fast; for an even line write: light white even"
        )


BEAD = 2.0  # times the brightness of the middle: less is no matter for a hint


def check(name: str, robot: str | None) -> Checked:
    """Read one drawing and plan its motion; nothing is simulated.

    The reach is looked at where an arm is named, in the call or in the file.

    Raises:
        UsageError: no such robot.
    """
    try:
        path = find_drawing(name)
        program = read(path)
        card = card_for(program, robot)
        motion = plan(program, card.canvas.pose)
        asked = robot is not None or program.robot is not None
        reach = _reach(motion, card) if asked else ""
    except ScriptError as problem:
        return Checked(problem.name, problem.text, problem.diagnostics, None)
    except UsageError:
        raise
    except DqpaintError as problem:
        return Checked(name, "", (), None, str(problem))
    return Checked(str(path), program.text, motion.notes, motion, reach=reach)


def _reach(motion: Motion, card: Card) -> str:
    """Whether an arm reaches all of a drawing; only this brings in the kinematics.

    Raises:
        ScriptError: it does not.
    """
    from dqpaint.out_of_reach import begin
    from dqpaint.robots.kinematics import Kinematics

    arm = Kinematics(card)
    notes = "".join(f"\nnote: {note}" for note in arm.notes)
    margin = math.degrees(begin(motion, arm).margin)
    said = (
        f"but a joint has to go {-margin:.0f} deg beyond its limit"
        if margin < 0
        else f"every joint {margin:.0f} deg or more from its limits"
    )
    return f"; {card.name} reaches it, {said}{notes}"


def as_json(results: Sequence[Checked]) -> dict[str, Any]:
    """The findings of several drawings: 1-based, columns in code points, ends not included."""
    findings = [(result, finding) for result in results for finding in result.findings]
    warnings = sum(d.severity is Severity.WARNING for _, d in findings)
    planned = [result.motion for result in results if result.motion is not None]
    return {
        "version": 1,
        "tool": f"dqpaint {__version__}",
        "files": [_file(result) for result in results if result.motion is not None],
        "diagnostics": [_as_json(result, finding) for result, finding in findings]
        + [_unread(result) for result in results if result.fault],
        "summary": {
            "errors": sum(result.errors for result in results),
            "warnings": warnings,
            "samples": sum(len(motion.t) for motion in planned),
            "seconds": sum(float(motion.t[-1]) for motion in planned),
        },
    }


def _as_json(result: Checked, finding: Diagnostic) -> dict[str, Any]:
    fix = finding.fix
    return {
        "file": file_at(result.source, finding.span.start, result.file)[1]
        if finding.span is not None
        else result.file,
        "severity": finding.severity.value,
        "code": finding.code,
        "message": finding.message,
        **_range(result.source, finding.span),
        "label": finding.label,
        "help": finding.help,
        "explain": f"dqpaint explain {finding.code}",
        "related": [
            {
                "file": file_at(result.source, span.start, result.file)[1],
                **_range(result.source, span),
                "label": label,
            }
            for span, label in finding.related
        ],
        "fix": fix
        and {
            "title": fix.title,
            "edits": [{**_range(result.source, fix.span), "text": fix.text}],
        },
    }


def _file(result: Checked) -> dict[str, Any]:
    motion = result.motion
    assert motion is not None
    return {
        "file": result.file,
        "samples": len(motion.t),
        "seconds": float(motion.t[-1]),
        "length_m": motion.length,
        "ends_over_middle": motion.unevenness,
        "box_m": motion.box.tolist(),
    }


def _unread(result: Checked) -> dict[str, Any]:
    empty = Diagnostic("E001", result.fault, None)
    return _as_json(result, empty)


def _range(text: str, span: Span | None) -> dict[str, Any]:
    if span is None:
        return {"start": None, "end": None}
    ends = (place(text, offset) for offset in span)
    return dict(zip(("start", "end"), (at._asdict() for at in ends), strict=True))

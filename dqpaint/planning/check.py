"""A drawing's file -> the result of `check`: diagnostics and figures, as text and as JSON."""

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Any, Literal

from dqpaint import __version__
from dqpaint.core import find_drawing
from dqpaint.diagnostics import Annotation, Severity, Span, file_at, locate, url
from dqpaint.errors import DqpaintError, UsageError
from dqpaint.language import Diagnostic, Program, ScriptError, read, read_input, render
from dqpaint.language.syntax import STDIN
from dqpaint.motion import Motion, Survey, summary_line, survey

if TYPE_CHECKING:
    from dqpaint.planning.forecast_report import ForecastReport
    from dqpaint.settings import Settings


@dataclass(frozen=True)
class CheckResult:
    """The diagnostics of one drawing, and its figures where it can be drawn."""

    file: str
    source: str
    diagnostics: tuple[Diagnostic, ...]
    drawing: Motion | Survey | None
    fault: str = ""  # why the file could not be read
    forecast: "ForecastReport | None" = None  # where an arm is named

    @property
    def errors(self) -> int:
        """The number of errors."""
        stopping = sum(d.severity is Severity.ERROR for d in self.diagnostics)
        return stopping + bool(self.fault)

    @property
    def text(self) -> str:
        """As a person reads it."""
        return self.told(brief=False)

    def told(self, brief: bool) -> str:
        """As a person reads it; `brief` has no more than errors and warnings."""
        if self.fault:
            return f"error: {self.fault}"
        parts = [render(finding, self.file, self.source) for finding in self.diagnostics]
        if self.drawing is not None and not brief:
            forecast = self.forecast.text if self.forecast else ""
            parts.append(summary_line(self.drawing) + forecast + self._hint)
        return "\n\n".join(parts)

    @property
    def _hint(self) -> str:
        """A hint if strokes are much brighter near their ends than in the middle."""
        assert self.drawing is not None
        times = self.drawing.unevenness
        if times <= HINT_UNEVENNESS:
            return ""
        return (
            f"\nhint: near their ends strokes are {times:.2g} times as bright as in the middle, "
            "where the tool is fast; for an even line write: light white even"
        )

    @property
    def warnings(self) -> int:
        """The number of warnings."""
        return sum(d.severity is Severity.WARNING for d in self.diagnostics)


def count_line(results: Sequence[CheckResult]) -> str:
    """How many errors and warnings there are in how many drawings."""
    errors, warnings = (sum(getattr(r, kind) for r in results) for kind in ("errors", "warnings"))
    counts = " and ".join(
        f"{n} {word}{'s' if n != 1 else ''}"
        for n, word in ((errors, "error"), (warnings, "warning"))
        if n
    )
    drawings = f"{len(results)} drawing{'s' if len(results) != 1 else ''}"
    return f"{drawings} checked: {counts or 'no errors or warnings'}"


UNREADABLE = "E001"
HINT_UNEVENNESS = 2.0  # brightness of the ends over that of the middle


def check(name: str, **choices: Any) -> CheckResult:
    """Read one drawing and survey its motion; nothing is simulated.

    With any option of a run, or an arm named in the file, the arm's run is forecast, too: reach,
    limits, speeds, torques, singularities, collisions, occluded light.

    Args:
        name: of the drawing's file, or of an example; `-` is standard input.
        choices: of the run, as those of `dqpaint.draw`.

    Raises:
        UsageError: no such choice.
    """
    settings = _make_settings(choices)
    try:
        program = read_input() if name == STDIN else read(find_drawing(name))
        if settings is not None:
            program = replace(program, most_samples=settings.max_samples)
        needs_arm = _chooses_a_run(settings) or program.robot is not None
        forecast = _forecast(program, settings) if needs_arm else None
        drawing: Motion | Survey = forecast.motion if forecast else survey(program)
    except ScriptError as problem:
        return CheckResult(problem.name, problem.text, problem.diagnostics, None)
    except UsageError:
        raise
    except DqpaintError as problem:
        return CheckResult(name, "", (), None, str(problem))
    findings = drawing.notes + (forecast.warnings if forecast else ())
    return CheckResult(program.name, program.text, findings, drawing, forecast=forecast)


def _make_settings(choices: dict[str, Any]) -> "Settings | None":
    """The settings, if anything is chosen.

    Without one they are not imported, which would take a while.

    Raises:
        UsageError: no such choice.
    """
    if all(value is None for value in choices.values()):
        return None
    from dqpaint.settings import make_settings

    return make_settings(**choices)


def _chooses_a_run(settings: "Settings | None") -> bool:
    """Whether any option but `max_samples` is given."""
    return settings is not None and bool(
        settings.model_dump(exclude_defaults=True).keys() - {"max_samples"}
    )


def _forecast(program: Program, settings: "Settings | None") -> "ForecastReport":
    """The forecast of a drawing on its arm; only this imports arms and kinematics.

    Raises:
        UsageError: no such robot, or no such tool.
        ScriptError: a fault of the drawing, or the arm does not reach all of it.
    """
    from dqpaint.robots.loading import card_for
    from dqpaint.settings import Settings

    settings = settings or Settings()
    card = card_for(program, settings.robot, settings.tool)
    survey(program)  # errors of the drawing itself come before those of the arm

    from dqpaint.planning.forecast_report import make_report
    from dqpaint.robots.kinematics import make_kinematics
    from dqpaint.robots.resolvers import task_of

    kinematics = make_kinematics(card, settings.kinematics, task_of(settings, program))
    return make_report(program, kinematics, settings)


def as_json(results: Sequence[CheckResult]) -> dict[str, Any]:
    """The diagnostics of several drawings: 1-based, columns in code points, ends excluded."""
    findings = [(result, finding) for result in results for finding in result.diagnostics]
    surveyed = [result.drawing for result in results if result.drawing is not None]
    return {
        "version": 1,
        "tool": f"dqpaint {__version__}",
        "files": [_file(result) for result in results if result.drawing is not None],
        "diagnostics": [_as_json(result, finding) for result, finding in findings]
        + [_unreadable(result) for result in results if result.fault],
        "summary": {
            "errors": sum(result.errors for result in results),
            "warnings": sum(result.warnings for result in results),
            "samples": sum(drawing.samples for drawing in surveyed),
            "seconds": sum(drawing.seconds for drawing in surveyed),
        },
    }


def annotations(results: Sequence[CheckResult]) -> list[Annotation]:
    """The findings of several drawings, for GitHub and code scanners."""
    found = []
    for result in results:
        for one in result.diagnostics:
            places: list[tuple[int, int] | None] = [None, None]
            file = result.file
            if one.span is not None:
                file = file_at(result.source, one.span.start, result.file)[1]
                at = (locate(result.source, offset) for offset in (one.span.start, one.span.end))
                places = [(place.line, place.column) for place in at]
            severity: Literal["error", "warning"] = one.severity.value
            found.append(Annotation(file, severity, one.code, one.message, one.help, *places))
        if result.fault:
            found.append(Annotation(result.file, "error", UNREADABLE, result.fault))
    return found


def _as_json(result: CheckResult, finding: Diagnostic) -> dict[str, Any]:
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
        "url": url(finding.code),
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


def _file(result: CheckResult) -> dict[str, Any]:
    drawing = result.drawing
    assert drawing is not None
    return {
        "file": result.file,
        "samples": drawing.samples,
        "seconds": drawing.seconds,
        "length_m": drawing.length,
        "ends_over_middle": drawing.unevenness,
        "box_m": drawing.box.tolist(),
        "dark_saved_m": drawing.program.dark_saved,
        "forecast": result.forecast.as_json if result.forecast else None,
    }


def _unreadable(result: CheckResult) -> dict[str, Any]:
    empty = Diagnostic(UNREADABLE, result.fault, None)
    return _as_json(result, empty)


def _range(text: str, span: Span | None) -> dict[str, Any]:
    if span is None:
        return {"start": None, "end": None}
    ends = (locate(text, offset) for offset in (span.start, span.end))
    return dict(zip(("start", "end"), (at._asdict() for at in ends), strict=True))

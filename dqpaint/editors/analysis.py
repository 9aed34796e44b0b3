"""Text -> its diagnostics, and the length and duration of each line."""

from dataclasses import dataclass, field
from pathlib import Path

import numpy as np

from dqpaint.language import Diagnostic, ScriptError, parse
from dqpaint.motion import Motion, plan
from dqpaint.robots.loading import card_for


@dataclass(frozen=True)
class LineFigures:
    """Length, time and speed of one line of a drawing, all its passes together."""

    length: float  # [m]
    seconds: float
    fastest: float  # [m/s]
    lit: bool

    def __str__(self) -> str:
        dark = "" if self.lit else ", in the dark"
        return (
            f"{self.length * 1e3:.4g} mm in {self.seconds:.4g} s, "
            f"at most {self.fastest * 1e3:.3g} mm/s{dark}"
        )


@dataclass(frozen=True)
class Analysis:
    """The result of analysing a text: diagnostics and figures."""

    text: str
    source: str  # the text, and those of the files it includes
    planned: bool  # whether its times were planned, too
    diagnostics: tuple[Diagnostic, ...]
    figures: dict[int, LineFigures] = field(default_factory=dict)  # by the line, from 1


def analyse(text: str, name: str, planned: bool) -> Analysis:
    """Diagnostics and figures of a text; `planned` includes those of its times."""
    try:
        program = parse(text, name, Path(name))
        if not planned:
            return Analysis(text, program.text, False, program.notes)
        motion = plan(program, card_for(program, None).canvas.pose)
    except ScriptError as problem:
        return Analysis(text, problem.text, planned, problem.diagnostics)
    return Analysis(text, program.text, True, motion.notes, line_figures(motion))


def line_figures(motion: Motion) -> dict[int, LineFigures]:
    """Length and duration of each line; of the main file alone."""
    steps = np.linalg.norm(np.diff(motion.points, axis=0), axis=1)
    steps[motion.jump[:-1]] = 0.0
    rows = motion.source.file[:-1] == 0
    lines, of = np.unique(motion.source.line[:-1][rows], return_inverse=True)
    own = steps[rows]
    length, fastest = np.bincount(of, weights=own), np.zeros(len(lines))
    np.maximum.at(fastest, of, own)
    seconds = np.bincount(of) * motion.period
    lit = np.bincount(of, weights=motion.lit[:-1][rows]) > 0.0
    columns = (length, seconds, fastest / motion.period, lit)
    values = zip(*(column.tolist() for column in columns), strict=True)
    return {line: LineFigures(*each) for line, each in zip(lines.tolist(), values, strict=True)}

"""A drawing that is run again and again -> what each trial taught, and the best learned path.

The correction of the reference after trial j (Bristow, Tharayil and Alleyne, "A survey of iterative
learning control", 2006) is

    a_(j+1)(k) = Q ( a_j(k) - gamma eps_j(k + m) ),    eps_j = 2 log(x_d* x_j),

with Q a low pass that shifts nothing and m the rows by which the arm answers late. Frequency by
frequency, T the closed loop from reference to place, the error falls where |Q (1 - gamma e^(iwmT)
T)| < 1; while the loop follows what is slow, T = 1, to a share 1 - gamma a trial.
"""

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from itertools import pairwise
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from dqpaint import dq
from dqpaint.core import tables
from dqpaint.dq import Floats
from dqpaint.errors import DqpaintError, UsageError
from dqpaint.outputs import files
from dqpaint.settings import Settings
from dqpaint.simulation import encode_learned
from dqpaint.studies.experiment.cells import Cell
from dqpaint.studies.kinds.study_request import StudyRequest
from dqpaint.studies.kinds.study_result import ANY_WIDTH, StudyResult
from dqpaint.studies.report.charts import Line, Panel
from dqpaint.studies.report.page import Block, Charts, Pictured, Rows, Words, files_of
from dqpaint.studies.report.pictures import pictures
from dqpaint.studies.runner.engine import Study, check
from dqpaint.studies.runner.run import Run
from dqpaint.studies.runner.run_arrays import read_arrays

if TYPE_CHECKING:
    from dqpaint.studies.declared.rehearse import Rehearse

LEAST_GAIN = 0.02  # of the error, that a trial has to take off for another one to be worth it
LEAST_ERROR = 2e-6  # m; below it there is nothing to learn
LONGEST_LEAD = 0.5  # s, of the arm's answer
HEADS = ["trial", "rms [mm]", "largest [mm]", "rms [deg]", "of the one before", "predicted", ""]
ABOUT = (
    "Predicted: 1 - gamma, for what is slower than the filter's corner and is followed by the "
    "closed loop. Errors are those of the light to the drawing itself, not to the corrected path."
)


@dataclass(frozen=True)
class Trial:
    """One trial: its errors, and the correction (N, 6) under which it ran."""

    rms: float
    largest: float
    turned: float
    correction: Floats


@dataclass(frozen=True, kw_only=True)
class Rehearsal(StudyResult):
    """A finished rehearsal.

    Attributes:
        trials: in their order.
        gamma: the share of the error that is taken off.
        lead: rows by which the arm answers late.
        why: it ended.
        learned: the correction (N, 6) of the best trial; of recorded runs that for the next one.
        t: times of the rows (N,) [s].
        points: places (N, 3) [mm] of the best corrected path, in the drawing's frame.
    """

    settings: Settings
    trials: tuple[Trial, ...]
    gamma: float
    lead: int
    why: str
    learned: Floats
    t: Floats
    points: Floats

    @property
    def title(self) -> str:
        """The heading of its pages."""
        return f"{self.name}, rehearsed"

    @property
    def best(self) -> int:
        """The trial with the least error."""
        return min(range(len(self.trials)), key=lambda j: self.trials[j].rms)

    @property
    def ratios(self) -> list[float]:
        """The error of each trial by that of the one before."""
        errors = [one.rms for one in self.trials]
        return [b / a if a else math.nan for a, b in pairwise(errors)]

    @property
    def remarks(self) -> list[str]:
        """Why it ended, and how to use what was learned."""
        if not self.learned.any():
            return [f"{self.why}; nothing was learned"]
        return [
            f"{self.why}; the best is trial {self.best}: --learned {self.stem}-learned.csv follows "
            f"it, with draw and export; {self.stem}-path.csv is its line for path"
        ]

    def rows(self) -> list[list[str]]:
        """The table."""
        of_before = ["", *(f"{ratio:.3f}" for ratio in self.ratios)]
        return [HEADS, *(
            [
                str(j), f"{1e3 * one.rms:.4g}", f"{1e3 * one.largest:.4g}",
                f"{math.degrees(one.turned):.3g}", of_before[j],
                f"{1 - self.gamma:.3f}" if j else "", "best" if j == self.best else "",
            ]
            for j, one in enumerate(self.trials)
        )]  # fmt: skip

    def table_text(self, width: int = ANY_WIDTH) -> str:
        """The table, for a terminal."""
        return "\n".join([*tables.fit(self.rows(), width), "", ABOUT, *self.hidden])

    def shown(self) -> Mapping[str, Pictured]:
        """The contact sheet at one exposure, and the error by trial beside the prediction."""
        x = np.arange(len(self.trials), dtype=np.float64)
        errors = 1e3 * np.array([one.rms for one in self.trials])
        lines = [Line(x, errors, "error")]
        if self.gamma < 1:
            lines.append(Line(x, errors[0] * (1 - self.gamma) ** x, "predicted"))
        log = bool(errors.all())
        panel = Panel("Error by trial", "trial", "position error, rms [mm]", lines, log_y=log)
        return {
            **pictures(self.cells, self.folder, self.settings),
            "-trials": Charts("Error by trial", [panel]),
        }

    def files_and_blocks(self) -> tuple[dict[str, bytes], list[Block]]:
        """Pictures, table and the learned path by the ends of their names; parts of the page."""
        shown, rows = self.shown(), self.rows()
        made = {
            **files_of(shown, self.formats),
            "-learned.csv": encode_learned(self.t, self.learned),
            "-path.csv": tables.encode_csv(self.points.tolist()),
            "-table.csv": tables.encode_csv([HEADS[:-1], *(row[:-1] for row in rows[1:])]),
            "-table.md": tables.page(self.title, tables.markdown(rows), ABOUT, *self.hidden_block),
        }
        words = Words("\n".join([ABOUT, *self.remarks, *self.hidden]))
        return made, [Rows("Trials", rows), words, *shown.values()]


def rehearse(request: StudyRequest, asked: "Rehearse") -> Rehearsal:
    """Run, learn, run again; stop at the best.

    Raises:
        UsageError: a learned path is given, or the filter's corner does not go with the period.
        DqpaintError: a fault in the drawing, the choices or the folder.
    """
    name, text = request.drawing
    base = request.settings(size="640x360")
    if base.learned:
        raise UsageError("rehearse learns by itself: leave out --learned")
    recorded = [one.strip() for one in (asked.recordings or "").split(",") if one.strip()]
    count = len(recorded) or asked.trials
    runs = _Runs(request, Run(name, text, base, ("errors", "light", "trial")), recorded)
    check([runs.next(0, None, None)])
    trials: list[Trial] = []
    found: list[Cell] = []
    lead, learned, why = asked.lead, None, "all trials were done"
    arrays: Mapping[str, Floats] = {}
    with Study(request.folder, request.jobs, request.study, count, request.reporter) as study:
        for j in range(count):
            run = runs.next(j, arrays.get("t_s"), learned)
            (result,) = study.results([run])
            found.append(Cell({"trial": str(j)}, (result,), (run,)))
            if result.status != "done":
                if not trials:
                    raise DqpaintError(f"the first trial is no result: {result.message}")
                why = f"trial {j} is no result: {result.message.splitlines()[0]}"
                break
            arrays = read_arrays(request.folder, run.key)
            period = float(arrays["period"])
            correction = np.zeros_like(arrays["eps"]) if learned is None else learned
            trials.append(_trial(result.figures, correction))
            if reason := finished([one.rms for one in trials]):
                why = reason
                break
            if lead is None:
                lead = answer_rows(arrays["pose_d"], arrays["pose"], period)
            if recorded or j + 1 < count:
                learned = learn(correction, arrays["eps"], arrays["free"], lead, asked, period)
    best = min(trials, key=lambda one: one.rms).correction
    if recorded and learned is not None and best is trials[-1].correction:
        best = learned  # for the next run of the real arm
    return Rehearsal(
        name=Path(name).name, settings=base, cells=tuple(found), folder=request.folder, text=text,
        trials=tuple(trials), gamma=asked.gamma, lead=lead or 0, why=why, learned=best,
        t=arrays["t_s"], points=1e3 * path_points(arrays, best),
    )  # fmt: skip


@dataclass(frozen=True)
class _Runs:
    """The runs of a rehearsal: simulated ones along learned paths, or recorded ones."""

    request: StudyRequest
    plain: Run
    recorded: Sequence[str]

    def next(self, j: int, t: Floats | None, learned: Floats | None) -> Run:
        """The run of trial j, its learned path written for it."""
        if self.recorded:
            change = {"recorded": self.recorded[j]}
        elif learned is None or t is None:
            return self.plain
        else:
            path = self.request.folder / f"{Path(self.plain.name).stem}-trial-{j}"
            files.write(path, {".csv": encode_learned(t, learned)})
            change = {"learned": f"{path}.csv"}
        return replace(self.plain, settings=self.plain.settings.model_copy(update=change))


def _trial(figures: Mapping[str, float], correction: Floats) -> Trial:
    return Trial(
        figures["position_error_rms_m"], figures["position_error_max_m"],
        figures["orientation_error_rms_rad"], correction,
    )  # fmt: skip


def finished(errors: Sequence[float]) -> str:
    """Why a trial with these errors [m] is the last one; empty where another is worth it."""
    j = len(errors) - 1
    if errors[j] < LEAST_ERROR:
        more = "more " if j else ""
        return f"the error is below {1e6 * LEAST_ERROR:g} um: there is nothing {more}to learn"
    if j and errors[j] > errors[j - 1]:
        return f"trial {j} is worse than trial {j - 1}"
    if j and errors[j] > (1 - LEAST_GAIN) * errors[j - 1]:
        return f"trial {j} is better by less than {100 * LEAST_GAIN:g} %"
    return ""


def learn(
    a: Floats, eps: Floats, free: Floats, lead: int, asked: "Rehearse", period: float
) -> Floats:
    """The correction (N, 6) after a trial.

    Args:
        a: the correction of the trial (N, 6).
        eps: its errors (N, 6).
        free: whether no limit clipped a joint (N,): nothing is learned where one did.
        lead: rows by which the arm answers late.
        asked: gamma and the filter's corner.
        period: [s].

    Raises:
        UsageError: the filter does not go with the period or the drawing's length.
    """
    later = np.minimum(np.arange(len(a)) + lead, len(a) - 1)
    wanted = a - asked.gamma * np.where(free[later, None], eps[later], 0.0)
    return low_pass(wanted, asked.cutoff, period) if asked.cutoff else wanted


def low_pass(signal: Floats, cutoff: float, period: float) -> Floats:
    """A Butterworth filter of second order, forward and backward: it shifts nothing."""
    from scipy.signal import butter, sosfiltfilt

    if cutoff >= 0.5 / period:
        raise UsageError(
            f"filter {cutoff:g} Hz is not below {0.5 / period:g} Hz, half the rate of a period of "
            f"{1e3 * period:g} ms"
        )
    sos = butter(2, cutoff, fs=1.0 / period, output="sos")
    pad = min(len(signal) - 1, math.ceil(1.0 / (cutoff * period)))
    return np.asarray(sosfiltfilt(sos, signal, axis=0, padtype="constant", padlen=pad))


def answer_rows(pose_d: Floats, pose: Floats, period: float) -> int:
    """By how many rows the tool comes after its reference: the best match of their velocities."""
    asked, found = (np.diff(one, axis=0) for one in (pose_d, pose))
    most = min(len(asked) // 2, round(LONGEST_LEAD / period))
    fits = [float((asked[: len(asked) - m] * found[m:]).sum()) for m in range(most + 1)]
    return int(np.argmax(fits))


def path_points(arrays: Mapping[str, Floats], a: Floats) -> Floats:
    """The places (N, 3) [m] of the corrected path in the drawing's own frame."""
    home = dq.conj(arrays["canvas"])
    return dq.translation(dq.mul(home, dq.mul(arrays["pose_d"], dq.exp(0.5 * a))))

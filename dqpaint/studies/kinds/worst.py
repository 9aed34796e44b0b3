"""Laws and plants -> the disturbance of given size that each answers worst, beside its promise.

On the ideal arm the disturbance that was found in the loop of the law alone (`worst_loop`) is run
once. On another plant the search goes on there, by runs: the error of a run, reversed in time, is
the next disturbance. Two such steps are the power iteration of the largest singular value of a
linear loop that is symmetric (Wahlberg and others, "On identification and the H-infinity norm",
2010); the worst of all is kept.
"""

import math
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from dqpaint import dq
from dqpaint.controllers import find_controller
from dqpaint.core import short_name, tables
from dqpaint.dq import Floats
from dqpaint.errors import DqpaintError, UnstableError, UsageError
from dqpaint.metrics import Attenuation, attenuation
from dqpaint.outputs import files
from dqpaint.painting import paint
from dqpaint.settings import DEFAULT_CONTROLLER, Settings
from dqpaint.simulation import Track
from dqpaint.studies.experiment.axes import parse_texts, with_choice
from dqpaint.studies.kinds.study_request import StudyRequest
from dqpaint.studies.kinds.study_result import ANY_WIDTH, StudyResult
from dqpaint.studies.kinds.worst_loop import HALVES, Loop, Part, search
from dqpaint.studies.report.charts import Line, Panel
from dqpaint.studies.report.page import Block, Charts, Pictured, Rows, Words, files_of
from dqpaint.studies.runner.run import Run

if TYPE_CHECKING:
    from dqpaint.studies.declared.worst import WorstStudy

COLUMNS = ("wx_rad_s", "wy_rad_s", "wz_rad_s", "vx_m_s", "vy_m_s", "vz_m_s")
UNITS: dict[Part, str] = {"translation": "m/s", "rotation": "rad/s"}
SIZES: dict[Part, float] = {"translation": 0.01, "rotation": 0.1}


@dataclass(frozen=True)
class Case:
    """The worst that was found of a law on a plant.

    Attributes:
        law: as it was written, with its gains.
        plant: likewise.
        part: of the error.
        size: rms of the disturbance [m/s] or [rad/s].
        in_loop: the ratio of error to disturbance in the loop of the law alone [s].
        on_arm: the same of the run on the arm, with the promises.
        undisturbed: the norm of the error that is there without any disturbance, over the norm of
            this one [s].
        clipped: whether limits clipped commands there.
        table: the disturbance as a CSV has it.
        error: size of the error at each row (N,) [m], or [rad] / 2.
    """

    law: str
    plant: str
    part: Part
    size: float
    in_loop: float
    on_arm: Attenuation
    undisturbed: float
    clipped: bool
    table: dict[str, Floats]
    error: Floats

    @property
    def label(self) -> str:
        """The law and the plant."""
        return f"{self.law}, {self.plant}"

    @property
    def end(self) -> str:
        """The end of its file's name."""
        words = (short_name(self.law), self.plant, self.part)
        plain = "-".join("".join(c if c.isalnum() else "-" for c in word) for word in words)
        return f"-worst-{plain}.csv"

    @property
    def numbers(self) -> list[object]:
        """Its row of the CSV, SI units."""
        one = self.on_arm
        return [
            self.law, self.plant, self.part, self.size, one.ratio, one.bound, self.in_loop,
            one.in_steps, self.undisturbed, int(self.clipped),
        ]  # fmt: skip

    @property
    def row(self) -> list[str]:
        """Its row of the table."""
        promise, steps = self.on_arm.bound, self.on_arm.in_steps

        def of_promise(ratio: float | None) -> str:
            return f"{ratio / promise:.3f}" if promise and ratio is not None else ""

        return [
            self.law, self.plant, self.part, f"{self.size:.4g} {UNITS[self.part]}",
            f"{self.on_arm.ratio:.4g}", f"{promise:.4g}" if promise else "none",
            of_promise(self.on_arm.ratio), of_promise(self.in_loop), of_promise(steps),
            of_promise(self.undisturbed),
            "clipped" if self.clipped else "",
        ]  # fmt: skip


NUMBERS = [
    "law", "plant", "error", "size", "ratio_s", "promise_s", "in_loop_s", "in_steps_s",
    "undisturbed_s", "clipped",
]  # fmt: skip
HEADS = [
    "law", "plant", "error", "size, rms", "worst found [s]", "promise [s]", "of the promise",
    "in the loop alone", "bound in steps", "undisturbed", "limits",
]  # fmt: skip
ABOUT = (
    "Worst found: norm of the error over the norm of the disturbance, on the arm. In the loop "
    "alone: what the search began with, where the tool carries out its twist without an arm, as a "
    "part of the promise. Bound in steps: what holds there with the period and the turns of the "
    "run, likewise; joints that hold their rates carry the tool along a curve instead, so that an "
    "arm that turns much in a step can exceed it. Undisturbed: the error that is there without any "
    "disturbance, by the same norm, as where the reference changes its twist within a period; no "
    "promise is about that part. A search finds a lower limit of the worst there "
    "is."
)


@dataclass(frozen=True, kw_only=True)
class Worst(StudyResult):
    """A finished search."""

    settings: Settings
    cases: tuple[Case, ...]

    @property
    def title(self) -> str:
        """The heading of its pages."""
        return f"{self.name}, the worst disturbances"

    @property
    def remarks(self) -> list[str]:
        """How to run the worst again."""
        return [
            f"{self.stem}{case.end} is taken by --disturb twist={self.stem}{case.end}, with "
            f"--plant {case.plant} and the gains of {case.law}"
            for case in self.cases[:1]
        ]

    def rows(self) -> list[list[str]]:
        """The table."""
        return [HEADS, *(case.row for case in self.cases)]

    def table_text(self, width: int = ANY_WIDTH) -> str:
        """The table, for a terminal."""
        return "\n".join([*tables.fit(self.rows(), width), "", ABOUT])

    def shown(self) -> Mapping[str, Pictured]:
        """The disturbances and errors over time, both parts by themselves."""
        panels = []
        for part, half in HALVES.items():
            mine = [case for case in self.cases if case.part == part]
            if not mine:
                continue
            names = COLUMNS[half]
            sizes = [np.sqrt(sum(case.table[n] ** 2 for n in names)) for case in mine]
            times = [case.table["t_s"] for case in mine]
            unit = "p_e [m]" if part == "translation" else "1 - r_e"
            panels += [
                Panel(f"{part}: disturbance", "time [s]", f"size [{UNITS[part]}]", [
                    Line(t, v, case.label) for t, v, case in zip(times, sizes, mine, strict=True)
                ]),
                Panel(f"{part}: error on the arm", "time [s]", f"size of {unit}", [
                    Line(t, case.error, case.label) for t, case in zip(times, mine, strict=True)
                ]),
            ]  # fmt: skip
        return {"-worst": Charts("The worst that was found, over time", panels, shared=True)}

    def files_and_blocks(self) -> tuple[dict[str, bytes], list[Block]]:
        """Charts, tables and the disturbances by the ends of their names, and the page's parts."""
        shown = self.shown()
        text = f"# {self.title}\n\n{tables.markdown(self.rows())}\n\n{ABOUT}\n"
        made = {
            **files_of(shown),
            **{case.end: _csv(case.table) for case in self.cases},
            "-table.csv": tables.encode_csv([NUMBERS, *(case.numbers for case in self.cases)]),
            "-table.md": text.encode(),
        }
        return made, [Rows("The worst that was found", self.rows()), Words(ABOUT), *shown.values()]


def seek(request: StudyRequest, asked: "WorstStudy") -> Worst:
    """Seek the worst disturbance of every law on every plant.

    Raises:
        UsageError: a law that does not command twists, or takes one arm at a time.
        DqpaintError: a fault in the drawing, the choices or the folder.
    """
    name, text = request.drawing
    base = request.settings()
    if base.disturb or base.recorded:
        raise UsageError("worst seeks the disturbance itself: leave out --disturb and --recorded")
    laws = parse_texts("controller", asked.controllers or DEFAULT_CONTROLLER)
    plants = parse_texts("plant", asked.plants or "ideal")
    parts: list[Part] = ["translation", "rotation"]
    if asked.error != "both":
        parts = [asked.error]
    chosen = [(law, plant, part) for law in laws for plant in plants for part in parts]
    for law in laws:
        _check_law(with_choice(base, {"controller": law}).controller)
    request.reporter.begin("worst")
    cases = []
    try:
        for i, (law, plant, part) in enumerate(chosen):
            settings = with_choice(base, {"controller": law, "plant": plant})
            run = Run(name, text, settings)
            run.check()
            hunt = _Hunt(run, request.folder, f"{Path(name).stem}-trial.csv")
            cases.append(_worst_of(hunt, asked, law, plant, part))
            request.reporter.show((i + 1) / len(chosen))
    finally:
        request.reporter.end()
    return Worst(
        name=Path(name).name, cells=(), folder=request.folder, settings=base, text=text,
        cases=tuple(cases),
    )  # fmt: skip


def _csv(table: dict[str, Floats]) -> bytes:
    return tables.encode_csv(
        [list(table), *zip(*(c.tolist() for c in table.values()), strict=True)]
    )


def _check_law(name: str) -> None:
    law = find_controller(name)
    if law.commands != "twist" or not law.batched:
        does = "takes one arm at a time" if law.commands == "twist" else f"commands {law.commands}"
        raise UsageError(f"worst needs a law without state that commands twists; '{name}' {does}")


class _Hunt:
    """The runs of one law on one plant, with a disturbance each."""

    def __init__(self, run: Run, folder: Path, trial: str) -> None:
        self._run, self._file = run, folder / trial
        self.ready = paint.prepare(run.program(), run.settings)
        self.motion = self.ready.motion
        self.bounds = self.ready.choices.gains.disturbance_bounds()
        self.seed = run.settings.seed
        self.answer: Floats = np.zeros((0, 3))

    def loop(self) -> Loop:
        """The loop of the law alone."""
        chosen = self.ready.choices
        return Loop(chosen.controller, chosen.gains, self.ready.kinematics, self.motion)

    def track(self, table: dict[str, Floats]) -> Track:
        """A run with a disturbance, read from a file as any is; DqpaintError."""
        files.write(self._file.with_suffix(""), {".csv": _csv(table)})
        try:
            given = {"twist": {"file": str(self._file)}}
            settings = self._run.settings.model_copy(update={"disturb": given})
            return paint.prepare(self._run.program(), settings).run()
        finally:
            self._file.unlink(missing_ok=True)

    def table(self, v: Floats, points: Floats) -> dict[str, Floats]:
        """The CSV of spatial twists (N - 1, 6) of a tool that is at `points` (N - 1, 3) then."""
        rows = np.concatenate([v[:, :3], dq.point_velocity(v, points)], axis=1)
        rows = np.concatenate([rows, np.zeros((1, 6))])
        return {"t_s": self.motion.t, **dict(zip(COLUMNS, rows.T, strict=True))}

    def through(self, run: Track, part: Part) -> Attenuation:
        """What came through to a part of the error."""
        gains = self.ready.choices.gains
        return attenuation(run, self.bounds, gains.bounded_in_steps, point=gains.first.error_point)[
            part
        ]


def _worst_of(hunt: _Hunt, asked: "WorstStudy", law: str, plant: str, part: Part) -> Case:
    """The worst of one law on one plant, of all sizes that are tried."""
    loop, rows = hunt.loop(), len(hunt.motion.t) - 1
    if rows < 2:
        raise DqpaintError("the drawing has less than three samples: it leaves nothing to disturb")
    found = None
    for size in _sizes(asked, part, hunt.bounds):
        one = search(loop, part, rows, size, asked.turn, asked.rounds, hunt.seed)
        if found is None or one.ratio > found[1].ratio:
            found = size, one
    assert found is not None
    size, one = found
    best: tuple[Attenuation, Track, dict[str, Floats]] | None = None
    for table in _candidates(hunt, loop, part, one.v, one.pose, size, asked, plant):
        try:
            run = hunt.track(table)
        except UnstableError:
            continue
        came = hunt.through(run, part)
        hunt.answer = loop.error(run.pose, part)
        if best is None or came.ratio > best[0].ratio:
            best = came, run, table
    if best is None:
        raise UnstableError(f"{law} on {plant}: every run diverged")
    came, run, table = best
    error = np.linalg.norm(loop.error(run.pose, part), axis=1)
    plain = float(loop.energy(loop.run(np.zeros((rows, 6))), part))
    cause = size * math.sqrt(rows)
    return Case(
        law, plant, part, size, one.ratio, came, math.sqrt(plain) / cause, bool(run.clamps), table,
        error,
    )  # fmt: skip


def _sizes(asked: "WorstStudy", part: Part, bounds: tuple[float, float] | None) -> list[float]:
    """The sizes to try: the bound of rotation is reached as a disturbance of K_O holds it off."""
    if asked.size is not None:
        return [asked.size]
    if part == "rotation" and bounds:
        return [SIZES[part], math.sqrt(2) / bounds[0]]
    return [SIZES[part]]


def _candidates(
    hunt: _Hunt,
    loop: Loop,
    part: Part,
    v: Floats,
    pose: Floats,
    size: float,
    asked: "WorstStudy",
    plant: str,
) -> Iterator[dict[str, Floats]]:
    """Disturbances to run; after each, `hunt.answer` is the error (N, 3) of its run."""
    points = dq.translation(pose[:-1])
    yield hunt.table(v, points)
    half = HALVES[part]
    for _ in range(asked.trials - 1 if plant != "ideal" else 0):
        back = hunt.answer[:0:-1]
        rms = math.sqrt(float((back**2).sum()) / len(back))
        if not rms:
            return
        v = np.zeros_like(v)
        v[:, half] = size * back / rms
        yield hunt.table(v, points)

"""Laws and periods -> the times between control steps, measured in real time."""

import time
from collections.abc import Mapping
from typing import Any

import numpy as np

from dqpaint.controllers import find_controller
from dqpaint.dq import Floats
from dqpaint.language import parse
from dqpaint.planning import prepared_motion
from dqpaint.plants import Ideal, PlantMaker
from dqpaint.robots.kinematics import Kinematics
from dqpaint.robots.loading import card_for
from dqpaint.robots.model import DEFAULT_ROBOT, Card
from dqpaint.simulation import track
from dqpaint.studies.experiment.statistics import spread
from dqpaint.studies.replay.measure import MEASURES, MeasureRequest, MeasureResult
from dqpaint.studies.replay.papers import Cell, Paper
from dqpaint.studies.report.charts import Line, Panel
from dqpaint.studies.report.page import Charts

SECONDS = 2.0  # of each loop
BINS = 60
SHOWN_MS = 2.0  # either side of the asked period, in the histogram; what is beyond is at its ends


class Clock:
    """Ticks at a fixed rate, as ros::Rate: a tick that was missed shifts the later ones."""

    def __init__(self, period: float) -> None:
        self._period = period
        self.woke: list[float] = []
        self.computed: list[float] = []

    def wait(self) -> None:
        """Until the next tick."""
        now = time.perf_counter()
        if not self.woke:
            self.woke.append(now)
            self._next = now + self._period
            return
        self.computed.append(now - self.woke[-1])
        if now > self._next + self._period:
            self._next = now
        while (left := self._next - time.perf_counter()) > 0:
            time.sleep(left)
        self.woke.append(time.perf_counter())
        self._next += self._period


def paced(clock: Clock) -> PlantMaker:
    """An ideal arm that takes each command at a tick of the clock."""

    class Paced(Ideal):
        def run(self, command: Floats, drift: Floats | None = None) -> None:
            clock.wait()
            super().run(command, drift)

    return Paced


@MEASURES.add("timing")
def timing(paper: Paper, request: MeasureRequest) -> MeasureResult:
    """Each law for a while at each period, in real time."""
    request.nothing_but(paper, "robot")
    clocks = {}
    request.reporter.begin(paper.name)
    for i, cell in enumerate(paper.cells):
        clocks[cell.name] = loop(cell, request.settings)
        request.reporter.show((i + 1) / len(paper.cells))
    request.reporter.end()
    numbers = {
        name: {"period_s": spread(np.diff(clock.woke).tolist()),
               "computing_s": spread(clock.computed)}
        for name, clock in clocks.items()
    }  # fmt: skip
    robot = request.settings.get("robot") or DEFAULT_ROBOT
    ours = f"Python and NumPy, an ideal {robot}, {SECONDS:g} s each"
    return MeasureResult(numbers, ours, shown={"-histogram": histogram(clocks)})


def period_of(cell: Cell) -> float:
    """The asked period [s], which a cell's name ends with."""
    return float(cell.name.split(",")[-1].removesuffix("ms")) * 1e-3


def loop(cell: Cell, settings: Mapping[str, Any]) -> Clock:
    """One law along an arc, in real time."""
    period = period_of(cell)
    steps = max(8, round(SECONDS / period))
    text = (
        f"period {period * 1e3:g} ms\nstart at (0, 70, 0) mm\n"
        f"arc centre (0, 0) mm axis -z angle 90 deg samples {steps} profile constant\n"
    )
    program = parse(text, "arc")
    card: Card = card_for(program, settings.get("robot"), None)
    kinematics = Kinematics(card)
    ready = prepared_motion.prepare_motion(program, kinematics)
    law = find_controller(cell.settings["controller"])
    clock = Clock(period)
    track(ready.motion, kinematics, ready.start, paced(clock), law, law.read_gains({}))
    return clock


def histogram(clocks: Mapping[str, Clock]) -> Charts:
    """How often which time lay between two steps, a panel a period, a line a law."""
    panels = []
    for ending in dict.fromkeys(name.split(",")[-1].strip() for name in clocks):
        asked = float(ending.removesuffix("ms"))
        edges = np.linspace(asked - SHOWN_MS, asked + SHOWN_MS, BINS + 1)
        lines = []
        for name, clock in clocks.items():
            if name.endswith(f" {ending}"):
                times = np.clip(1e3 * np.diff(clock.woke), edges[0], edges[-1])
                part = np.histogram(times, edges)[0] / len(times)
                lines.append(Line(0.5 * (edges[1:] + edges[:-1]), part, name.split(",")[0]))
        panels.append(
            Panel(
                f"asked for every {ending}",
                "time between steps [ms]",
                "part of the steps [-]",
                lines,
            )
        )
    return Charts("The times between two steps", panels)

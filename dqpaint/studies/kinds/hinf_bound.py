"""A sine disturbance of each frequency -> its measured error as a part of the H-infinity bound.

Pereira 2016, 3.3 promises ||p_e||_2 <= ||v_t||_2 / K_T and ||1 - r_e||_2 <= sqrt(2) ||v_w||_2 / K_O
in continuous time. In steps of T the ideal arm that does not turn is
e(k+1) = (1 - K T) e(k) + T v(k): its gain is largest at frequency 0 while K T <= 1, and at half the
sampling rate beyond, where it exceeds 1 / K. What holds where it turns, too:
`dqpaint.metrics.attenuation`.
"""

from dataclasses import dataclass
from functools import partial

import numpy as np

from dqpaint.controllers import CONTROLLERS
from dqpaint.core import tables
from dqpaint.disturbances import DISTURBANCES
from dqpaint.dq import Floats
from dqpaint.language import parse
from dqpaint.metrics import attenuation
from dqpaint.planning import prepared_motion
from dqpaint.plants import PLANTS
from dqpaint.robots.kinematics import Kinematics
from dqpaint.robots.model import DEFAULT_ROBOT, read_card
from dqpaint.simulation import track
from dqpaint.studies.report.charts import Line, Panel, chart
from dqpaint.studies.report.templates import render

PERIOD = 0.008  # [s]
SECONDS = 20.0
DRAWING = f"period {PERIOD * 1e3:g} ms\nstart at (20, 10, 5) mm\nhold {SECONDS:g} s\n"
PRODUCTS = (0.16, 0.95, 1.312)  # K_T times T: the default, just within, and beyond the promise
HERTZ: Floats = np.append(np.geomspace(0.05, 50, 19), [55.0, 59.0, 61.5, 62.4])
SMALL = {"translation": ("y", 1e-4), "rotation": ("wx", 1e-3)}  # m/s, rad/s


@dataclass(frozen=True)
class Curve:
    """How much of a sine came through at each frequency, as a part of the bound.

    Attributes:
        part: translation or rotation.
        gain: K_T or K_O [1/s].
        hertz: frequencies (M,) [Hz].
        of_bound: error over disturbance, over what the gain promises (M,).
    """

    part: str
    gain: float
    hertz: Floats
    of_bound: Floats


def curves(hertz: Floats = HERTZ, products: tuple[float, ...] = PRODUCTS) -> list[Curve]:
    """Measured curves of `hinf` on the ideal arm, for some products of gain and period.

    In rotation the loop's rate is K_O / 2, so K_O = 2 K_T makes both loops equally fast.
    """
    kinematics = Kinematics(read_card(DEFAULT_ROBOT))
    ready = prepared_motion.prepare_motion(parse(DRAWING, "still.traj"), kinematics)
    law = CONTROLLERS["hinf"]
    found = []
    for part, (axis, size) in SMALL.items():
        for product in products:
            rate = product / PERIOD
            schedule = law.read_gains({"gamma_O": 1 / rate, "gamma_T": np.sqrt(2) / rate})
            run = partial(
                track, ready.motion, kinematics, ready.start, PLANTS["ideal"], law, schedule
            )
            ratios = []
            for frequency in hertz:
                values = {"form": "sine", axis: size, "frequency": float(frequency)}
                sine = DISTURBANCES["twist"].model_validate(values)
                one = attenuation(run(disturbances={"twist": sine}), schedule.disturbance_bounds())[
                    part
                ]
                ratios.append(one.ratio / (one.bound or np.nan))
            gain = rate if part == "translation" else 2 * rate
            found.append(Curve(part, gain, hertz, np.array(ratios)))
    return found


def picture(found: list[Curve]) -> bytes:
    """The curves as a PNG file, translation and rotation side by side."""
    panels = [
        Panel(
            title=part,
            x_label="frequency of the disturbance [Hz]",
            y_label="error, as a part of the bound",
            lines=[
                Line(curve.hertz, curve.of_bound, f"gain x period = {curve.gain * PERIOD:.3g}")
                for curve in found
                if curve.part == part
            ],
            bound=1.0,
            limit="the promise",
            log_x=True,
        )
        for part in SMALL
    ]
    return chart(panels)


def table(found: list[Curve]) -> str:
    """The largest of each curve, in Markdown."""
    rows = [["part", "gain", "gain x period", "largest part of the bound", "at", "promise"]]
    for curve in found:
        worst = int(np.argmax(curve.of_bound))
        most = curve.of_bound[worst]
        rows.append(
            [curve.part, f"{curve.gain:.4g} 1/s", f"{curve.gain * PERIOD:.3g}", f"{most:.3f}",
             f"{curve.hertz[worst]:.3g} Hz", "kept" if most <= 1 else "broken"]
        )  # fmt: skip
    return tables.markdown(rows)


def page(found: list[Curve]) -> str:
    """The study in Markdown, beside its picture `promise.png`."""
    return render(
        "promise.md", seconds=f"{SECONDS:g}", period_ms=f"{PERIOD * 1e3:g}", table=table(found)
    )

"""A size and a form, or a file -> the tool's unknown displacement c(t) on the flange.

Pereira 2016, (3.16): x = x_E c, with x_E the pose that the joints give.
"""

from typing import Annotated, ClassVar, Literal

import numpy as np
from pydantic import Field

from dqpaint import dq
from dqpaint.disturbances.disturbance import DISTURBANCES
from dqpaint.disturbances.signals import Number, SixSignals
from dqpaint.dq import Floats


@DISTURBANCES.add("offset")
class ToolOffset(SixSignals):
    """The tool sits elsewhere on the arm, and that changes in time: pose uncertainty c(t).

    Equation:
        x = x_E c
        x_dot = 1/2 (xi + v_c) x, v_c = Ad(x) v, c_dot = 1/2 c v
    Idea:
        The tool is not where the joints say: it is bent, or shakes. A law that measures it treats
        v_c as any other twist, and its second gammas bound what is left; one that does not draws
        the displacement itself.
    Fails:
        With measured=no nothing removes it, and no bound holds.
    Try:
        dqpaint draw lag --plant ideal --disturb offset=sine,x=0.005,frequency=2
    """

    columns: ClassVar[tuple[str, ...]] = ("wx_rad", "wy_rad", "wz_rad", "x_m", "y_m", "z_m")
    beside: ClassVar[tuple[str, ...]] = ("measured",)
    kind: ClassVar[str] = "offset"
    unit: ClassVar[str] = "m"

    form: Literal["constant", "sine", "noise"] = Field(
        "constant", description="constant, sine or noise"
    )
    x: Number = Field(0.0, description="m along the tool's x; a sine's amplitude, a noise's rms")
    y: Number = Field(0.0, description="m along y")
    z: Number = Field(0.0, description="m along z")
    wx: Number = Field(0.0, description="rad about the tool's x, likewise")
    wy: Number = Field(0.0, description="rad about y")
    wz: Number = Field(0.0, description="rad about z")
    frequency: Annotated[float, Field(ge=1e-3, le=1e6, allow_inf_nan=False)] = Field(
        1.0, description="Hz of a sine; the upper edge of a noise's band"
    )
    measured: Literal["yes", "no"] = Field(
        "yes",
        description="whether the law measures the displaced pose, as (3.29) and its bound have "
        "it: yes; or believes the tool where its model has it: no",
    )
    file: str = Field(
        "",
        description="FILE.csv with t_s and some of wx_rad, wy_rad, wz_rad, x_m, y_m, z_m, in "
        "place of the others",
    )

    @property
    def is_measured(self) -> bool:
        """Whether the law measures the displaced pose."""
        return self.measured == "yes"

    def displacement(self, t: Floats, period: float, rng: np.random.Generator) -> Floats:
        """The displacement c (N, 8): to (x, y, z), turned by the rotation vector."""
        found = self.signals(t, period, rng)
        turn = np.concatenate([found[:, :3], np.zeros((len(t), 3))], axis=1)
        return dq.pose_from(found[:, 3:], dq.rotation(dq.exp(0.5 * turn)))

"""A size and a form, or a file -> an unmodelled twist of the tool, as in the H-infinity bound.

Pereira 2016, 3.3: x_dot = 1/2 (xi + v) x with v = [v_w; v_t] of bounded energy.
"""

from typing import Annotated, ClassVar, Literal

import numpy as np
from pydantic import Field

from dqpaint.disturbances.disturbance import DISTURBANCES
from dqpaint.disturbances.signals import Number, SixSignals
from dqpaint.dq import Floats


@DISTURBANCES.add("twist")
class UnmodelledTwist(SixSignals):
    """The tool is carried along: constant, a sine, band-limited noise, or as a file has it.

    Equation:
        x_dot = 1/2 (xi + v) x
        v = [v_w; v_p + t cross v_w]
    Idea:
        The unmodelled twist of the H-infinity laws' theorem: v_w and the velocity v_p of the
        tool are what is given. A law with the rate k leaves v_p / k of a constant one.
    Fails:
        It is a velocity, not a force: on any plant it comes on top of what the joints do.
    Try:
        dqpaint draw lag --plant ideal --disturb twist=sine,x=0.02,frequency=2
    """

    columns: ClassVar[tuple[str, ...]] = (
        "wx_rad_s", "wy_rad_s", "wz_rad_s", "vx_m_s", "vy_m_s", "vz_m_s"
    )  # fmt: skip
    kind: ClassVar[str] = "twist"
    unit: ClassVar[str] = "m/s"

    form: Literal["constant", "sine", "noise"] = Field(
        "constant", description="constant, sine or noise"
    )
    x: Number = Field(0.0, description="m/s along the base's x; a sine's amplitude, a noise's rms")
    y: Number = Field(0.0, description="m/s along y")
    z: Number = Field(0.0, description="m/s along z")
    wx: Number = Field(0.0, description="rad/s about x, likewise")
    wy: Number = Field(0.0, description="rad/s about y")
    wz: Number = Field(0.0, description="rad/s about z")
    frequency: Annotated[float, Field(ge=1e-3, le=1e6, allow_inf_nan=False)] = Field(
        1.0, description="Hz of a sine; the upper edge of a noise's band"
    )
    file: str = Field(
        "",
        description="FILE.csv with t_s and some of wx_rad_s, wy_rad_s, wz_rad_s, vx_m_s, vy_m_s, "
        "vz_m_s, of the tool's own point, in place of the others",
    )

    def twist(self, t: Floats, period: float, rng: np.random.Generator) -> Floats:
        """The velocity (N, 6) of the tool, angular first."""
        return self.signals(t, period, rng)

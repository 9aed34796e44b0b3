"""What a control law is: a function of what it sees, and its gains."""

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Any, Generic, Literal, NamedTuple

import numpy as np

from dqpaint.controllers.base.gain_schedule import GainText, Schedule, read_schedule
from dqpaint.controllers.base.gains import G, list_gains
from dqpaint.core import Folder, Registry
from dqpaint.dq import Floats
from dqpaint.motion import Motion

Commands = Literal["twist", "rates", "acceleration", "torque"]
NOTHING: Floats = np.zeros(0)


class Seen(NamedTuple):
    """What a law sees at one control step; arrays of any leading shape.

    Attributes:
        pose: measured pose (..., 8), its sign arbitrary.
        pose_d: desired pose (..., 8).
        twist_d: desired spatial twist (..., 6) [rad/s, m/s].
        acceleration_d: its plain derivative (..., 6) [rad/s^2, m/s^2].
        jacobian: J_w (..., 6, n), xi = J_w q_dot.
        posture: measured joint angles (..., n) [rad].
        time: since the drawing began [s].
        period: of the control [s].
        rates: measured joint rates (..., n) [rad/s].
        ahead: what the law's own `prepare` worked out for this row; empty without one.
        inertia: H(q) (..., n, n) [kg m^2], for laws that command torques; empty for others.
        bias: C(q, q_dot) q_dot + G(q) and the joints' friction (..., n) [Nm], likewise.
    """

    pose: Floats
    pose_d: Floats
    twist_d: Floats
    acceleration_d: Floats
    jacobian: Floats
    posture: Floats
    time: float
    period: float
    rates: Floats = NOTHING
    ahead: Floats = NOTHING
    inertia: Floats = NOTHING
    bias: Floats = NOTHING

    @property
    def twist(self) -> Floats:
        """Measured spatial twist J_w q_dot (..., 6) [rad/s, m/s]."""
        return np.asarray(np.matvec(self.jacobian, self.rates))


Law = Callable[[Seen, G], Floats]
Prepare = Callable[[Motion, Schedule[G]], Floats]


@dataclass(frozen=True)
class Controller(Generic[G]):
    """A named law.

    Attributes:
        name: as it is chosen.
        source: the paper and its equation.
        gains: the model of its gains.
        law: what is seen and gains -> what is commanded, arrays of any leading shape.
        commands: what the law's answer is: a spatial `twist` (..., 6), joint `rates` (..., n), a
            spatial `acceleration` (..., 6) or joint `torque` (..., n).
        prepare: looks over the whole motion and all gains before the drawing starts; row k of what
            it returns is `seen.ahead` at row k.
        leaves_null: whether joint rates it says have nothing in the null space, so that the
            objective of `--null` is added to them. A twist or an acceleration always leaves it.
    """

    name: str
    source: str
    gains: type[G]
    law: Law[G]
    commands: Commands = "twist"
    prepare: Prepare[G] | None = None
    leaves_null: bool = False

    @property
    def summary(self) -> str:
        """The first sentence of the law's own docstring."""
        return (self.law.__doc__ or "").strip().splitlines()[0].rstrip(".")

    @property
    def drives_torque(self) -> bool:
        """Whether it needs an arm that is told torques."""
        return self.commands in ("acceleration", "torque")

    def read_gains(self, given: Mapping[str, GainText]) -> Schedule[G]:
        """The gains with the given ones replaced, over the drawing.

        Raises:
            UsageError: an unknown name, no value, or one outside its range; lists the law's own.
        """
        return read_schedule(self.gains, given, f"controller '{self.name}'")

    def list_gains(self) -> str:
        """Name, default and unit of every gain, in words."""
        return list_gains(self.gains)


def _from_plugin(name: str, law: Any) -> Controller[Any]:
    """What an entry point brings: a `Controller`, or a law as a user's file has it."""
    if isinstance(law, Controller):
        return law
    from dqpaint.controllers.base.user_controller import make_controller

    return make_controller(law, name)


CONTROLLERS: Registry[Controller[Any]] = Folder(
    "controller", "dqpaint.controllers.laws", "dqpaint.controllers", _from_plugin
)


def controller(
    name: str,
    source: str,
    gains: type[G],
    commands: Commands = "twist",
    prepare: Prepare[G] | None = None,
    leaves_null: bool = False,
) -> Callable[[Law[G]], Law[G]]:
    """A decorator that registers the law below it; arguments as in `Controller`."""

    def record(law: Law[G]) -> Law[G]:
        CONTROLLERS.add(name)(Controller(name, source, gains, law, commands, prepare, leaves_null))
        return law

    return record

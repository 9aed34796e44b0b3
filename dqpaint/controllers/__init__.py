"""Measured state and reference -> a command: control laws, one a file, with its equation.

A law is called at every control step with a `Seen` (measured state, reference, limits, the
reference ahead) and its gains. It returns a spatial twist (..., 6), which
`dqpaint.simulation.drives` turns into joint rates; or, where it says so, joint rates, a spatial
acceleration or joint torques. Below `@controller(name, source, gains)` in a file of `laws` it is
found by itself.

A law without state is a function, for arrays of any leading shape:

    @controller("p", source="...", gains=RateGains)
    def p(seen, gains): return ...

A law with state (an integrator, an observer), or one that computes something beforehand (a Riccati
equation, a solver over the arm's limits and distances), is a class. Each run makes an object of its
own and calls `start`, if there is one, with the `Arm`, the whole `Motion` and the `Schedule` of the
gains, before the first step:

    @controller("pi", source="...", gains=PIGains)
    class PI:
        def start(self, arm, motion, gains): self.sum = np.zeros(6)
        def __call__(self, seen, gains): self.sum += ...; return ...

Functions go in batches of many arms at once; a class says `batched = True` if it can. A user's own
law, in a file or from Python, is a function or class, too: see `base.user_controller`.
"""

from dqpaint.controllers.base.arm import Arm, JointLimits
from dqpaint.controllers.base.controller import CONTROLLERS, Controller, Law, controller
from dqpaint.controllers.base.gain_schedule import Schedule
from dqpaint.controllers.base.gains import Gains
from dqpaint.controllers.base.seen import Seen, Window
from dqpaint.controllers.base.signs import read_sign
from dqpaint.controllers.base.user_controller import (
    commands, find_controller, make_controller,
)

__all__ = [
    "CONTROLLERS", "Arm", "Controller", "Gains", "JointLimits", "Law", "Schedule", "Seen", "Window",
    "commands", "controller", "find_controller", "make_controller", "read_sign",
]

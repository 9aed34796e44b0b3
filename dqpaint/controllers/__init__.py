"""Control laws, one a file, its equation on top: what is seen -> what is commanded.

A new law is a function in a new file of `laws` under `@controller(name, source, gains)`; it is
found by itself. It sees a `Seen` and its gains, arrays of any leading shape, and returns a spatial
twist (..., 6), which `dqpaint.simulation.drives` turns into joint rates; or, where it says so,
joint rates, an acceleration or torques. A law that wants to know the whole drawing beforehand
brings `prepare`.
"""

from dqpaint.controllers.base.controller import CONTROLLERS, Controller, Seen
from dqpaint.controllers.base.gain_schedule import Schedule
from dqpaint.controllers.base.gains import Gains
from dqpaint.controllers.base.user_controller import commands, find_controller

__all__ = ["CONTROLLERS", "Controller", "Gains", "Schedule", "Seen", "commands", "find_controller"]

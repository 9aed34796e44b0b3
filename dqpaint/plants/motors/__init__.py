"""Commands and a link's motion -> the torque of geared motors on their joints, whatever moves it.

Nothing here knows a physics engine: angles and rates of the joints come in, torques go out.
"""

from dqpaint.plants.motors.commands import CommandFilter, MinimumJerk, Slew
from dqpaint.plants.motors.gears import GearedMotors, Gears
from dqpaint.plants.motors.loops import Cascade, Loop, ThetaGC
from dqpaint.plants.motors.servo_motors import ServoMotors

__all__ = [
    "Cascade", "CommandFilter", "GearedMotors", "Gears", "Loop", "MinimumJerk", "ServoMotors",
    "Slew", "ThetaGC",
]

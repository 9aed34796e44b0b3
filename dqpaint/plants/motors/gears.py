"""A motor's torque and a joint's motion -> what passes through its gear: rotor, friction, backlash.

    rotor   B omega_dot = tau_motor + ripple(theta) - viscous omega - friction - tau
    gear    tau = k wound + d (omega - q_dot), wound = theta - q beyond half the backlash

All is taken at the joint's side of the gear: theta = rotor angle / N, B = N^2 J.
"""

from dataclasses import dataclass

import numpy as np

from dqpaint.dq import Floats


@dataclass(frozen=True)
class Gears:
    """Geared motors, one number (n,) a joint, at the joint's side of the gear.

    Attributes:
        inertia: B = N^2 J of the rotor [kg m^2].
        viscous: friction by rate [Nm s/rad].
        friction: Coulomb friction [Nm].
        stiction: what must be overcome at rest, as a multiple of it, from 1.
        stiffness: of the gear [Nm/rad].
        damping: of the gear [Nm s/rad].
        backlash: the whole gap [rad].
        ripple: amplitude of the torque's ripple [Nm].
        cycles: of the ripple in a turn of the joint.
    """

    inertia: Floats
    viscous: Floats
    friction: Floats
    stiction: Floats
    stiffness: Floats
    damping: Floats
    backlash: Floats
    ripple: Floats
    cycles: Floats

    def wound(self, apart: Floats) -> Floats:
        """How far the gear is wound (n,) [rad] by angles (n,) between motor and joint."""
        gap = 0.5 * self.backlash
        return apart - np.minimum(np.maximum(apart, -gap), gap)

    def angle_for(self, torque: Floats) -> Floats:
        """The angle (n,) [rad] between motor and joint at rest under torques (n,) [Nm]."""
        return torque / self.stiffness + 0.5 * self.backlash * np.sign(torque)


class GearedMotors:
    """Rotors at rest, with gears that carry a torque.

    A step is of second order, its positions half a step ahead of its rates (leapfrog). Friction is
    a projection: a rotor that friction can stop within a step stands still, and one that stands
    still moves only if it is pushed by more than its static friction. So it neither chatters nor
    creeps. In its gap a gear carries nothing; its damper pushes and never pulls.

    Attributes:
        angle: of the motors (n,) [rad].
        rate: of the motors (n,) [rad/s].
        torque: of the gears on the joints (n,) [Nm], in the middle of the last step.
    """

    def __init__(self, gears: Gears, joint: Floats, torque: Floats) -> None:
        self.gears = gears
        self.angle = joint + gears.angle_for(torque)
        self.rate = np.zeros_like(joint)
        self.torque = torque.copy()
        self._before = np.zeros_like(joint)  # rate a step ago
        self._breakaway = gears.friction * gears.stiction
        self._has_backlash = bool(gears.backlash.any())
        self._has_ripple = bool(gears.ripple.any())

    def middle(self, step: float) -> tuple[Floats, Floats]:
        """Angles and rates (n,) in the middle of a step [s] that begins."""
        return self.angle + 0.5 * step * self.rate, 1.5 * self.rate - 0.5 * self._before

    def carry(self, middle: tuple[Floats, Floats], joint: Floats, joint_rate: Floats) -> Floats:
        """The torque of the gears on the joints (n,) [Nm] in the middle of a step.

        Args:
            middle: what `middle` gave.
            joint: angles (n,) [rad] in the middle of the step.
            joint_rate: rates (n,) [rad/s] there.
        """
        angle, rate = middle
        self.torque = self._through(angle - joint, rate - joint_rate)
        return self.torque

    def move(self, step: float, middle: tuple[Floats, Floats], motor_torque: Floats) -> None:
        """Make a step [s] under motor torques (n,) [Nm] and what the gears carry."""
        one, angle = self.gears, middle[0]
        net = motor_torque - self.torque
        if self._has_ripple:
            net = net + one.ripple * np.sin(one.cycles * angle)
        by_step = one.inertia / step
        pushed = (by_step - 0.5 * one.viscous) * self.rate + net
        held = np.where(self.rate == 0, self._breakaway, one.friction)
        size = np.abs(pushed)
        moving = np.sign(pushed) * (size - one.friction) / (by_step + 0.5 * one.viscous)
        self._before = self.rate
        self.rate = np.where(size > held, moving, 0.0)
        self.angle = angle + 0.5 * step * self.rate

    def _through(self, apart: Floats, rate: Floats) -> Floats:
        one = self.gears
        if not self._has_backlash:
            return one.stiffness * apart + one.damping * rate
        wound = one.wound(apart)
        side = np.sign(wound)
        pressed = side * (one.stiffness * wound + one.damping * rate)
        return side * np.maximum(pressed, 0.0)

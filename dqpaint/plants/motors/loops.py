"""A reference and what the sensors of a servo see -> the torque that its motors are asked for."""

from typing import NamedTuple, Protocol

import numpy as np

from dqpaint.dq import Floats


class State(NamedTuple):
    """What a loop sees in the middle of a step, each (n,).

    Attributes:
        reference: [rad].
        reference_rate: [rad/s].
        motor: angle [rad].
        motor_rate: [rad/s].
        joint: angle [rad].
        joint_rate: [rad/s].
        carried: torque of the gear on the joint [Nm].
    """

    reference: Floats
    reference_rate: Floats
    motor: Floats
    motor_rate: Floats
    joint: Floats
    joint_rate: Floats
    carried: Floats


class Loop(Protocol):
    """The control loops of a servo.

    Attributes:
        added: feed-forward torque (n,) [Nm], for the weight.
        rate: the quickest of the loops [1/s].
    """

    added: Floats
    rate: float

    def torque(self, step: float, seen: State) -> Floats:
        """The motors' torque (n,) [Nm] for a step [s], within their limits."""

    def reference_for(self, joint: Floats, motor: Floats, torque: Floats) -> Floats:
        """The reference (n,) [rad] that holds the arm still under torques (n,) [Nm] of the gears.

        Begins there: an integrator takes what the reference does not explain.
        """


class Cascade:
    """A position loop around a velocity loop, both on the motors' side, as industrial drives have.

        omega_wanted = kp (reference - theta) + reference_rate
        tau = added + I (kv miss + kv / reset integral of miss), miss = omega_wanted - omega

    With a rigid gear, no friction, no integral and no feed-forward the joint is the second-order
    loop q_ddot + kv q_dot + kp kv (q - reference) = 0.

    Args:
        inertia: I (n,) [kg m^2] that the drives are tuned for.
        rotor: the part of it (n,) [kg m^2] that is the rotor's.
        position: kp [1/s].
        velocity: kv [1/s].
        reset: time of the velocity loop's integral [s]; 0 for none.
        limit: of the torque (n,) [Nm].
        forward: share of the reference's rate that is fed forward.
    """

    def __init__(
        self,
        inertia: Floats,
        rotor: Floats,
        position: float,
        velocity: float,
        reset: float,
        limit: Floats,
        forward: float = 1.0,
    ) -> None:
        self._kp, self._forward, self._limit = position, forward, limit
        self._kv = inertia * velocity
        self._ki = self._kv / reset if reset > 0 else 0.0 * self._kv
        self._sum = np.zeros_like(inertia)
        self.added = np.zeros_like(inertia)
        self.rate = float((self._kv / rotor).max())

    def torque(self, step: float, seen: State) -> Floats:
        """The motors' torque (n,) [Nm] for a step [s], within their limits."""
        wanted = self._kp * (seen.reference - seen.motor) + self._forward * seen.reference_rate
        miss = wanted - seen.motor_rate
        gathered = self._sum + step * self._ki * miss
        raw = self.added + self._kv * miss + gathered
        given = np.minimum(np.maximum(raw, -self._limit), self._limit)
        # an integrator at the motors' limit would only go on gathering what it cannot get
        self._sum = np.where(raw == given, gathered, self._sum)
        return given

    def reference_for(self, joint: Floats, motor: Floats, torque: Floats) -> Floats:
        """The motors' own angle; the integrator, or where there is none the reference, holds."""
        short = torque - self.added
        if self._ki.any():
            self._sum = short
            return motor.copy()
        return np.asarray(motor + short / (self._kv * self._kp))


class ThetaGC:
    """A joint angle loop whose torque is scaled, around a torque loop: Meka's THETA_GC.

        tau_s = P (reference - q) + integral - D q_dot
        tau_d = s tau_s + added                               Pereira 2016 (4.2), (4.1)
        tau = tau_d + G (tau_d - tau_spring) - C (omega - q_dot)

    The springs of its series elastic joints tell the torque loop what arrives. G and C make that
    loop, with the joint held, one of second order: of `bandwidth`, damped by 0.7.

    Args:
        stiffness: P (n,) [Nm/rad].
        damping: D (n,) [Nm s/rad].
        reset: time of the integral [s]; 0 for none.
        scale: the stiffness scale s, 0 to 1.
        rotor: B (n,) [kg m^2].
        spring: k (n,) [Nm/rad] of the series elastic joints.
        bandwidth: of the torque loop [rad/s].
        limit: of the torque (n,) [Nm].
    """

    def __init__(
        self,
        stiffness: Floats,
        damping: Floats,
        reset: float,
        scale: float,
        rotor: Floats,
        spring: Floats,
        bandwidth: float,
        limit: Floats,
    ) -> None:
        self._p, self._d, self._limit = scale * stiffness, scale * damping, limit
        self._ki = self._p / reset if reset > 0 else 0.0 * self._p
        self._sum = np.zeros_like(stiffness)
        self._gain = np.maximum(rotor * bandwidth**2 / spring - 1.0, 0.0)
        self._calm = 1.4 * rotor * np.sqrt(spring * (1.0 + self._gain) / rotor)
        self.added = np.zeros_like(stiffness)
        self.rate = float((self._calm / rotor).max())

    def torque(self, step: float, seen: State) -> Floats:
        """The motors' torque (n,) [Nm] for a step [s], within their limits."""
        off = seen.reference - seen.joint
        gathered = self._sum + step * self._ki * off
        asked = self._p * off + gathered - self._d * seen.joint_rate + self.added
        raw = asked + self._gain * (asked - seen.carried)
        raw = raw - self._calm * (seen.motor_rate - seen.joint_rate)
        given = np.minimum(np.maximum(raw, -self._limit), self._limit)
        self._sum = np.where(raw == given, gathered, self._sum)
        return given

    def reference_for(self, joint: Floats, motor: Floats, torque: Floats) -> Floats:
        """Where the joint is pulled to by what the feed-forward leaves of the torque."""
        short = torque - self.added
        if self._ki.any():
            self._sum = short
            return joint.copy()
        return np.asarray(joint + short / self._p)

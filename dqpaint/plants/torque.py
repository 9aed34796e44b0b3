"""Joint-torque commands -> rigid bodies without joint motors."""

from typing import ClassVar

from dqpaint.dq import Floats
from dqpaint.plants.plant import PLANTS, Takes, Trait
from dqpaint.plants.rigid_arm import LONGEST_STEP, RigidArm, sample_postures
from dqpaint.robots.kinematics import Dynamics, Kinematics
from dqpaint.robots.model import Card


@PLANTS.add("torque")
class Torque(RigidArm):
    """Torques held for a period on rigid bodies with the file's friction, gravity on.

    Equation:
        H(q) q_ddot + C(q, q_dot) q_dot + G(q) + D q_dot = tau
    Idea:
        No servo at all: the law's torques move the arm, so the law has to know its dynamics.
    Stable:
        As the law; held for a period, so with periods of 5 ms or less.
    Fails:
        With laws that command rates: it takes torques alone.
    Try:
        dqpaint draw quarter-turn --controller accel --plant torque --disturb gravity=-0.1

    The dynamics are those of the file: its inertias and the viscous friction of its joints. Its
    integration is semi-implicit Euler, friction taken at the beginning of a step: much friction on
    a light link needs shorter ones.
    """

    takes: ClassVar[Takes] = "torque"
    traits: ClassVar[frozenset[Trait]] = RigidArm.traits | {"a model of gravity"}

    @staticmethod
    def longest_step(card: Card) -> float:
        """The physics step [s]: the time constant of the fastest friction, or 1 ms."""
        dynamics = Dynamics(Kinematics(card))
        decay = max(dynamics.decay(q) for q in sample_postures(card))
        return min(LONGEST_STEP, 1 / decay) if decay > 0 else LONGEST_STEP

    def run(self, command: Floats, drift: Floats | None = None) -> None:
        """One period at joint torques (n,) [Nm]."""
        torques = command.tolist()
        for _ in range(self.steps):
            self.bodies.apply(torques)
            if drift is not None:
                self.displace(self.step * drift)
        self.read_joints()
        self.effort = command

"""Joint-rate commands -> rigid bodies under velocity motors."""

from typing import ClassVar

from dqpaint.dq import Floats
from dqpaint.plants.plant import PLANTS, Takes, Trait
from dqpaint.plants.rigid_arm import RigidArm


@PLANTS.add("stiff")
class Stiff(RigidArm):
    """Velocity motors of infinite bandwidth within the card's torques: up to these no load shows.

    Equation:
        H q_ddot + C q_dot + G = tau_m
        q_dot(t + h) = q_dot_c, |tau_m| <= "effort"
    Idea:
        Each motor holds the rate it is given, whatever torque that needs, as long as it has it:
        a servo of infinite bandwidth. It differs from ideal where torques run out.
    Stable:
        As ideal, while no torque is at its limit.
    Fails:
        To show what real servos do: a push within the torques moves nothing. For friction, springs
        and bandwidth there are other plants.
    Try:
        dqpaint draw star --plant stiff --disturb payload=5
    """

    takes: ClassVar[Takes] = "rates"
    traits: ClassVar[frozenset[Trait]] = RigidArm.traits | {"sudden motors"}
    driven: ClassVar[bool] = True

    def run(self, command: Floats, drift: Floats | None = None) -> None:
        """One period at joint rates (n,) [rad/s], as far as the motors' torques go."""
        rates = command if drift is None else command + drift
        self.effort = self.bodies.turn(rates, self.steps)
        self.read_joints()

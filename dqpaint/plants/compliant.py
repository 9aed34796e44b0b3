"""Joint-rate commands -> an arm with series elastic joints between motors and rigid bodies.

    motor   theta_dot = command
    spring  tau = k (theta - q) + d (theta_dot - q_dot) + share G_model(q)
    arm     H(q) q_ddot + C q_dot + G(q) + friction = tau

The damper sits between motor and joint; with `damper=ground` it is d (0 - q_dot), between joint and
ground. The share of gravity that is compensated is a torque the motor adds by winding its spring
further, so tau is all that the joint is given; it ends at the card's torque.
"""

from typing import Annotated, Any, ClassVar, Literal

import numpy as np
from pydantic import Field, field_validator

from dqpaint.dq import Floats
from dqpaint.plants.plant import PLANTS, Options, PlantOptions, Springs, Takes, Trait
from dqpaint.plants.rigid_arm import RigidArm
from dqpaint.plants.springs import Positive, longest_step, numbers, per_joint
from dqpaint.plants.world import UNDISTURBED, World
from dqpaint.robots.kinematics import Dynamics, Kinematics
from dqpaint.robots.model import Card

LARGEST_PHASE_STEP = 0.02  # of a joint's own swing, in radians of its phase, fits one physics step


class CompliantOptions(PlantOptions):
    """The springs of a compliant arm."""

    frequency: Positive = Field(
        60.0, description="rad/s, natural frequency of each joint at home, the others held"
    )
    damping: Annotated[float, Field(ge=0, le=10)] = Field(
        0.7, description="ratio of each joint's damping to the critical one, likewise"
    )
    gravity: Annotated[float, Field(ge=0, le=1)] = Field(
        0.7, description="share of the weight that is compensated, 0 to 1"
    )
    stiffness: float | str | None = Field(
        None, description="Nm/rad instead of a frequency, for all joints or each: 300/300/200/..."
    )
    damper: Literal["motor", "ground"] = Field(
        "motor", description="motor: between motor and joint; ground: between joint and ground"
    )
    encoder: Literal["joint", "motor"] = Field(
        "joint", description="the side of the spring where angles are measured: joint or motor"
    )

    @field_validator("stiffness")
    @classmethod
    def _are_positive(cls, given: float | str | None) -> float | str | None:
        return numbers(given, "300 or 300/300/200")

    def summary(self, card: Card) -> dict[str, Any]:
        """The values, and the springs that result for an arm."""
        inertia = np.diag(Dynamics(Kinematics(card)).inertia(card.home))
        k, d = self.springs(card, inertia)
        found = {"stiffness_Nm_rad": k.tolist(), "damping_Nm_s_rad": d.tolist()}
        return {**self.model_dump(exclude={"stiffness"}), **found}

    def springs_for(self, card: Card) -> Springs:
        """The springs of an arm, for a forecast.

        Raises:
            UsageError: springs that a run would refuse.
        """
        dynamics = Dynamics(Kinematics(card))
        k, d = self.springs(card, np.diag(dynamics.inertia(card.home)))
        longest_step("compliant", card, dynamics, k, d, LARGEST_PHASE_STEP)
        between = d if self.damper == "motor" else np.zeros_like(d)
        return Springs(k, between, self.gravity, self.encoder == "joint")

    def springs(self, card: Card, inertia: Floats) -> tuple[Floats, Floats]:
        """Stiffness (n,) [Nm/rad] and damping (n,) [Nm s/rad].

        Args:
            card: of the arm.
            inertia: of each joint (n,) [kg m^2] with the others held.

        Raises:
            UsageError: not one stiffness for each joint.
        """
        if self.stiffness is None:
            k = self.frequency**2 * inertia
        else:
            k = per_joint("compliant", "stiffness", self.stiffness, card)
        return k, 2 * self.damping * np.sqrt(k * inertia)


@PLANTS.add("compliant")
class Compliant(RigidArm):
    """Series elastic joints: motors wind springs that move rigid bodies, gravity on.

    Equation:
        H q_ddot + C q_dot + G = tau_s
        tau_s = K (theta - q) + D (theta_dot - q_dot) + "gravity" G
        theta_dot = q_dot_c
    Idea:
        Between motor and joint there is a spring and a damper. The motor turns at the rate it is
        given, the arm swings behind it and sags under its weight.
    Stable:
        Under a law that measures the joints up to a rate of about half the springs' frequency:
        40 1/s at 80 rad/s, less with the damper to the ground.
    Fails:
        Above that rate it swings, and the bounds of hinf no longer hold. Its motor is an ideal
        source of velocity: no friction, no rotor, no inner loop.
    Try:
        dqpaint compare lag --controllers "p(k=20),p(k=120)" --plants compliant

    It begins at rest, its springs already carrying their part of the weight. Physics steps are as
    short as the springs need: each joint's own swing is resolved finely, the quickest mode of the
    coupled arm stays stable. Semi-implicit Euler has its places half a step ahead of its rates: all
    forces are those of the middle of a step, and so the whole is of second order.

    A motor at its torque is held back: its spring is wound no further.

    Attributes:
        stiffness: (n,) [Nm/rad].
        damping: (n,) [Nm s/rad].
        motor: motor angles (n,) [rad], without what compensates gravity.
    """

    takes: ClassVar[Takes] = "rates"
    traits: ClassVar[frozenset[Trait]] = RigidArm.traits | {"a model of gravity"}
    options: ClassVar[Options] = CompliantOptions

    def __init__(
        self,
        card: Card,
        posture: Floats,
        period: float,
        world: World = UNDISTURBED,
        options: CompliantOptions | None = None,
        engine: str | None = None,
    ) -> None:
        chosen = options or CompliantOptions.model_validate({})
        model = Kinematics(card)
        dynamics = Dynamics(model)
        inertia = np.diag(dynamics.inertia(card.home))
        self.stiffness, self.damping = chosen.springs(card, inertia)
        longest = longest_step(
            "compliant", card, dynamics, self.stiffness, self.damping, LARGEST_PHASE_STEP
        )
        super().__init__(card, posture, period, world, engine=engine, longest=longest)
        self._own = Dynamics(model.with_model_error(gravity=world.model_gravity))
        self._share = chosen.gravity
        self._grounded = chosen.damper == "ground"
        self._at_motor = chosen.encoder == "motor"
        self._true_weight = self.bodies.weight(posture)
        self.motor = posture + (self._true_weight - self._compensation()) / self.stiffness
        self._motor_rates = np.zeros(card.joints)
        self._before = [0.0] * card.joints  # rates [rad/s] a physics step ago
        self.effort = self._true_weight

    @property
    def encoder(self) -> Floats:
        """Joint angles (n,) [rad], or the motors'."""
        return self.motor if self._at_motor else self.posture

    @property
    def encoder_rates(self) -> Floats:
        """Joint rates (n,) [rad/s], or the motors'."""
        return self._motor_rates if self._at_motor else self.rates

    def run(self, command: Floats, drift: Floats | None = None) -> None:
        """One period in which the motors turn at joint rates (n,) [rad/s]."""
        self._motor_rates = command if drift is None else command + drift
        added = self._compensation().tolist()  # renewed once a period, from the joints
        rates = np.zeros_like(command) if self._grounded else command
        turn = (self.step * self._motor_rates).tolist()
        rest = list(zip(
            self.stiffness.tolist(), self.damping.tolist(), rates.tolist(), added,
            self.card.effort.tolist(), strict=True,
        ))  # fmt: skip
        middle = (self.motor + 0.5 * self.step * self._motor_rates).tolist()
        before, carried = self._before, []
        for _ in range(self.steps):
            angles, turning = self.bodies.state()
            torques = [
                min(max(k * (m - q) + d * (u - 1.5 * w + 0.5 * v) + c, -most), most)
                for m, q, w, v, (k, d, u, c, most) in zip(
                    middle, angles, turning, before, rest, strict=True
                )
            ]
            before = turning
            self.bodies.apply(torques)
            carried.append(torques)
            if drift is not None:
                self.displace(self.step * drift)
            middle = [m + way for m, way in zip(middle, turn, strict=True)]
        self._before = before
        self.read_joints()
        self.posture = self.posture - 0.5 * self.step * self.rates
        efforts = np.array(carried)
        self.effort = efforts[np.abs(efforts).argmax(axis=0), np.arange(len(command))]
        motor = self.motor + self.steps * self.step * self._motor_rates
        most = self.card.effort
        self.motor = self.posture + np.clip(
            motor - self.posture, (-most - added) / self.stiffness, (most - added) / self.stiffness
        )

    def _compensation(self) -> Floats:
        """Gravity torques (n,) [Nm] at the present posture, from the arm's own model."""
        return self._share * self._own.weight(self.posture)

"""Joint-rate commands -> an arm under servo motors with gears, friction, backlash and delay.

    motor   B theta_ddot = tau_motor + ripple - viscous theta_dot - friction - tau
    gear    tau = k (theta - q, beyond the backlash) + d (theta_dot - q_dot)
    arm     H(q) q_ddot + C q_dot + G(q) + friction of the file = tau

The motors' side is `plants.motors`; the links' side is a physics engine's.
"""

from functools import partial
from typing import ClassVar

import numpy as np

from dqpaint.dq import Floats
from dqpaint.plants.motors import (
    Cascade,
    CommandFilter,
    Loop,
    MinimumJerk,
    ServoMotors,
    Slew,
    ThetaGC,
)
from dqpaint.plants.plant import PLANTS, Options, Takes, Trait
from dqpaint.plants.rigid_arm import RigidArm
from dqpaint.plants.servo_options import Motors, ServoOptions, find_motors
from dqpaint.plants.springs import longest_step
from dqpaint.plants.world import UNDISTURBED, World
from dqpaint.robots.kinematics import Dynamics, Kinematics
from dqpaint.robots.model import Card

LARGEST_PHASE_STEP = 1.0  # of a joint's own swing on its gear, in radians, fits one physics step


@PLANTS.add("servo")
class Servo(RigidArm):
    """Servo motors: loops, rotors, gears, friction, backlash, ripple and delay, gravity on.

    Equation:
        B theta_ddot + D theta_dot + F(theta_dot) = tau_m + tau_r - tau
        tau = k (theta - q, "beyond the backlash") + d (theta_dot - q_dot)
        H q_ddot + C q_dot + G = tau
        tau_m = I K_v (K_p (theta_c - theta) + theta_c_dot - theta_dot) + "reset" + "gravity" G
    Idea:
        What a real arm has between command and joint: an integrating reference, a position and a
        velocity loop, a rotor behind a gear that gives way, sticks and has play. With friction,
        play and delay at zero and high gains it tends to stiff.
    Stable:
        Where the law's rate lies well below `position`, and that below `velocity`; delay and the
        gear's own swing take from both.
    Fails:
        With friction and an integral the joints hunt about rest. What a card does not say is
        assumed, and the run says so.
    Try:
        dqpaint compare lag --controllers hinf --plants stiff,servo

    It begins at rest and in balance. Parameters are those of the card, with their source; what it
    has not is assumed, and a run says so.

    Attributes:
        motors: what moves the links.
    """

    takes: ClassVar[Takes] = "rates"
    traits: ClassVar[frozenset[Trait]] = RigidArm.traits | {"a model of gravity"}
    options: ClassVar[Options] = ServoOptions

    def __init__(
        self,
        card: Card,
        posture: Floats,
        period: float,
        world: World = UNDISTURBED,
        options: ServoOptions | None = None,
        engine: str | None = None,
    ) -> None:
        chosen = options or ServoOptions.model_validate({})
        train = find_motors(card, chosen)
        model = Kinematics(card)
        one = train.gears
        longest = longest_step(
            "servo", card, Dynamics(model), one.stiffness, one.damping, LARGEST_PHASE_STEP,
            one.inertia,
        )  # fmt: skip
        super().__init__(card, posture, period, world, engine=engine, longest=longest)
        self._own = Dynamics(model.with_model_error(gravity=world.model_gravity))
        self._share, self._period = chosen.gravity, period
        self._from_measured = chosen.reference == "measured"
        self._at_motor = chosen.encoder == "motor"
        loop = _make_loop(chosen, train, card)
        loop.added = self._compensation()
        weight = self.bodies.weight(posture)
        self.motors = ServoMotors(
            one, loop, partial(_make_filter, chosen, train, period), posture, weight,
            np.stack([card.lower, card.upper]), chosen.delay, chosen.current,
        )  # fmt: skip
        self._before = np.zeros(card.joints)  # rates [rad/s] a physics step ago
        self.effort = weight

    @property
    def encoder(self) -> Floats:
        """Motor angles (n,) [rad] at the joints' side of the gears, or the joints' own."""
        return self.motors.gear.angle if self._at_motor else self.posture

    @property
    def encoder_rates(self) -> Floats:
        """Motor rates (n,) [rad/s], or the joints'."""
        return self.motors.gear.rate if self._at_motor else self.rates

    def run(self, command: Floats, drift: Floats | None = None) -> None:
        """One period of a reference that is moved by joint rates (n,) [rad/s]."""
        motors = self.motors
        motors.loop.added = self._compensation()
        if self._from_measured:
            motors.command_angle(self.encoder + self._period * command)
        else:
            motors.command(command)
        before = self._before
        for _ in range(self.steps):
            angles, rates = map(np.array, self.bodies.state())
            # the engine's angles are half a step ahead of its rates: those of the step's middle
            torques = motors.step(self.step, angles, 1.5 * rates - 0.5 * before)
            before = rates
            self.bodies.apply(torques.tolist())
            if drift is not None:
                self.displace(self.step * drift)
                motors.displace(self.step * drift)
        self._before = before
        self.read_joints()
        self.posture = self.posture - 0.5 * self.step * self.rates
        self.effort = motors.largest

    def _compensation(self) -> Floats:
        """Gravity torques (n,) [Nm] that are fed forward, from the arm's own model."""
        return self._share * self._own.weight(self.posture)


def _make_loop(options: ServoOptions, train: Motors, card: Card) -> Loop:
    one = train.gears
    if options.loop == "cascade":
        return Cascade(
            one.inertia + train.inertia, one.inertia, options.position, options.velocity,
            options.reset_time, card.effort,
        )  # fmt: skip
    damping = 2 * options.damping * np.sqrt(train.hold * train.inertia)
    return ThetaGC(
        train.hold, damping, options.reset_time, options.scale, one.inertia, one.stiffness,
        options.torque, card.effort,
    )  # fmt: skip


def _make_filter(
    options: ServoOptions, train: Motors, period: float, first: Floats
) -> CommandFilter:
    if options.filter == "slew":
        return Slew(first, train.slew)
    return MinimumJerk(first, train.slew, period)

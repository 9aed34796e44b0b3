"""An arm's card and the options of plant `servo` -> its motors, and what of them is assumed."""

from dataclasses import dataclass
from typing import Annotated, Any, Literal

import numpy as np
from pydantic import Field, ValidationInfo, field_validator

from dqpaint.dq import Floats
from dqpaint.plants.motors import Gears
from dqpaint.plants.plant import PlantOptions, Springs
from dqpaint.plants.springs import Positive, numbers, per_joint
from dqpaint.robots.kinematics import Dynamics, Kinematics
from dqpaint.robots.model import Card

# What is assumed of an arm whose card has no number with a source
GEAR = 100.0
VISCOUS_SHARE = 0.05  # of a joint's largest torque, at its largest speed
FRICTION_SHARE = 0.02  # of a joint's largest torque
INERTIA_SHARE = 0.01  # [s^2] of a joint's largest torque is the reflected inertia of its rotor
STIFFNESS_SHARE = 160.0  # [1/rad] of that torque: a gear gives 6 mrad at the most
SPRING_SHARE = 10.0  # [1/rad] likewise, of the series elastic joints of theta-gc
HOLD_SHARE = 1.0  # [1/rad] of that torque is P of theta-gc
BACKLASH = np.radians(1 / 60)  # [rad]
RIPPLE_SHARE = 0.002  # of a joint's largest torque
RIPPLES = 2  # in a turn of the motor, as harmonic drives have

NotNegative = Annotated[float, Field(ge=0, allow_inf_nan=False)]
Each = float | str | None
EACH_JOINT = (
    "hold", "slew", "gear", "rotor", "viscous", "friction", "stiffness", "backlash", "ripple",
)  # fmt: skip
EACH = "for all joints or each, a/b/..."


class ServoOptions(PlantOptions):
    """The motors, gears and loops of a servo; what is not given is the card's, or assumed."""

    loop: Literal["cascade", "theta-gc"] = Field(
        "cascade", description="cascade: position and velocity loop; theta-gc: Meka's THETA_GC"
    )
    position: Positive = Field(40.0, description="1/s, gain of the position loop of cascade")
    velocity: Positive = Field(120.0, description="1/s, gain of the velocity loop of cascade")
    reset: NotNegative | None = Field(
        None, description="s, reset time of the integral, 0 for none; 0.1 for cascade, else none"
    )
    current: Positive = Field(1500.0, description="rad/s, bandwidth of the current loops")
    hold: Each = Field(None, description=f"Nm/rad, P of theta-gc at scale 1, {EACH}")
    damping: NotNegative = Field(1.0, description="ratio of theta-gc's damping to the critical one")
    scale: Annotated[float, Field(gt=0, le=1)] = Field(
        1.0, description="stiffness scale s of theta-gc, 0 to 1"
    )
    torque: Positive = Field(300.0, description="rad/s, bandwidth of theta-gc's torque loop")
    gravity: Annotated[float, Field(ge=0, le=1)] = Field(
        1.0, description="share of the weight that is fed forward, 0 to 1"
    )
    reference: Literal["integral", "measured"] = Field(
        "integral",
        description="how a rate u moves the reference: integral of u; measured: angle + period u",
    )
    filter: Literal["slew", "minimum-jerk"] = Field(
        "slew", description="of the reference: slew (limits its speed), or minimum-jerk"
    )
    slew: Each = Field(None, description=f"rad/s, speed of that filter, {EACH}; the card's speed")
    delay: Annotated[float, Field(ge=0, le=1)] = Field(0.002, description="s, of commands")
    encoder: Literal["motor", "joint"] = Field(
        "motor", description="the side of the gear where the law's angles are measured"
    )
    gear: Each = Field(None, description=f"ratio, {EACH}")
    rotor: Each = Field(None, description=f"kg m2, inertia of the rotor itself, {EACH}")
    viscous: Each = Field(None, description=f"Nm s/rad, friction by rate, {EACH}")
    friction: Each = Field(None, description=f"Nm, Coulomb friction, {EACH}")
    stiction: Annotated[float, Field(ge=1, allow_inf_nan=False)] = Field(
        1.2, description="static friction as a multiple of it, from 1"
    )
    stiffness: Each = Field(None, description=f"Nm/rad, of the gear or its spring, {EACH}")
    loss: Annotated[float, Field(ge=0, le=2)] = Field(
        0.05, description="ratio of the gear's damping to the critical one"
    )
    backlash: Each = Field(None, description=f"rad, the whole gap of the gear, {EACH}")
    ripple: Each = Field(None, description=f"Nm, amplitude of torque ripple, {EACH}")

    @field_validator("hold", "slew", "gear", "rotor", "stiffness")
    @classmethod
    def _are_positive(cls, given: Each, info: ValidationInfo) -> Each:
        return numbers(given, "3 or 3/3/2")

    @field_validator("viscous", "friction", "backlash", "ripple")
    @classmethod
    def _are_not_negative(cls, given: Each, info: ValidationInfo) -> Each:
        return numbers(given, "0.3 or 0.3/0.3/0.2", 0.0)

    @property
    def clips_rates(self) -> bool:
        """Whether rates are limited before they come; a measured reference is slewed instead."""
        return self.reference == "integral"

    def summary(self, card: Card) -> dict[str, Any]:
        """The values, and the motors that result for an arm with where they are from."""
        train = find_motors(card, self)
        return {**self.model_dump(exclude=set(EACH_JOINT)), **train.summary()}

    def notes(self, card: Card) -> tuple[str, ...]:
        """What is assumed of an arm's motors."""
        train = find_motors(card, self)
        if not train.assumed:
            return ()
        known = "" if card.drives else ", whose card has no data of its motors"
        return (
            f"plant 'servo' on {card.name}{known}: assumed are {', '.join(train.assumed)}, and the "
            "gains of its loops where not given",
        )

    def springs_for(self, card: Card) -> Springs:
        """What yields to the weight, for a forecast: gears, or the joints of theta-gc."""
        train = find_motors(card, self)
        seen = self.encoder == "joint"
        if self.loop == "cascade":
            return Springs(train.gears.stiffness, train.gears.damping, 0.0, seen)
        return Springs(self.scale * train.hold, 0.0 * train.hold, self.gravity, True)

    @property
    def reset_time(self) -> float:
        """Of the integral [s]; 0 for none."""
        usual = 0.1 if self.loop == "cascade" else 0.0
        return usual if self.reset is None else self.reset


@dataclass(frozen=True)
class Motors:
    """The motors of an arm.

    Attributes:
        gears: of its joints.
        ratio: of the gears (n,).
        slew: (n,) [rad/s].
        hold: P of theta-gc (n,) [Nm/rad].
        inertia: of each joint's links at home (n,) [kg m^2], the others held.
        origin: of each parameter by its name: `given`, `card` or `assumed`.
        source: of the card's numbers.
    """

    gears: Gears
    ratio: Floats
    slew: Floats
    hold: Floats
    inertia: Floats
    origin: dict[str, str]
    source: str

    @property
    def assumed(self) -> tuple[str, ...]:
        """The parameters that neither a person nor a source gave."""
        return tuple(name for name, where in self.origin.items() if where == "assumed")

    def summary(self) -> dict[str, Any]:
        """Every number, and where it is from."""
        one = self.gears
        return {
            "gear_ratio": self.ratio.tolist(),
            "rotor_inertia_kg_m2": (one.inertia / self.ratio**2).tolist(),
            "reflected_inertia_kg_m2": one.inertia.tolist(),
            "viscous_Nm_s_rad": one.viscous.tolist(),
            "friction_Nm": one.friction.tolist(),
            "stiffness_Nm_rad": one.stiffness.tolist(),
            "damping_Nm_s_rad": one.damping.tolist(),
            "backlash_rad": one.backlash.tolist(),
            "ripple_Nm": one.ripple.tolist(),
            **({"hold_Nm_rad": self.hold.tolist()} if np.isfinite(self.hold).all() else {}),
            "slew_rad_s": self.slew.tolist(),
            "origin": self.origin,
            "source": self.source,
        }


def find_motors(card: Card, options: ServoOptions) -> Motors:
    """The motors of an arm: as given, else as the card has them, else assumed.

    Raises:
        UsageError: an option has not one number for all joints, nor one for each.
    """
    inertia = np.diag(Dynamics(Kinematics(card)).inertia(card.home)).copy()
    train = card.drives
    origin: dict[str, str] = {}

    def choose(name: str, given: Each, row: str, assumed: Floats | float) -> Floats:
        if given is not None:
            origin[name] = "given"
            return per_joint("servo", name, given, card)
        if train is not None and (of_card := getattr(train, row)):
            origin[name] = "card"
            return np.array(of_card)
        origin[name] = "assumed"
        return np.array(np.broadcast_to(assumed, card.joints))

    most = card.effort
    ratio = choose("gear", options.gear, "gear", GEAR)
    rotor = choose("rotor", None, "reflected_inertia_kg_m2", INERTIA_SHARE * most)
    if options.rotor is not None:
        origin["rotor"] = "given"
        rotor = ratio**2 * per_joint("servo", "rotor", options.rotor, card)
    yields = STIFFNESS_SHARE if options.loop == "cascade" else SPRING_SHARE
    stiffness = choose("stiffness", options.stiffness, "stiffness_Nm_rad", yields * most)
    backlash = choose("backlash", options.backlash, "backlash_deg", BACKLASH)
    if origin["backlash"] == "card":
        backlash = np.radians(backlash)
    slew = card.speed if options.slew is None else per_joint("servo", "slew", options.slew, card)
    gears = Gears(
        inertia=rotor,
        viscous=choose(
            "viscous", options.viscous, "viscous_Nm_s_rad", VISCOUS_SHARE * most / card.speed
        ),
        friction=choose("friction", options.friction, "friction_Nm", FRICTION_SHARE * most),
        stiction=np.full(card.joints, options.stiction),
        stiffness=stiffness,
        damping=2 * options.loss * np.sqrt(stiffness * rotor * inertia / (rotor + inertia)),
        backlash=backlash,
        ripple=choose("ripple", options.ripple, "ripple_Nm", RIPPLE_SHARE * most),
        cycles=RIPPLES * ratio,
    )
    if options.loop == "theta-gc":
        hold = choose("hold", options.hold, "hold_Nm_rad", HOLD_SHARE * most)
    else:
        hold = np.full(card.joints, np.nan)
    return Motors(gears, ratio, slew, hold, inertia, origin, train.source if train else "")

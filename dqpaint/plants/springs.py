"""Springs between motors and joints -> their values for an arm, and the physics step they need."""

from typing import Annotated

import numpy as np
from pydantic import Field

from dqpaint.dq import Floats
from dqpaint.errors import UsageError
from dqpaint.plants.rigid_arm import LONGEST_STEP, sample_postures
from dqpaint.robots.kinematics import Dynamics
from dqpaint.robots.model import Card

STABLE_SHARE = 0.5  # of the longest step that is stable, for the quickest mode of any posture
SHORTEST_STEP = 1e-5  # [s]

Positive = Annotated[float, Field(gt=0, allow_inf_nan=False)]


def numbers(
    given: float | str | None, example: str, least: float | None = None
) -> float | str | None:
    """Check an option with one number for all joints, or one a joint: 300 or 300/300/200.

    Args:
        given: as it was written.
        example: for the message.
        least: the smallest that is allowed; None asks for positive numbers.

    Raises:
        ValueError: it has something else.
    """
    try:
        found = [] if given is None else [float(part) for part in str(given).split("/")]
    except ValueError:
        found = [float("nan")]
    if least is None:
        good, kind = all(0 < one < float("inf") for one in found), "positive numbers"
    else:
        good, kind = all(least <= one < float("inf") for one in found), f"numbers from {least:g} on"
    if not good:
        raise ValueError(f"{given!r} should be {kind}, as in {example}")
    return given


def per_joint(plant: str, name: str, given: float | str, card: Card) -> Floats:
    """The numbers (n,) of an option that `numbers` has checked.

    Raises:
        UsageError: not one for all, nor one for each joint.
    """
    found = np.array([float(part) for part in str(given).split("/")])
    if len(found) not in (1, card.joints):
        raise UsageError(
            f"plant '{plant}': {name} has {len(found)} numbers, "
            f"but {card.name} has {card.joints} joints"
        )
    return np.array(np.broadcast_to(found, card.joints))


def longest_step(
    plant: str,
    card: Card,
    dynamics: Dynamics,
    k: Floats,
    d: Floats,
    finest: float,
    rotor: Floats | None = None,
) -> float:
    """The physics step [s] that resolves the springs and keeps every mode stable.

    A step h of semi-implicit Euler whose damper sees 1.5 v(k) - 0.5 v(k-1) is stable for
    h^2 w^2 + 4 h c < 4, with w^2 and c the eigenvalues of H^-1 k and H^-1 d, friction included.
    Looked at in postures all over the arm's range. Rotors swing against their links: they add k / B
    and d / B.

    Args:
        plant: its name, for the message.
        card: of the arm.
        dynamics: of the arm.
        k: stiffness (n,) [Nm/rad].
        d: damping (n,) [Nm s/rad].
        finest: the phase [rad] of each joint's own swing at home that fits one step.
        rotor: inertia B (n,) [kg m^2] of rotors that move freely; None where motors are driven.

    Raises:
        UsageError: springs that need steps too short to be simulated.
    """
    own = np.sqrt(k / np.diag(dynamics.inertia(card.home)))
    longest = min(LONGEST_STEP, finest / float(own.max()))
    more, most = (
        (0.0, 0.0) if rotor is None else (float((k / rotor).max()), float((d / rotor).max()))
    )
    for q in sample_postures(card):
        H = dynamics.inertia(q)
        swing = more + float(np.linalg.eigvals(np.linalg.solve(H, np.diag(k))).real.max())
        loss = most + dynamics.decay(q, d)
        stable = 2 * (np.sqrt(loss**2 + swing) - loss) / swing
        longest = min(longest, STABLE_SHARE * stable)
    if longest < SHORTEST_STEP:
        raise UsageError(
            f"plant '{plant}': springs of this stiffness on {card.name} need physics steps of "
            f"{longest * 1e6:.2g} us; use softer springs, or plant stiff"
        )
    return longest

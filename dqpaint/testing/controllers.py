"""A control law -> whether its commands are sound, repeatable and blind to the signs of poses."""

from collections.abc import Callable, Iterator, Mapping
from dataclasses import replace
from typing import Any

import numpy as np

from dqpaint import dq
from dqpaint.controllers import (
    Arm,
    Controller,
    Seen,
    find_controller,
    make_controller,
)
from dqpaint.dq import Floats
from dqpaint.language import parse
from dqpaint.motion import Motion, plan
from dqpaint.plants import PLANTS
from dqpaint.robots.kinematics import Dynamics
from dqpaint.simulation import Track, track
from dqpaint.testing.runs import arm, motion, require, start

STEPS = 20
SETTLED = 4e-6  # of the remaining displacement [rad, m]
SAME = 1e-11  # of a command's size
Gains = Mapping[str, float | tuple[float, ...] | str]


def check_controller(
    law: str | Controller[Any] | Callable[..., Any],
    gains: Gains | None = None,
    settles: float | None = 3.0,
) -> None:
    """Check what every control law promises.

    It has a summary and describes its gains; its commands have the right shape and are finite, also
    at joint limits and half a turn away; they do not depend on the signs of poses; a run repeats
    itself bit for bit, whatever ran before it in the same process; and a set point is reached, as
    far as the law controls it.

    Args:
        law: its name or `FILE.py[:NAME]`, a function, a class, or a `Controller`.
        gains: other than its defaults.
        settles: how long it may take to come to rest at a set point [s]; None is not checked.

    Raises:
        AssertionError: a promise that is not kept.
    """
    controller = _controller(law)
    require(bool((controller.law.__doc__ or "").strip()), "a law has a docstring")
    for name, field in controller.gains.model_fields.items():
        require(bool(field.description), f"its gain '{name}' has a description with the unit")
    first = _run(controller, gains or {}, motion())
    require(bool(np.isfinite(first.pose).all()), "a run stays finite")
    _run(controller, gains or {}, _still(0.3))
    again = _run(controller, gains or {}, motion())
    require(np.array_equal(first.command, again.command), "runs share no state: the same bits")
    _check_commands(controller, gains or {})
    _check_signs(controller, gains or {})
    if settles is not None:
        reached = _run(controller, gains or {}, _still(settles))
        far = left_over(controller, reached.pose[-1], _home())
        require(far < SETTLED, f"a set point is reached in {settles:g} s; it was {far:.2g} away")


def left_over(controller: Controller[Any], pose: Floats, goal: Floats) -> float:
    """The largest of the errors [rad, m] that a law controls, at a pose (8,) for a goal (8,)."""
    off = 2.0 * dq.log(dq.mul(pose, dq.conj(dq.nearest(goal, pose))))
    parts: dict[str, Floats] = {
        "pose": off,
        "orientation": off[:3],
        "position": dq.translation(pose) - dq.translation(goal),
        "nothing": np.zeros(1),
    }
    return float(np.abs(parts[controller.controls]).max())


def seen_at(q: Floats, pose_d: Floats, rng: np.random.Generator) -> Seen:
    """What a law sees in a posture (n,) when everything moves, also of the arm's dynamics."""
    model = arm()
    pose, jacobian = model.pose_and_jacobian(q)
    rates = rng.normal(size=len(q))
    inertia, bias = Dynamics(model).inertia_and_bias(q, rates)
    return Seen(
        pose, pose_d, rng.normal(size=6), rng.normal(size=6), jacobian, q, 0.0, motion().period,
        rates, 0, Arm(model).limits, motion(), inertia, bias,
    )  # fmt: skip


def _controller(law: Any) -> Controller[Any]:
    if isinstance(law, Controller):
        return law
    return find_controller(law) if isinstance(law, str) else make_controller(law, "checked")


def _command(controller: Controller[Any], gains: Gains, seen: Seen) -> Floats:
    """The first command of a law that has just been started."""
    schedule = controller.read_gains(gains)
    return np.asarray(controller.start(Arm(arm()), motion(), schedule)(seen, schedule.first))


def _states(rng: np.random.Generator) -> Iterator[Seen]:
    """Postures in the joints' range and at its ends, asked for poses up to half a turn away."""
    card = arm().card
    ends = [card.home, card.lower, card.upper]
    for q in [*ends, *rng.uniform(card.lower, card.upper, (STEPS, card.joints))]:
        axis = rng.normal(size=3)
        turn = np.concatenate([axis / np.linalg.norm(axis) * np.pi, rng.normal(size=3)])
        for displacement in (turn, rng.normal(size=6)):
            yield seen_at(q, dq.mul(dq.exp(displacement / 2), arm().pose(q)), rng)


def _check_commands(controller: Controller[Any], gains: Gains) -> None:
    shape = (6,) if controller.commands in ("twist", "acceleration") else (arm().card.joints,)
    for seen in _states(np.random.default_rng(1)):
        command = _command(controller, gains, seen)
        require(command.shape == shape, f"a command has shape {shape}, this one {command.shape}")
        require(bool(np.isfinite(command).all()), "commands are finite in every posture")


def _check_signs(controller: Controller[Any], gains: Gains) -> None:
    for seen in _states(np.random.default_rng(2)):
        near = dq.mul(dq.exp(0.1 * seen.twist_d), seen.pose)  # half a turn has no nearer side
        seen = seen._replace(pose_d=near)
        plain = _command(controller, gains, seen)
        for other in (seen._replace(pose=-seen.pose), seen._replace(pose_d=-near)):
            far = np.abs(_command(controller, gains, other) - plain).max()
            require(far <= SAME * np.abs(plain).max(), "x and -x are the same pose")


def _home() -> Floats:
    return arm().pose(arm().card.home)


def _still(seconds: float) -> Motion:
    """A set point: the pose of the home posture, in which no run here begins."""
    still = plan(parse(f"period 5 ms\nhold {seconds} s\n", "still.traj"), arm().card.canvas.pose)
    return replace(still, pose=np.tile(_home(), (len(still.t), 1)))


def _run(controller: Controller[Any], gains: Gains, asked: Motion) -> Track:
    plant = PLANTS["torque" if controller.drives_torque else "ideal"]
    return track(asked, arm(), start(), plant, controller, controller.read_gains(gains))

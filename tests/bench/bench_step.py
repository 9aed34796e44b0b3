"""A control step of `pff` against dqrobotics: `python tests/bench/bench_step.py [ROUNDS]`.

A step is the pose and Jacobian of the iiwa at a posture, the law, and joint rates from it. The peer
is the same law written with the C++ primitives of dqrobotics: its forward kinematics and pose
Jacobian, its products, conjugates and Hamilton operators, and numpy for the damped solution. Beside
it, for information, the ready class DQ_PseudoinverseController, whose error is the plain
difference. Rounds are interleaved; the target is at most 1.0 times the primitives.
"""

import statistics
import sys
import time

import dqrobotics
import numpy as np
from dqrobotics.robot_control import ControlObjective, DQ_PseudoinverseController
from dqrobotics.robot_modeling import DQ_SerialManipulatorDH

from dqpaint import dq
from dqpaint.controllers import CONTROLLERS, Seen
from dqpaint.robots.kinematics.kinematics import Kinematics
from dqpaint.robots.kinematics.nullspace import make_secondary_task
from dqpaint.robots.model.card import read_card
from dqpaint.simulation.drives import make_drive

STEPS = 400
K = 20.0


def peer_arm(kinematics):
    """The iiwa of the file by Denavit-Hartenberg, its tool as effector."""
    half = np.pi / 2
    d, alpha = [0.36, 0, 0.42, 0, 0.4, 0, 0.081], [-half, half, half, -half, -half, half, 0]
    arm = DQ_SerialManipulatorDH(np.array([np.zeros(7), d, np.zeros(7), alpha, np.zeros(7)]))
    q = kinematics.card.home
    effector = dq.mul(dq.conj(arm.fkm(q).vec8()), kinematics.pose(q))
    arm.set_effector(dqrobotics.DQ(list(effector)))
    return arm


def ours(kinematics, poses, twists):
    chosen = CONTROLLERS["pff"]
    gains = chosen.read_gains({"k": K}).first
    wish = make_secondary_task("start", kinematics.card, kinematics.card.home)
    drive = make_drive(chosen, [chosen.law], kinematics, wish, 0.008)
    still, rates = np.zeros(6), np.zeros(7)

    def step(k, q):
        x, J = kinematics.pose_and_jacobian(q)
        return drive.command(Seen(x, poses[k], twists[k], still, J, q, 0.0, 0.008, rates), gains)

    return step


def primitives(arm, home, poses, twists):
    desired = [dqrobotics.DQ(list(x)) for x in poses]
    moving = [
        0.5 * dqrobotics.DQ(list(dq.pure(xi))) * x for xi, x in zip(twists, desired, strict=True)
    ]
    one, C8, eye = dqrobotics.DQ([1]), dqrobotics.C8(), np.eye(7)

    def step(k, q):
        x, J = arm.fkm(q), arm.pose_jacobian(q)
        x_d, rate_d = desired[k], moving[k]
        if x.vec4() @ x_d.vec4() < 0:
            x_d, rate_d = -x_d, -rate_d
        back = x.conj()
        N = x_d.haminus8() @ C8 @ J
        wanted = K * (one - back * x_d).vec8() - (back * rate_d).vec8()
        inverse = np.linalg.pinv(N, rcond=1e-6)
        wish = 2.0 * (home - q)
        return inverse @ wanted + (eye - inverse @ N) @ wish

    return step


def ready_class(arm, poses, twists):
    controller = DQ_PseudoinverseController(arm)
    controller.set_control_objective(ControlObjective.Pose)
    controller.set_gain(K)
    controller.set_damping(1e-3)
    desired = [dqrobotics.DQ(list(x)) for x in poses]
    moving = [
        0.5 * dqrobotics.DQ(list(dq.pure(xi))) * x for xi, x in zip(twists, desired, strict=True)
    ]
    return lambda k, q: controller.compute_tracking_control_signal(
        q, desired[k].vec8(), moving[k].vec8()
    )


def main():
    rounds = int(sys.argv[1]) if len(sys.argv) > 1 else 25
    kinematics = Kinematics(read_card("iiwa"))
    arm, home = peer_arm(kinematics), kinematics.card.home
    rng = np.random.default_rng(1)
    postures = home + rng.uniform(-0.3, 0.3, (STEPS, 7))
    poses = kinematics.poses(postures + rng.uniform(-0.05, 0.05, (STEPS, 7)))
    twists = 0.3 * rng.normal(size=(STEPS, 6))
    ways = {
        "primitives": primitives(arm, home, poses, twists),
        "ours": ours(kinematics, poses, twists),
        "ready class": ready_class(arm, poses, twists),
    }
    gap = max(
        np.abs(ways["ours"](k, q) - ways["primitives"](k, q)).max() for k, q in enumerate(postures)
    )
    times = {name: [] for name in ways}
    for _ in range(rounds + 1):
        for name, step in ways.items():
            begin = time.perf_counter()
            for k, q in enumerate(postures):
                step(k, q)
            times[name].append((time.perf_counter() - begin) / STEPS)
    medians = {name: statistics.median(values[1:]) for name, values in times.items()}
    for name, middle in medians.items():
        print(
            f"{name:12} {middle * 1e6:6.1f} us   {middle / medians['primitives']:.2f} x primitives"
        )
    print(f"ours and the primitives give the same joint rates to {gap:.0e} rad/s")


if __name__ == "__main__":
    main()

"""Postures -> poses and Jacobians of an arm's tool by a product of exponentials.

After Ozgur and Mezouar 2016: dual quaternions along the whole chain, no link frames. The screws are
those of the arm at q = 0.
"""

from functools import cached_property

import numpy as np
from typing_extensions import override

from dqpaint.dq import Floats
from dqpaint.robots.kinematics.kinematics import Kinematics
from dqpaint.robots.model.card import Card
from dqpaint.robots.model.screws import Screws
from dqpaint.robots.model.task import POSE, Task


class ScrewKinematics(Kinematics):
    """`Kinematics` whose poses and Jacobians are products of exponentials of dual quaternions."""

    @cached_property
    def _chain(self) -> Screws:
        home, axes = super().pose_and_jacobian(np.zeros(self.card.joints))
        return Screws(axes.T, home)

    @override
    def pose(self, posture: Floats) -> Floats:
        return self._chain.pose(posture)

    @override
    def pose_and_jacobian(self, posture: Floats) -> tuple[Floats, Floats]:
        return self._chain.pose_and_jacobian(posture)

    @override
    def screws(self) -> Screws:
        return self._chain


def make_kinematics(card: Card, method: str = "pinocchio", task: Task = POSE) -> Kinematics:
    """The kinematics of a card, for a task, by a method: `pinocchio`, or `screws`."""
    return ScrewKinematics(card, task) if method == "screws" else Kinematics(card, task)

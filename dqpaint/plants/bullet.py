"""The only door to pybullet. It prints a build line when imported: standard output is not its."""

import os
import sys
from typing import Any


def _import_quietly() -> Any:
    sys.stdout.flush()
    kept = os.dup(1)
    nothing = os.open(os.devnull, os.O_WRONLY)
    try:
        os.dup2(nothing, 1)
        import pybullet
    finally:
        os.dup2(kept, 1)
        os.close(kept)
        os.close(nothing)
    return pybullet


bullet: Any = _import_quietly()


def joint_indices(body: int, client: int) -> list[int]:
    """The joints of a body that move, in the order of the chain."""
    infos = (
        bullet.getJointInfo(body, i, physicsClientId=client)
        for i in range(bullet.getNumJoints(body, physicsClientId=client))
    )
    return [info[0] for info in infos if info[2] != bullet.JOINT_FIXED]

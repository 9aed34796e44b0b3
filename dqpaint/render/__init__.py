"""Postures, lamps and a camera -> linear light of arm and floor, and occlusion by the arm.

    Arm -measure-> Surfaces -photograph-> linear light of arm and floor, lit by Lamps
    Arm -> copies for ray casting -visible-> the share of each lamp's light that reaches the camera

In come plain arrays; nothing here is loaded unless the arm is to be seen or to hide light.
`scene_arm` is the entry: one arm with the postures of one run.
"""

import importlib
from typing import TYPE_CHECKING, Any

from dqpaint.render.scene_arm import (
    ArmMotion, HiddenLight, SceneArm, hidden_by_line, scene_arm_of_run,
)

if TYPE_CHECKING:
    from dqpaint.render.arm_meshes import arm_view

__all__ = ["ArmMotion", "HiddenLight", "SceneArm", "arm_view", "hidden_by_line",
           "scene_arm_of_run"]


def __getattr__(name: str) -> Any:
    """Import on first use: most pictures need no meshes."""
    if name == "arm_view":
        return importlib.import_module("dqpaint.render.arm_meshes").arm_view
    raise AttributeError(f"module 'dqpaint.render' has no attribute '{name}'")

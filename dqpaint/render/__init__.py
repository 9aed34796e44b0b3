"""Postures, lamps and a camera -> linear light of arm and floor, and occlusion by the arm.

    Arm -measure-> Surfaces -photograph-> linear light of arm and floor, lit by Lamps
    Arm -> copies for ray casting -visible-> the share of each lamp's light that reaches the camera

In come plain arrays; nothing here is loaded unless the arm is to be seen or to hide light.
`scene_arm` is the entry: one arm with the postures of one run.
"""

from dqpaint.render.scene_arm import (
    ArmMotion, HiddenLight, SceneArm, hidden_by_line, scene_arm_of_run,
)

__all__ = ["ArmMotion", "HiddenLight", "SceneArm", "hidden_by_line", "scene_arm_of_run"]

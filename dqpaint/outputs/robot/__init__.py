"""A painting -> programs for a real arm: joint trajectory, light cues, checked against its limits.

A new format is a function in a new file of `outputs.formats` under `@for_arm(name, ending)`: a
`Trajectory` in, the text of its file out.
"""

from dqpaint.outputs.robot.trajectory import (
    Trajectory, comment_lines, for_arm, kinematics_of, trajectory_of,
)

__all__ = ["Trajectory", "comment_lines", "for_arm", "kinematics_of", "trajectory_of"]

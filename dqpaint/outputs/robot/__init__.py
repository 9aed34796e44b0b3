"""A painting -> programs for a real arm: joint trajectory, light cues, checked against its limits.

A new format is a function in a new file of this folder under `@FORMATS.add(name)`: a `Trajectory`
in, the ending of its file and its text out.
"""

from dqpaint.outputs.robot.export import files_of
from dqpaint.outputs.robot.trajectory import FORMATS, Trajectory

__all__ = ["FORMATS", "Trajectory", "files_of"]

"""A painting -> programs for a real arm: joint trajectory, light cues, checked against its limits.

A new format is a function in a new file of `outputs.formats` under `@for_arm(name, ending)`: a
`Trajectory` in, the text of its file out; or, with `made_of=moves_of`, the drawing's geometry as
`Moves`, for controllers that have a speed profile of their own.
"""

from dqpaint.outputs.robot.lamp_table import LampTable, lamp_table
from dqpaint.outputs.robot.moves import GEOMETRIC, Move, Moves, moves_of
from dqpaint.outputs.robot.trajectory import (
    Trajectory, comment_lines, for_arm, kinematics_of, program_name, trajectory_of,
)

__all__ = [
    "GEOMETRIC", "LampTable", "Move", "Moves", "Trajectory", "comment_lines", "for_arm",
    "kinematics_of", "lamp_table", "moves_of", "program_name", "trajectory_of",
]

"""A URDF or a card's numbers -> a prepared URDF, its tree and the capsules of its links."""

from dqpaint.robots.urdf.prepare import prepare, urdf_file
from dqpaint.robots.urdf.write import roll_pitch_yaw

__all__ = ["prepare", "roll_pitch_yaw", "urdf_file"]

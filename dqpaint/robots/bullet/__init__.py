"""Access to PyBullet: a private world, and the arm's joints -> their indices in it."""

from dqpaint.robots.bullet.client import Client, bullet, joint_indices, quiet

__all__ = ["Client", "bullet", "joint_indices", "quiet"]

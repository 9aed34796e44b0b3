"""The door to PyBullet: a world of its own, and an arm's joints -> their numbers in it."""

from dqpaint.robots.bullet.client import Client, bullet, joint_indices, quiet

__all__ = ["Client", "bullet", "joint_indices", "quiet"]

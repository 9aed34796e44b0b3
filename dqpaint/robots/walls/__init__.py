"""Walls of a drawing and an arm's postures -> distances, and their rates for joint rates."""

from dqpaint.robots.walls.scene import (
    METRES, RADIANS, WallRows, Walls, WallsOfRun, among_walls, walls_of,
)

__all__ = ["METRES", "RADIANS", "WallRows", "Walls", "WallsOfRun", "among_walls", "walls_of"]

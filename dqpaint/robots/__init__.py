"""A name or a file -> an arm: its card (data), its kinematics, dynamics, limits and shapes.

    model (cards) -> urdf -> bullet -> kinematics -> loading

A new arm is a TOML file in `cards/`, named as it will be called.
"""

__all__ = ["pose_query"]

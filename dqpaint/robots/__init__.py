"""The name or file of an arm -> its card, kinematics, dynamics, limits and shapes.

    model (cards) -> urdf -> kinematics -> walls -> resolvers -> loading

A new arm is a TOML file in `cards/`, named as it will be called.
"""

__all__ = ["pose_query"]

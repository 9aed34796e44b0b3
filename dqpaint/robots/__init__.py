"""Arms: cards (data) and kinematics, the only door to pinocchio.

A new arm is a TOML file in `cards/`, named as it will be called.
"""

"""A compiled drawing -> plain data: `Program` with its segments, curves, times and light.

A new kind of path brings its record in `program` and its geometry in `motion.geometry`.
"""

import importlib
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from dqpaint.program import colours, piece_corners, piecewise, taylor, walls
    from dqpaint.program.piecewise import (
        NODES, WEIGHTS, Indices, concatenate, derivatives, is_nonuniform, parameters_at,
        stretch_lengths,
    )
    from dqpaint.program.program import (
        IDENTITY, LOOK_MODES, SMOOTH, STANDING, Arc, AutoPlacement, Brush, BrushValue, Colour,
        ContinuousStroke, CruiseSpeed, Curve, Duration, Dwell, FixedOrientation, FollowHeading,
        Formula, Light, Look, LookLine, Path, Photo, PiecewiseCurve, Pose, Profile, Program,
        Quaternion, Samples, Screw, ScrewTo, Segment, SlerpOrientation, Step, Straight, Strobe,
        Timing, Tool, Vector,
    )
    from dqpaint.program.taylor import Floats, Taylor, Value
    from dqpaint.program.walls import Wall

__all__ = [
    "IDENTITY", "LOOK_MODES", "NODES", "SMOOTH", "STANDING", "WEIGHTS", "Arc", "AutoPlacement",
    "Brush", "BrushValue", "Colour", "ContinuousStroke", "CruiseSpeed", "Curve", "Duration",
    "Dwell", "FixedOrientation", "Floats", "FollowHeading", "Formula", "Indices", "Light", "Look",
    "LookLine", "Path", "Photo", "PiecewiseCurve", "Pose", "Profile", "Program", "Quaternion",
    "Samples", "Screw", "ScrewTo", "Segment", "SlerpOrientation", "Step", "Straight", "Strobe",
    "Taylor", "Timing", "Tool", "Value", "Vector", "Wall", "colours", "concatenate", "derivatives",
    "is_nonuniform", "parameters_at", "piece_corners", "piecewise", "stretch_lengths", "taylor",
    "walls",
]

_MODULES = ("program", "piecewise", "piece_corners", "taylor", "walls")

if not TYPE_CHECKING:

    def __getattr__(name: str) -> Any:
        """Import on first use: the names of colours are known without the numbers of curves."""
        if name in __all__ and name not in (*_MODULES, "colours"):
            for module in map(importlib.import_module, (f"{__name__}.{m}" for m in _MODULES)):
                if hasattr(module, name):
                    return getattr(module, name)
        raise AttributeError(f"module 'dqpaint.program' has no attribute '{name}'")

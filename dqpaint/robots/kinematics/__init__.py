"""A card -> pose, Jacobian, resolved rates, dynamics, limits and distances; door to pinocchio."""

from dqpaint.robots.kinematics.batched import ManyKinematics
from dqpaint.robots.kinematics.collisions import Nearest, Shapes, read_mesh, shapes_of
from dqpaint.robots.kinematics.differential_ik import LENGTH, PULL, THRESHOLD, resolve, to_tool
from dqpaint.robots.kinematics.dynamics import Dynamics
from dqpaint.robots.kinematics.jacobians import drift_acceleration, pose_map
from dqpaint.robots.kinematics.kinematics import Kinematics, manipulability
from dqpaint.robots.kinematics.limits import AT_LIMIT, UNITS, Bounds, Clamp, clamps
from dqpaint.robots.kinematics.nullspace import (
    DEFAULT_NULL,
    OBJECTIVES,
    SecondaryTask,
    make_pull,
    make_wish,
    read_null,
)
from dqpaint.robots.kinematics.small_matrices import inverse, solve
from dqpaint.robots.kinematics.start_posture import (
    ON_THE_WAY,
    NoPosture,
    StartPosture,
    find_start,
    shortfall,
    solve_posture,
    strays,
    to_start,
    waypoints,
)

__all__ = [
    "AT_LIMIT",
    "DEFAULT_NULL",
    "LENGTH",
    "OBJECTIVES",
    "ON_THE_WAY",
    "PULL",
    "THRESHOLD",
    "UNITS",
    "Bounds",
    "Clamp",
    "Dynamics",
    "Kinematics",
    "ManyKinematics",
    "Nearest",
    "NoPosture",
    "SecondaryTask",
    "Shapes",
    "StartPosture",
    "clamps",
    "drift_acceleration",
    "find_start",
    "inverse",
    "make_pull",
    "make_wish",
    "manipulability",
    "pose_map",
    "read_mesh",
    "read_null",
    "resolve",
    "shapes_of",
    "shortfall",
    "solve",
    "solve_posture",
    "strays",
    "to_start",
    "to_tool",
    "waypoints",
]

"""A card -> pose, Jacobian, joint rates, dynamics, limits and distances; imports pinocchio."""

from dqpaint.robots.kinematics.batched import ManyKinematics
from dqpaint.robots.kinematics.collisions import (
    CollisionShapes, LinkCapsule, Nearest, Solid, collision_shapes, read_mesh,
)
from dqpaint.robots.kinematics.differential_ik import (
    CHARACTERISTIC_LENGTH, DAMPING_THRESHOLD, START_GAIN, Damping, damped_force, damped_inverse,
    damped_inverse_times, resolve, resolve_parts, tool_jacobian_map,
)
from dqpaint.robots.kinematics.dynamics import Dynamics
from dqpaint.robots.kinematics.jacobians import drift_acceleration, pose_map
from dqpaint.robots.kinematics.kinematics import Kinematics, manipulability
from dqpaint.robots.kinematics.limits import (
    LIMIT_TOLERANCE, UNITS, Clamp, Clipped, RateBounds, find_clamps,
)
from dqpaint.robots.kinematics.model_numbers import ModelNumbers, model_numbers
from dqpaint.robots.kinematics.nullspace import (
    DEFAULT_OBJECTIVE, OBJECTIVES, SecondaryTask, make_batched_task, make_secondary_task, read_null,
)
from dqpaint.robots.kinematics.partial_tasks import resolve_part
from dqpaint.robots.kinematics.screw_kinematics import ScrewKinematics, make_kinematics
from dqpaint.robots.kinematics.small_matrices import inverse, solve
from dqpaint.robots.kinematics.start_posture import (
    PATH_TOLERANCE, NoPosture, StartPosture, find_start, least_errors, return_to_start, shortfall,
    solve_posture, waypoints,
)

__all__ = [
    "CHARACTERISTIC_LENGTH", "DAMPING_THRESHOLD", "DEFAULT_OBJECTIVE",
    "LIMIT_TOLERANCE", "OBJECTIVES", "PATH_TOLERANCE", "START_GAIN", "UNITS", "Clamp",
    "Clipped", "CollisionShapes", "Damping", "Dynamics", "Kinematics", "LinkCapsule",
    "ManyKinematics",
    "ModelNumbers", "Nearest", "NoPosture", "RateBounds", "ScrewKinematics", "SecondaryTask",
    "Solid", "StartPosture", "collision_shapes", "damped_force", "damped_inverse",
    "damped_inverse_times", "drift_acceleration",
    "find_clamps", "find_start", "inverse", "least_errors", "make_batched_task", "make_kinematics",
    "make_secondary_task", "manipulability", "model_numbers", "pose_map",
    "read_mesh", "read_null", "resolve", "resolve_part", "resolve_parts", "return_to_start",
    "shortfall",
    "solve", "solve_posture", "tool_jacobian_map", "waypoints",
]

"""Trajectory -> a ROS 2 message, trajectory_msgs/JointTrajectory, in YAML.

`joint_trajectory_controller` goes between points that have rates along cubics.
"""

from collections.abc import Iterable

from dqpaint.outputs.robot import Trajectory, comment_lines, for_arm

NANO = 1_000_000_000


@for_arm("ros2", "-trajectory.yaml")
def ros2(trajectory: Trajectory) -> str:
    """A trajectory_msgs/JointTrajectory in YAML, positions and velocities."""
    lines = [
        comment_lines((*trajectory.about, "trajectory_msgs/JointTrajectory of ROS 2.")) + "header:",
        "  stamp: {sec: 0, nanosec: 0}",
        f'  frame_id: "{trajectory.base}"',
        "joint_names:",
        *(f'- "{name}"' for name in trajectory.joints),
        "points:",
    ]
    for t, position, velocity in zip(
        trajectory.t.tolist(),
        trajectory.positions.tolist(),
        trajectory.velocities.tolist(),
        strict=True,
    ):
        seconds, nanoseconds = divmod(round(t * NANO), NANO)
        lines += [
            f"- positions: [{_numbers(position)}]",
            f"  velocities: [{_numbers(velocity)}]",
            f"  time_from_start: {{sec: {seconds}, nanosec: {nanoseconds}}}",
        ]
    return "\n".join(lines) + "\n"


def _numbers(values: Iterable[float]) -> str:
    """Fixed point, which YAML takes for numbers; a ten thousandth of a microradian."""
    return ", ".join(f"{value + 0.0:.10f}" for value in values)

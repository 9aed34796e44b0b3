"""Trajectory -> a CSV, one row a point; `draw --recorded` reads it back."""

from dqpaint.outputs.robot import Trajectory, comment_lines, for_arm


@for_arm("trajectory", "-trajectory.csv", export_name="csv")
def trajectory(trajectory: Trajectory) -> str:
    """A CSV: t_s, q1_rad ..., rate1_rad_s ..., with 12 digits."""
    from dqpaint.outputs.tables import encode_csv

    joints = range(len(trajectory.joints))
    names = ", ".join(f"q{i + 1} = {name}" for i, name in enumerate(trajectory.joints))
    columns = {
        "t_s": trajectory.t,
        **{f"q{i + 1}_rad": trajectory.positions[:, i] for i in joints},
        **{f"rate{i + 1}_rad_s": trajectory.velocities[:, i] for i in joints},
    }
    return comment_lines((*trajectory.about, names)) + encode_csv(columns).decode()

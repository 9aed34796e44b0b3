"""The trajectory as a CSV: one row a point; `draw --recorded` reads it back."""

from dqpaint.outputs.files import encode_csv
from dqpaint.outputs.robot.trajectory import FORMATS, ExportFile, Trajectory, commented


@FORMATS.add("csv")
def csv(trajectory: Trajectory) -> ExportFile:
    """A CSV: t_s, q1_rad ..., rate1_rad_s ..., with 12 digits."""
    joints = range(len(trajectory.joints))
    names = ", ".join(f"q{i + 1} = {name}" for i, name in enumerate(trajectory.joints))
    columns = {
        "t_s": trajectory.t,
        **{f"q{i + 1}_rad": trajectory.positions[:, i] for i in joints},
        **{f"rate{i + 1}_rad_s": trajectory.velocities[:, i] for i in joints},
    }
    head = commented((*trajectory.about, names))
    return ExportFile("-trajectory.csv", head + encode_csv(columns).decode())

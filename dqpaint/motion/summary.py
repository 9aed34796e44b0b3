"""Drawing -> one line with its path length, time, samples and box."""

from pathlib import Path

from dqpaint.motion.plan import Motion
from dqpaint.motion.survey import Survey


def summary_line(drawing: Motion | Survey) -> str:
    """Path length, time, samples and box of a drawing."""
    box = " x ".join(f"{round(side * 1e3, 6):.0f}" for side in drawing.box)  # noise is no half
    return (
        f"{Path(drawing.program.name).name}: {drawing.length * 1e3:.0f} mm, "
        f"{drawing.seconds:.2f} s, {drawing.samples - 1} steps of {drawing.period * 1e3:g} ms "
        f"({drawing.samples} poses), box {box} mm"
    )

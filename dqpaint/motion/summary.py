"""Drawing -> one line with its path length, time, samples and box."""

from pathlib import Path

from dqpaint.motion.plan import Motion
from dqpaint.motion.survey import Survey


def summary_line(drawing: Motion | Survey) -> str:
    """Path length, time, samples and box of a drawing, and what the order of its lines saves."""
    box = " x ".join(f"{round(side * 1e3, 6):.0f}" for side in drawing.box)  # noise is no half
    saved = drawing.program.dark_saved
    ordered = f", {saved * 1e3:.0f} mm of dark ways saved by the order" if saved >= 5e-4 else ""
    return (
        f"{Path(drawing.program.name).name}: {drawing.length * 1e3:.0f} mm, "
        f"{drawing.seconds:.2f} s, {drawing.samples - 1} steps of {drawing.period * 1e3:g} ms "
        f"({drawing.samples} poses), box {box} mm{ordered}"
    )

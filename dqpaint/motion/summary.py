"""A drawing's figures in one line, for every command that shows them."""

from pathlib import Path

from dqpaint.motion.plan import Motion


def summary_line(motion: Motion) -> str:
    """Length of the path, time, steps and box."""
    box = " x ".join(f"{side * 1e3:.0f}" for side in motion.box)
    return (
        f"{Path(motion.program.name).name}: {motion.length * 1e3:.0f} mm, {motion.t[-1]:.2f} s, "
        f"{len(motion.t) - 1} steps of {motion.period * 1e3:g} ms ({len(motion.t)} poses), "
        f"box {box} mm"
    )

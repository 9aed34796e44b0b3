"""Trajectory -> a program for a Universal Robots arm: `servoj`, point by point.

servoj takes the posture to be in a given time, which keeps the drawing's clock; movej, movel and
movep have profiles of their own, and the light would come too early or too late.
"""

from typing import TYPE_CHECKING

from dqpaint.errors import UsageError
from dqpaint.outputs.registry import Need
from dqpaint.outputs.robot import (
    Trajectory,
    comment_lines,
    for_arm,
    kinematics_of,
    program_name,
)

if TYPE_CHECKING:
    from dqpaint.painting import paint

JOINTS = ("shoulder_pan", "shoulder_lift", "elbow", "wrist_1", "wrist_2", "wrist_3")
SHORTEST_STEP = 0.002  # [s] of a servoj
LOOKAHEAD = 0.03  # [s], the least: a longer one smooths corners away
GAIN = 300
APPROACH = "a=0.3, v=0.25"  # [rad/s^2, rad/s] to the first posture
END = "  stopj(1.0)\nend\n"


def check_servoj(run: "paint.PreparedRun | paint.Painting") -> None:
    """Refuse an arm that is not one of theirs, and steps that are shorter than servoj's."""
    kinematics = kinematics_of(run)
    if not is_universal(tuple(kinematics.model.names)[1:]):
        raise UsageError(
            f"URScript is for the arms of Universal Robots, not for {kinematics.card.name}; "
            "csv and ros2 are for any arm"
        )
    if run.motion.period < SHORTEST_STEP:
        raise UsageError(
            f"URScript's servoj takes steps of {SHORTEST_STEP * 1e3:g} ms or more, the drawing's "
            f"are {run.motion.period * 1e3:g} ms: write a longer period"
        )


SERVOJ = Need(
    f"an arm of Universal Robots, steps of {SHORTEST_STEP * 1e3:g} ms or more",
    check_servoj,
    before=True,
)


@for_arm("urscript", ".script", SERVOJ)
def urscript(trajectory: Trajectory) -> str:
    """A program for a Universal Robots arm: movej to the first posture, then servoj."""
    name = program_name(trajectory.name)
    notes = ("servoj: joints [rad], a and v unused, time [s], lookahead [s], gain.",)
    step = f"0, 0, {trajectory.period:.9g}, {LOOKAHEAD}, {GAIN}"
    postures = [
        "[" + ", ".join(f"{angle + 0.0:.8f}" for angle in row) + "]"
        for row in trajectory.positions.tolist()
    ]
    lines = [
        f"def {name}():",
        f"  movej({postures[0]}, {APPROACH})",
        '  textmsg("dqpaint: t = 0")  # the light cues count from here',
        *(f"  servoj({posture}, {step})" for posture in postures[1:]),
    ]
    return (
        comment_lines((*trajectory.about, *notes)) + "\n".join(lines) + "\n" + END + f"{name}()\n"
    )


def is_universal(joints: tuple[str, ...]) -> bool:
    """Whether joints are named as those of every Universal Robots arm."""
    return len(joints) == len(JOINTS) and all(
        given.removesuffix("_joint").endswith(own)
        for given, own in zip(joints, JOINTS, strict=True)
    )

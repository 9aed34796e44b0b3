"""Painting -> the files for a real arm, by their endings."""

from dqpaint.errors import UsageError
from dqpaint.outputs.robot.light_cues import cue_sheet
from dqpaint.outputs.robot.limit_check import check_limits
from dqpaint.outputs.robot.trajectory import FORMATS, trajectory_of
from dqpaint.painting import paint
from dqpaint.robots.kinematics import Kinematics
from dqpaint.robots.loading import card_for


def files_of(painting: paint.Painting, form: str) -> dict[str, bytes]:
    """The trajectory of a run in a format, and the cue sheet of its light.

    Raises:
        UsageError: an unknown format, one that the arm does not read, or a recorded run.
        DqpaintError: the run met a limit, or begins or ends suddenly.
    """
    make = FORMATS[form]
    if painting.recording is not None:
        raise UsageError("a recorded run is not exported: it comes from an arm")
    settings = painting.settings
    card = card_for(painting.motion.program, settings.robot, settings.tool)
    kinematics = Kinematics(card)
    trajectory = trajectory_of(painting, kinematics)
    exported = make(trajectory)
    check_limits(painting, kinematics)
    cues = cue_sheet(painting.motion, trajectory.about[:1])
    return {exported.ending: exported.text.encode(), "-cues.csv": cues.encode()}

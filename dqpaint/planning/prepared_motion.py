"""Program, arm and settings -> the motion to follow and the start posture.

Paintings, forecasts and studies all begin here: placement, planning, start posture, retiming.
"""

from collections.abc import Callable
from contextlib import AbstractContextManager, nullcontext
from dataclasses import dataclass

from dqpaint.dq import Floats
from dqpaint.motion import Motion, plan
from dqpaint.planning.corner_limits import CornerPace, within_torques
from dqpaint.planning.occlusion import DEFAULT_SETTINGS
from dqpaint.planning.placement import Placement, place_program
from dqpaint.planning.reachability import reachable_start_posture
from dqpaint.planning.retiming import Motors, Retiming, retime
from dqpaint.planning.set_up import displaced, other_posture
from dqpaint.program import Program
from dqpaint.robots.kinematics import Kinematics
from dqpaint.robots.resolvers import resolver_of
from dqpaint.settings import Settings, read_spread


@dataclass(frozen=True)
class PreparedMotion:
    """The motion that an arm is to follow.

    Attributes:
        program: the drawing, at its place.
        motion: the reference, retimed where it may be.
        start: posture to begin in (n,) [rad].
        placement: where `place auto` put the drawing.
        retiming: how it was slowed down, where it may be.
        corners: the accelerations at corners, where the arm can do less than the drawing allows.
    """

    program: Program
    motion: Motion
    start: Floats
    placement: Placement | None = None
    retiming: Retiming | None = None
    corners: CornerPace | None = None


def prepare_motion(
    program: Program,
    kinematics: Kinematics,
    settings: Settings = DEFAULT_SETTINGS,
    motors: Motors = "sudden",
    stopwatch: Callable[[str], AbstractContextManager[None]] = lambda _name: nullcontext(),
) -> PreparedMotion:
    """Place and plan a drawing for an arm, and find where the arm begins.

    A recorded run has begun already: it is planned alone.

    Args:
        program: the drawing.
        kinematics: of the arm.
        settings: of the run: place, start, null, resolver, on_limit.
        motors: what of their torques counts where the drawing may be slowed down.
        stopwatch: times a stage by its name: place, motion, start.

    Raises:
        ScriptError: the drawing has no place, no timetable, or leaves the arm's reach.
        DqpaintError: the start posture cannot be spread.
    """
    card = kinematics.card
    with stopwatch("place"):
        program, placed = place_program(program, kinematics, settings)
        spread = read_spread(settings.spread if settings.recorded is None else None)
        if spread.place:
            program = displaced(program, card.canvas.pose, spread.place, settings.seed)
    with stopwatch("motion"):
        motion = plan(program, card.canvas.pose)
    if settings.recorded is not None:
        return PreparedMotion(program, motion, card.home, placed)
    with stopwatch("start"):
        best = reachable_start_posture(motion, kinematics, settings.null).posture
        start = card.home if settings.start == "home" else best
        if spread.posture:
            first = None if settings.start == "home" else motion.pose[0]
            start = other_posture(kinematics, start, first, spread.posture, settings.seed)
        resolver = resolver_of(settings, program)
        corners = within_torques(motion, kinematics, start, settings.null, resolver)
        if corners is not None:
            motion, program = corners.motion, corners.motion.program
        if settings.on_limit != "slow":
            return PreparedMotion(program, motion, start, placed, None, corners)
        slowed = retime(motion, kinematics, start, settings.null, motors, resolver)
    return PreparedMotion(program, slowed.motion, start, placed, slowed, corners)

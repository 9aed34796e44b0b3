"""Program -> Motion: the asked pose, twist and acceleration at every sample, in closed form.

`places`, `orientations` and `shapes` say what strokes are (one screw, or place and orientation
apart), `families` takes those of one kind together, `laws` says how they run in time, `lengths` and
`timetable` how long they take, `sampling` gives their rows, `glow` how they shine, `corners` where
the velocity jumps, `plan` puts the samples together, `survey` says what there is to say without
them. A new time law is a function in `laws` under `@LAWS.add` with its `PEAK`, and its name in the
language.
"""

from dqpaint.motion.plan import Motion, plan
from dqpaint.motion.summary import summary_line
from dqpaint.motion.survey import Survey, survey
from dqpaint.motion.time_scaling import Pace, smooth
from dqpaint.motion.transform import moved, scaled, straight

__all__ = [
    "Motion",
    "Pace",
    "Survey",
    "moved",
    "plan",
    "scaled",
    "smooth",
    "straight",
    "summary_line",
    "survey",
]

"""Program -> Motion: reference pose, twist and acceleration at every sample, in closed form.

`geometry` says what strokes are (one screw, or place and orientation apart) and takes those of one
kind together, `profiles` says how they run in time, `schedule` how long they take, `sampling` gives
their rows, `stroke_light` how they shine, `corner_warnings` where the velocity jumps, `plan` puts
the samples together, `survey` says what there is to say without them. A new profile is a function
in `profiles` under `@PROFILES.add` with its `PEAK`, and its name in the language.
"""

from dqpaint.motion.plan import Motion, plan
from dqpaint.motion.row_lines import RowLines
from dqpaint.motion.summary import summary_line
from dqpaint.motion.survey import Survey, survey
from dqpaint.motion.time_scaling import TimeScaling, smooth
from dqpaint.motion.transform import moved, scaled, straight

__all__ = [
    "Motion",
    "RowLines",
    "Survey",
    "TimeScaling",
    "moved",
    "plan",
    "scaled",
    "smooth",
    "straight",
    "summary_line",
    "survey",
]

"""Program -> Motion: reference pose, twist and acceleration at every sample, in closed form.

`geometry` has the shapes of strokes (one screw, or position and orientation apart) in batches of
one kind, `profiles` their progress in time, `schedule` their durations, `sampling` their rows,
`stroke_light` their light, `corner_warnings` the velocity jumps; `plan` joins the samples, `survey`
checks a drawing without all of them. A new profile is a function
in `profiles` under `@PROFILES.add` with its `PEAK`, and its name in the language.
"""

from dqpaint.motion.plan import Motion, plan
from dqpaint.motion.profiles import PROFILES
from dqpaint.motion.row_lines import RowLines
from dqpaint.motion.summary import summary_line
from dqpaint.motion.survey import Survey, survey
from dqpaint.motion.time_scaling import TimeScaling, smooth
from dqpaint.motion.transform import moved, scaled, straight

__all__ = [
    "PROFILES", "Motion", "RowLines", "Survey", "TimeScaling", "moved", "plan", "scaled", "smooth",
    "straight", "summary_line", "survey",
]

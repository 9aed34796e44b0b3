"""Program -> Motion: the asked pose, twist and acceleration at every sample, in closed form.

`shapes` says what each stroke is (one screw, or place and orientation apart), `laws` how it
runs in time, `runs` joins several, `lengths` and `timetable` say how long it takes, `glow` how it
shines, `corners` where the velocity jumps, `plan` puts the samples together. A new
time law is a function in `laws` under `@LAWS.add` with its `PEAK`, and its name in the language.
"""

from dqpaint.motion.plan import Motion, plan
from dqpaint.motion.summary import summary_line

__all__ = ["Motion", "plan", "summary_line"]

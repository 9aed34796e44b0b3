"""Program -> Motion: the asked pose, twist and acceleration at every sample, in closed form.

`shapes` says what each stroke is (one screw, or place and orientation apart), `laws` how it
runs in time, `lengths` and `timetable` how long it takes, `plan` puts the samples together. A new
time law is a function in `laws` under `@LAWS.add`, and its name in the language's words.
"""

from dqpaint.motion.plan import Motion, plan

__all__ = ["Motion", "plan"]

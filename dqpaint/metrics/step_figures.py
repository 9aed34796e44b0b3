"""A run with steps of its set point -> the figures that steps are compared by.

Of several steps each figure is that of the worst. A run that never settles has no settling time: a
table says of how many runs it is.
"""

from typing import Any

from dqpaint.metrics.registry import Table, figure
from dqpaint.metrics.step_response import PartResponse, step_responses
from dqpaint.simulation import Track

WORST = "; of several steps, of the worst"


def _parts(track: Track, part: str) -> list[PartResponse]:
    """The responses to the steps that have a translation, or a rotation."""
    if not track.motion.jump.any():
        return []
    found = (getattr(one, part) for one in step_responses(track))
    return [one for one in found if one.size]


def _register(name: str, part: str, unit: str, display_unit: str) -> None:
    """Register settling time, overshoot and steady error of positions or orientations."""
    known: dict[str, Any] = {"kind": "step", "listed": True}

    @figure(f"step_{name}_settling_s", "s", f"{name} settling",
            "time from a step until the error stays below 2 % of it; none of a run that never "
            f"settles{WORST}", **known,
            equation='min s, |e(t)| <= 0.02 |e(t_0)| "for all" t >= t_0 + s')  # fmt: skip
    def _settling(track: Track, _table: Table) -> float | None:
        times = [one.settling for one in _parts(track, part)]
        known = [time for time in times if time is not None]
        return max(known) if known and len(known) == len(times) else None

    @figure(f"step_{name}_overshoot", "", f"{name} overshoot",
            f"farthest beyond the set point, along the step, as a part of it{WORST}",
            display_unit="%", **known,
            equation="max(0, -e(t)' e(t_0) / |e(t_0)|^2), t >= t_0")  # fmt: skip
    def _overshoot(track: Track, _table: Table) -> float | None:
        return max((one.overshoot for one in _parts(track, part)), default=None)

    @figure(f"step_{name}_steady_{unit}", unit, f"{name} steady error",
            f"mean error over the last tenth of the time at the set point{WORST}",
            display_unit=display_unit, **known,
            equation='mean(|e|) "over the last tenth"')  # fmt: skip
    def _steady(track: Track, _table: Table) -> float | None:
        return max((one.steady for one in _parts(track, part)), default=None)


_register("position", "translation", "m", "mm")
_register("orientation", "rotation", "rad", "deg")

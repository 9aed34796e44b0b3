"""A text `X,Y,Z` or `X,Y,Z,ROLL,PITCH,YAW` -> the frame of the light on the flange."""

import math
import re

from dqpaint.errors import UsageError
from dqpaint.robots.model.fields import Mount, Three

LENGTHS = {"": 1.0, "m": 1.0, "cm": 0.01, "mm": 0.001}
ANGLES = {"": 1.0, "deg": 1.0, "rad": math.degrees(1)}
FARTHEST_TOOL = 2.0  # [m] from the flange; more is a slip of units
_NUMBER = re.compile(r"([-+]?(?:\d+\.?\d*|\.\d+)(?:[eE][-+]?\d+)?)\s*([a-z]*)", re.ASCII)


def parse_tool(text: str, turn: Three = (0.0, 0.0, 0.0)) -> Mount:
    """Parse the light's frame relative to the link that carries it.

    Plain numbers are metres and degrees, as on a robot's card; each may have a unit of its own
    (m, cm, mm; deg, rad). The angles are roll, pitch and yaw about the link's fixed x, y and z.

    Args:
        text: as it is typed.
        turn: the angles [deg] where only a place is typed: those the arm's tool has anyhow.

    Raises:
        UsageError: anything else, or a light farther off than two metres.
    """
    words = [word.strip() for word in text.split(",")]
    if len(words) not in (3, 6):
        raise UsageError(
            f"tool '{text[:60]}' is not X,Y,Z or X,Y,Z,ROLL,PITCH,YAW, "
            "for example 0,0,80mm,0,0,45deg (plain numbers are m and deg)"
        )
    at = tuple(_value(word, LENGTHS, text) for word in words[:3])
    turned = tuple(_value(word, ANGLES, text) for word in words[3:]) or turn
    if math.hypot(*at) > FARTHEST_TOOL:
        raise UsageError(
            f"tool '{text[:60]}' is {math.hypot(*at):.4g} m from the flange, more than "
            f"{FARTHEST_TOOL:g} m; plain numbers are metres: write 80mm, or 0.08"
        )
    return Mount.model_validate({"at_m": at, "rpy_deg": turned})


def _value(word: str, units: dict[str, float], text: str) -> float:
    found = _NUMBER.fullmatch(word)
    if found is None or found[2] not in units:
        known = ", ".join(unit for unit in units if unit)
        raise UsageError(f"tool '{text[:60]}': '{word}' is not a number, alone or with {known}")
    return float(found[1]) * units[found[2]]

"""A text like `k=1..100` -> the range in which a gain is sought."""

import math
import re
from dataclasses import dataclass

from dqpaint.errors import UsageError

DIGITS = 4  # of a gain: what is tried is what is written
SPAN = re.compile(
    r"(?P<name>[^=]+?)\s*=\s*(?P<low>[^:]+?)\.\.(?P<high>[^:]+?)(:(?P<kind>log|lin))?"
)


@dataclass(frozen=True)
class Range:
    """The values among which a gain is sought, on a logarithmic or a linear scale."""

    name: str
    low: float
    high: float
    log: bool

    def value(self, part: float) -> float:
        """The gain at a part of the range, 0 to 1, in few digits."""
        if self.log:
            found = self.low * (self.high / self.low) ** part
        else:
            found = self.low + part * (self.high - self.low)
        return min(max(float(f"{found:.{DIGITS}g}"), self.low), self.high)

    def part(self, value: float) -> float:
        """The part of the range at which a gain lies."""
        if self.log:
            return math.log(value / self.low) / math.log(self.high / self.low)
        return (value - self.low) / (self.high - self.low)


def parse_range(text: str) -> Range:
    """A range from `NAME=LOW..HIGH[:log|:lin]`; logarithmic where it can be.

    Raises:
        UsageError: anything else.
    """
    found = SPAN.fullmatch(text.strip())
    try:
        low, high = float(found["low"]), float(found["high"])  # type: ignore[index]
    except (TypeError, ValueError):
        low = high = math.nan
    if found is None or not (math.isfinite(low) and math.isfinite(high)):
        raise UsageError(f"'{text}' is not NAME=LOW..HIGH, for example k=1..100")
    if not low < high:
        raise UsageError(f"'{text}': the second end is above the first")
    if found["kind"] == "log" and low <= 0:
        raise UsageError(f"'{text}': both ends of a logarithmic range are above 0")
    return Range(found["name"], low, high, found["kind"] != "lin" and low > 0)

"""Drawings of ten thousand lines, of several kinds."""

import random
from collections.abc import Iterator
from functools import cache

LINES = 10_000


DRAWING = "line to (1.5, 2.5, 3) mm\nline to (2.5, 2.5, 3) mm light red\n" * (LINES // 2)


def walk(rng: random.Random) -> Iterator[tuple[float, float, float]]:
    """Points [mm] of a picture, one not far from the next."""
    at = [0.0, 0.0, 0.0]
    while True:
        for axis, (stride, most) in enumerate(((20, 200), (20, 200), (5, 50))):
            step = rng.uniform(-stride, stride)
            at[axis] += step if abs(at[axis] + step) < most else -step
        yield at[0], at[1], at[2]


LIGHTS = ("red", "blue 40%", "red to blue", "white even", "off")


LINE = "line to ({x:.1f}, {y:.1f}, {z:.1f}) mm"


ARC = "arc radius 40 mm to ({x:.1f}, {y:.1f}) mm left"


MIXED = [
    "move to ({x:.1f}, {y:.1f}) mm",
    ARC,
    "light {light}",
    *[LINE, LINE, LINE],
    "line by ({z:.1f}, 9) mm light red to blue even",
    "hold 50 ms light off",
    "arc centre ({x:.1f}, {y:.1f}) mm angle 120 deg profile constant",
    "line to ({x:.1f}, {y:.1f}) mm in 0.4 s profile cubic(9 mm/s, 9 mm/s)",
]


@cache
def kinds() -> dict[str, str]:
    """Drawings of so many lines, as `dqpaint fmt` leaves them, of several kinds."""
    rng = random.Random(5)
    points = walk(rng)

    def lines(*forms: str, count: int = LINES) -> str:
        made = []
        for i in range(count):
            x, y, z = next(points)
            form = forms[i % len(forms)]
            made.append(form.format(x=x, y=y, z=z, light=rng.choice(LIGHTS)))
        return "\n".join(made) + "\n"

    return {
        "same": DRAWING,
        "lines": lines(LINE),
        "light": lines("line to ({x:.1f}, {y:.1f}) mm light {light}"),
        "rates": "profile cubic(5 mm/s, 5 mm/s)\n" + lines(LINE, count=LINES - 1),
        "stroke": "stroke light white\n" + lines("  " + LINE, count=LINES - 2) + "end\n",
        "mixed": lines(*MIXED),
        "looks": lines("line to ({x:.1f}, {y:.1f}) mm tool look (0, 0, 500) mm"),
        "arcs": "move to (0, 0)\n" + _arcs(LINES - 1),
    }


def _arcs(count: int) -> str:
    points = walk(random.Random(6))
    made = (ARC.format(x=x, y=y) for _, (x, y, _) in zip(range(count), points, strict=False))
    return "\n".join(made) + "\n"

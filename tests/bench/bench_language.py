"""10,000 canonical lines against Python's own compiler: `python tests/bench/bench_language.py`.

First reading alone, then `dqpaint check` as a process of its own, for several kinds of lines. Both
read as many lines of the same numbers; rounds are interleaved, as the clock of a shared machine
swings, and times are those of the processor. The target for a whole check is less than a second on
two cores. With the environment variable PYTHONDONTWRITEBYTECODE every start compiles anew.
"""

import os
import random
import statistics
import subprocess
import sys
import tempfile
from collections.abc import Iterator
from functools import cache
from pathlib import Path

from dqpaint.language import parse

LINES = 10_000
DRAWING = "line to (1.5, 2.5, 3) mm\nline to (2.5, 2.5, 3) mm light red\n" * (LINES // 2)
PYTHON = "line(to=(1.5, 2.5, 3))\nline(to=(2.5, 2.5, 3), light='red')\n" * (LINES // 2)


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


def check(path: Path) -> None:
    """A whole process."""
    command = [sys.executable, "-m", "dqpaint", "check", str(path)]
    subprocess.run(command, check=True, stdout=subprocess.DEVNULL)


def processor() -> float:
    """Of this process and its children [s]."""
    return sum(os.times()[:4])


def rounds_of(works: dict, rounds: int) -> None:
    """Medians, and how often they hold that of Python."""
    times: dict[str, list[float]] = {name: [] for name in works}
    for _ in range(rounds):
        for name, work in works.items():
            begin = processor()
            work()
            times[name].append(processor() - begin)
    medians = {name: statistics.median(values) for name, values in times.items()}
    for name, middle in medians.items():
        print(f"{name:12} {middle:.3f} s   {middle / medians['python']:.2f} x python")


def main() -> None:
    rounds = int(sys.argv[1]) if len(sys.argv) > 1 else 9
    floor = {"python": lambda: compile(PYTHON, "bench.py", "exec")}
    with tempfile.TemporaryDirectory() as folder:
        checks = {}
        for name, text in kinds().items():
            path = Path(folder, f"{name}.traj")
            path.write_text(text, encoding="utf-8")
            checks[f"check {name}"] = lambda path=path: check(path)
        rounds_of({"read": lambda: parse(DRAWING, "bench.traj"), **floor, **checks}, rounds)


if __name__ == "__main__":
    main()

"""10,000 canonical lines against Python's own compiler: `python -m tests.bench.bench_language`.

First reading alone, then `dqpaint check` as a process of its own, for several kinds of lines. Both
read as many lines of the same numbers; rounds are interleaved, as the clock of a shared machine
swings, and times are those of the processor. The target for a whole check is less than a second on
two cores; two large SVG drawings follow. With the environment variable PYTHONDONTWRITEBYTECODE
every start compiles anew.
"""

import os
import statistics
import subprocess
import sys
import tempfile
from pathlib import Path

from dqpaint.language import parse
from tests.support.many_lines import DRAWING, LINES, kinds
from tests.support.svg import curves, dots, drawing_of

PYTHON = "line(to=(1.5, 2.5, 3))\nline(to=(2.5, 2.5, 3), light='red')\n" * (LINES // 2)


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
        for name, shapes in {"dots": dots(20_000), "curves": curves(60_000)}.items():
            Path(folder, f"{name}.svg").write_text(drawing_of(shapes))
            path = Path(folder, f"svg-{name}.traj")
            path.write_text(f'svg "{name}.svg" height 200 mm speed 4 m/s\n')
            checks[f"check svg {name}"] = lambda path=path: check(path)
        rounds_of({"read": lambda: parse(DRAWING, "bench.traj"), **floor, **checks}, rounds)


if __name__ == "__main__":
    main()

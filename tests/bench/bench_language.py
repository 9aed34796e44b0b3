"""10,000 canonical lines against Python's own compiler: `python tests/bench/bench_language.py`.

Both read as many lines of the same numbers; rounds are interleaved, as the clock of a shared
machine swings. The target for the language is less than a second on two cores.
"""

import statistics
import sys
import time

from dqpaint.language import parse

LINES = 10_000
DRAWING = "line to (1.5, 2.5, 3) mm\nline to (2.5, 2.5, 3) mm light red\n" * (LINES // 2)
PYTHON = "line(to=(1.5, 2.5, 3))\nline(to=(2.5, 2.5, 3), light='red')\n" * (LINES // 2)


def seconds(work):
    begin = time.process_time()
    work()
    return time.process_time() - begin


def main():
    rounds = int(sys.argv[1]) if len(sys.argv) > 1 else 9
    works = {
        "language": lambda: parse(DRAWING, "bench.traj"),
        "python": lambda: compile(PYTHON, "bench.py", "exec"),
    }
    times = {name: [] for name in works}
    for _ in range(rounds):
        for name, work in works.items():
            times[name].append(seconds(work))
    medians = {name: statistics.median(values) for name, values in times.items()}
    for name, middle in medians.items():
        print(f"{name:9} {middle:.3f} s   {middle / medians['python']:.2f} x python")


if __name__ == "__main__":
    main()

"""A study on all cores by what they allow: `python tests/bench/bench_studies.py [ROUNDS [RUNS]]`.

Cores that share a machine, or each other's units, do not do one core's work each. So a busy loop is
measured alongside: as many processes as cores, each with the work of one. The target is at least
0.9 times that ceiling for a study, the start of its workers included. On a machine that does other
things as well the two are hard to compare; what always tells is the part of their time in which the
workers were at a run, and not started, waiting or idle at the end.
"""

import os
import statistics
import subprocess
import sys
import tempfile
import time
from pathlib import Path

from dqpaint.settings.model import make_settings
from dqpaint.studies.runner.engine import carry_out_study
from dqpaint.studies.runner.process_pool import all_cores
from dqpaint.studies.runner.run import Run, drawing_text, seeded

RUNS = int(sys.argv[2]) if len(sys.argv) > 2 else 48
BUSY = "n = 0\nfor i in range(60_000_000): n += i\n"
NOISE = {"twist": {"form": "noise", "x": 0.01, "y": 0.01, "frequency": 5.0}}


def busy(processes):
    """Seconds that some processes take, each for the same loop."""
    begin = time.perf_counter()
    loops = [subprocess.Popen([sys.executable, "-c", BUSY]) for _ in range(processes)]
    for loop in loops:
        loop.wait()
    return time.perf_counter() - begin


def study(runs, jobs):
    """Seconds that a study takes, and the part of them in which its workers were at a run."""
    with tempfile.TemporaryDirectory() as folder:
        begin = time.perf_counter()
        results = carry_out_study(runs, Path(folder), jobs)
        passed = time.perf_counter() - begin
    return passed, sum(result.wall for result in results) / (jobs * passed)


def main():
    os.environ.pop("PYTHONDONTWRITEBYTECODE", None)  # as for a user
    rounds = int(sys.argv[1]) if len(sys.argv) > 1 else 3
    cores = all_cores()
    settings = make_settings(width=16, height=16, disturb=NOISE)
    runs = seeded(Run(*drawing_text("star"), settings), RUNS)
    study(runs[:cores], cores)  # warms the caches
    parts = []
    for _ in range(rounds):
        ceiling = cores * busy(1) / busy(cores)
        (one, _), (all_, at_work) = study(runs, 1), study(runs, cores)
        parts.append(one / all_ / ceiling)
        print(
            f"{RUNS} runs: {one:.1f} s by one worker, {all_:.1f} s by {cores}: {one / all_:.2f} x; "
            f"busy loops {ceiling:.2f} x; {parts[-1]:.2f} of what the cores allow; "
            f"at a run {at_work:.0%} of the time"
        )
    print(f"median {statistics.median(parts):.2f}; the target is at least 0.9")


if __name__ == "__main__":
    main()

"""A batch against physics, and workers against cores: `python tests/bench/bench_batch.py [ROUNDS]`.

Fifty runs of the thesis's spiral on the ideal arm, as one batch, against as many with physics, in
processor time of interleaved rounds; the target is 20 times. Then a study of physics runs by one
worker and by one a core, against a loop that does nothing but count, started likewise at the same
moments; the target is 0.9 of what that gains.
"""

import os
import statistics
import subprocess
import sys
import tempfile
import time
from pathlib import Path

from dqpaint.settings.model import make_settings
from dqpaint.studies.replay.papers import read_paper
from dqpaint.studies.runner.batches import carry_out_batch
from dqpaint.studies.runner.engine import carry_out_study
from dqpaint.studies.runner.process_pool import ONE_THREAD, all_cores
from dqpaint.studies.runner.run import Run, drawing_text, seeded
from dqpaint.studies.runner.worker import carry_out

RUNS = 50
OF_PHYSICS = 3  # of these as many are timed a round
COUNT = "n = 0\nwhile n < 40_000_000: n += 1\n"


def runs(controller, plant, count):
    settings = read_paper("thesis-spiral").settings
    name, text = drawing_text("spiral")
    chosen = make_settings(controller=controller, plant=plant, width=16, height=16, **settings)
    return seeded(Run(name, text, chosen), count)


def keyed(these):
    return [(str(run.settings.seed), run) for run in these]


def spent(work):
    begin = time.process_time()
    work()
    return time.process_time() - begin


def passed(work):
    begin = time.perf_counter()
    work()
    return time.perf_counter() - begin


def batch_against_physics(rounds, folder):
    for law in ("p", "hinf", "lqr8"):
        ratios = []
        for _ in range(rounds):
            batch = spent(lambda law=law: carry_out_batch(keyed(runs(law, "ideal", RUNS)), folder))
            some = keyed(runs(law, "stiff", OF_PHYSICS))
            physics = spent(lambda some=some: [carry_out(run, key, folder) for key, run in some])
            ratios.append(physics / OF_PHYSICS * RUNS / batch)
        middle = statistics.median(ratios)
        print(f"{law:6} {RUNS} runs: physics costs {middle:.1f} times the batch")


def counting(processes):
    command = [sys.executable, "-S", "-c", COUNT]
    for one in [subprocess.Popen(command) for _ in range(processes)]:
        one.wait()


def workers_against_cores(rounds):
    cores = all_cores()
    gained, possible = [], []
    for _ in range(rounds):
        one, many = passed(lambda: counting(1)), passed(lambda: counting(cores))
        possible.append(cores * one / many)
        times = []
        for jobs in (1, cores):
            with tempfile.TemporaryDirectory() as folder:
                these = runs("hinf", "stiff", 8 * cores)
                times.append(
                    passed(lambda j=jobs, f=folder, r=these: carry_out_study(r, Path(f), j))
                )
        gained.append(times[0] / times[1])
    study, ceiling = statistics.median(gained), statistics.median(possible)
    print(f"{cores} workers: {study:.2f} times one; counting {ceiling:.2f} times: "
          f"{study / ceiling:.2f} of what the cores allow")  # fmt: skip


def main():
    if os.environ.get(ONE_THREAD[0]) != "1":  # as in the workers; numpy looks when it is imported
        os.environ.update(dict.fromkeys(ONE_THREAD, "1"))
        os.execv(sys.executable, [sys.executable, *sys.argv])
    rounds = int(sys.argv[1]) if len(sys.argv) > 1 else 5
    with tempfile.TemporaryDirectory() as folder:
        batch_against_physics(rounds, Path(folder))
    workers_against_cores(rounds)


if __name__ == "__main__":
    main()

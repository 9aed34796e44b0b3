"""Figures of known truth -> what the tests and intervals of studies make of them, as a table.

`python -m tests.tools.truth` draws 10,000 studies whose means are known, has the very functions
that studies use test them, and counts: how often an interval holds the truth, how often a test sees
what is not there, and how often it sees what is.

The last rows have the numbers of a study met in use: on the compliant arm `hinf` erred 22 %
less than `p`, by three seeds each, and a paired test had p = 0.013, Welch's 0.019. It was one of 66
pairs of 12 cells, 15 of them on that arm.
"""

import argparse
from itertools import combinations

import numpy as np

from dqpaint.studies.experiment.statistics import (
    LEVEL,
    holm,
    paired_t,
    spread,
    welch,
    wilcoxon,
)

TRIALS = 10_000
RUNS = 5
LAWS = 6
SEEDS, GAIN = 3, 0.22
SEED_SPREAD, OWN_SPREAD = 0.044, 0.031  # which give these chances
FAMILIES = {"alone": 1, "among 5, with a baseline": 5, "among the 15 of its plant": 15,
            "among all 66 pairs": 66}  # fmt: skip


def measure(trials: int = TRIALS, seed: int = 1) -> dict[str, float]:
    """Shares of the trials, by what they are the shares of."""
    rng = np.random.default_rng(seed)
    return {**coverage(rng, trials), **false_alarms(rng, trials), **power(rng, trials)}


def coverage(rng, trials):
    """How often 95 % intervals hold the truth: of means, differences and effect sizes."""
    held = {}
    for _ in range(trials):
        common = rng.normal(0, 1.0, RUNS)  # of a seed, the same for both
        one, other = 3 + common + rng.normal(0, 0.5, (2, RUNS)) + np.array([[0.7], [0]])
        pair = paired_t(one, other)
        apart = welch(spread(rng.normal(3, 0.3, 4)), spread(rng.normal(2, 1.5, 9)))
        ranked = wilcoxon(*(rng.normal(1, 1, (2, 10)) + np.array([[0.5], [0]])))
        for name, ends, true in (
            ("mean", spread(other).interval, 3.0),
            ("paired difference", pair.interval, 0.7),
            ("difference of unequal spreads", apart.interval, 1.0),
            ("paired effect size d_z", pair.effect_interval, 0.7 / 0.5**0.5),
            ("difference by ranks, 10 pairs (at least 95 %)", ranked.interval, 0.5),
        ):
            held.setdefault(f"coverage: {name}", []).append(ends[0] <= true <= ends[1])
    return {name: float(np.mean(row)) for name, row in held.items()}


def false_alarms(rng, trials):
    """How often anything at all is called a difference where there is none."""
    found = {}
    for _ in range(trials):
        runs = rng.normal(0, 1, RUNS) + rng.normal(0, 0.5, (LAWS, RUNS)) + 3  # six laws, all alike
        tests = [paired_t(a, b).p for a, b in combinations(runs, 2)]
        apart = [
            welch(spread(a), spread(b)).p
            for a, b in combinations(rng.normal(3, 1, (LAWS, RUNS)), 2)
        ]
        for name, chances in (
            (f"family-wise error: {LAWS} laws, {len(tests)} paired tests", holm(tests)),
            (f"family-wise error: {LAWS} laws, {len(apart)} Welch tests", holm(apart)),
            (f"the same {len(tests)} paired tests, uncorrected", tests),
        ):
            found.setdefault(name, []).append(min(chances) < LEVEL)
    return {name: float(np.mean(row)) for name, row in found.items()}


def power(rng, trials):
    """How often a difference is shown, if all others of its family are harder to show."""
    found = {}
    for _ in range(trials):
        common = 1 + rng.normal(0, SEED_SPREAD, SEEDS)
        p, hinf = common + rng.normal(0, OWN_SPREAD, (2, SEEDS))
        hinf *= 1 - GAIN
        pair, apart = paired_t(hinf, p).p, welch(spread(hinf), spread(p)).p
        for kind, chance in (("paired", pair), ("Welch", apart)):
            for name, count in FAMILIES.items():
                found.setdefault(f"22 % by three seeds is shown: {kind}, {name}", []).append(
                    count * chance < LEVEL
                )
    return {name: float(np.mean(row)) for name, row in found.items()}


def main():
    """Print the table."""
    asked = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    asked.add_argument("--trials", type=int, default=TRIALS)
    asked.add_argument("--seed", type=int, default=1)
    given = asked.parse_args()
    print(f"| of {given.trials:,} studies of known truth | share |\n|---|---|")
    for name, share in measure(given.trials, given.seed).items():
        print(f"| {name} | {share:.2%} |")


if __name__ == "__main__":
    main()

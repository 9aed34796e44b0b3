"""Chosen pairs, families and what is left out, against tests made by hand from the same numbers."""

from dataclasses import replace

import numpy as np
import pytest
from scipy import stats

from dqpaint.errors import UsageError
from dqpaint.settings import Settings
from dqpaint.studies.experiment import comparisons
from dqpaint.studies.experiment.axes import Axis
from dqpaint.studies.experiment.cells import Cell, find_figure
from dqpaint.studies.experiment.runs_table import columns
from dqpaint.studies.runner.run import Result, Run

AXES = [Axis("controller", ("hinf", "p", "p(k=5,c=2)")), Axis("plant", ("ideal", "stiff"))]
NAME = "position_error_rms_m"
LINE = "line to (100, 0) mm\n"


@pytest.fixture
def cells(rng):
    """Two laws more apart on one plant than on the other, four seeds each, in metres."""
    common = rng.normal(0, 2e-4, 4)

    def cell(law, plant, mean):
        values = mean + common + rng.normal(0, 1e-4, 4)
        runs = tuple(
            Run("x.traj", LINE, Settings(controller=law.split("(")[0], plant=plant, seed=seed))
            for seed in (3, 4, 5, 6)
        )
        done = tuple(Result(str(i), "done", figures={NAME: v}) for i, v in enumerate(values))
        return Cell({"controller": law, "plant": plant}, done, runs)

    laws = (("hinf", 1e-3), ("p", 2e-3), ("p(k=5,c=2)", 3e-3))
    return [cell(law, plant, mean) for law, mean in laws for plant in ("ideal", "stiff")]


def values(cell):
    return 1e3 * np.array([result.figures[NAME] for result in cell.results])


def test_families_are_kept_apart_and_corrected_each_for_itself(cells):
    lines = comparisons.differences(cells, find_figure(NAME, cells))
    assert [line.family for line in lines] == ["ideal"] * 3 + ["stiff"] * 3
    for start in (0, 3):
        members = cells[start // 3 :: 2]
        raw = [
            stats.ttest_rel(values(members[j]), values(members[i])).pvalue
            for i, j in ((0, 1), (0, 2), (1, 2))
        ]
        found = [line.p for line in lines[start : start + 3]]
        assert min(found) == pytest.approx(3 * min(raw))
        assert max(found) >= max(raw) * (1 - 1e-12)


def test_pairs_are_those_that_are_named(cells):
    figure = find_figure(NAME, cells)
    chosen = comparisons.choose(AXES, None, "p:hinf, p(k=5,c=2):p")
    lines = comparisons.differences(cells, figure, chosen)
    assert [line.names for line in lines] == [("p", "hinf"), ("p(k=5,c=2)", "p")] * 2
    known = stats.ttest_rel(values(cells[0]), values(cells[2]))
    assert lines[0].test.difference == pytest.approx((values(cells[0]) - values(cells[2])).mean())
    assert lines[0].test.p == pytest.approx(known.pvalue)
    chosen = comparisons.choose(AXES, "stiff", None)
    lines = comparisons.differences(cells, figure, chosen)
    assert [line.names for line in lines] == [("stiff", "ideal")] * 3
    assert [line.family for line in lines] == ["hinf", "p", "p(k=5,c=2)"]
    ranked = comparisons.choose(AXES, "p", None, "wilcoxon")
    line = comparisons.differences(cells, figure, ranked)[0]
    assert line.test.p == stats.wilcoxon(values(cells[0]), values(cells[2])).pvalue


@pytest.mark.parametrize(
    ("baseline", "pairs", "said"),
    [
        ("pff", None, "hinf, p"), (None, "hinf:pff", "A:B"), (None, "hinf:stiff", "A:B"),
        (None, "hinf:p,ideal:stiff", "one thing"), ("p", "hinf:p", "not both"),
        (None, "p:p", "A:B"), (None, "", "A:B"),
    ],
)  # fmt: skip
def test_pairs_that_are_none_are_told(baseline, pairs, said):
    with pytest.raises(UsageError, match=said):
        comparisons.choose(AXES, baseline, pairs)


def test_what_is_no_result_is_left_out_and_said(cells):
    one, other = cells[0], cells[2]
    lost = (Result("x", "oscillates", "it rings", {NAME: 9.0}), *one.results[1:])
    found = [Cell(one.choice, lost, one.runs), other]
    (line,) = comparisons.differences(found, find_figure(NAME, found))
    assert (line.paired, line.left_out, len(line.values[0])) == (True, 2, 3)
    known = stats.ttest_rel(values(other)[1:], values(one)[1:])
    assert line.test.p == pytest.approx(known.pvalue)
    assert "2 runs left out" in comparisons.difference_rows([line], "mm")[1][-1]
    assert "left out" in comparisons.about([line], "x")


def test_runs_without_common_seeds_are_not_paired(cells):
    one, other = cells[0], cells[2]
    later = tuple(Run("x.traj", LINE, Settings(controller="p", seed=s)) for s in (7, 8, 9, 10))
    found = [one, Cell(other.choice, other.results, later)]
    (line,) = comparisons.differences(found, find_figure(NAME, found))
    known = stats.ttest_ind(values(other), values(one), equal_var=False)
    assert not line.paired
    assert line.test.p == pytest.approx(known.pvalue)
    assert "Welch" in comparisons.about([line], "x")


def test_runs_that_noise_hardly_reaches_are_not_tested(cells):
    still = tuple(
        Result(str(i), "done", figures={NAME: v}) for i, v in enumerate(1 + 1e-6 * np.arange(4))
    )
    more = tuple(Result(r.key, "done", figures={NAME: 2 * r.figures[NAME]}) for r in still)
    found = [
        Cell(cells[0].choice, still, cells[0].runs),
        Cell(cells[2].choice, more, cells[2].runs),
    ]
    (line,) = comparisons.differences(found, find_figure(NAME, found))
    assert line.test is None
    assert line.verdict == "not tested: hardly any spread"
    assert "one run written down" in comparisons.about([line], "x")
    alone = [Cell(c.choice, c.results[:1], c.runs[:1]) for c in found]
    assert comparisons.differences(alone, find_figure(NAME, found)) == []


def test_a_difference_of_no_size_is_told_as_such(cells, rng):
    base = 1 + rng.normal(0, 0.1, 4)
    rows = [base, base + 1e-4 + rng.normal(0, 1e-6, 4)]
    found = [
        Cell(c.choice, tuple(Result(str(i), "done", figures={NAME: v}) for i, v in enumerate(row)),
             c.runs)
        for c, row in zip((cells[0], cells[2]), rows, strict=True)
    ]  # fmt: skip
    (line,) = comparisons.differences(found, find_figure(NAME, found))
    assert line.p < 1e-3
    assert line.verdict == "yes, but by less than 0.1%"


def test_the_tidy_table_has_a_row_a_run(cells):
    table = columns(cells)
    assert len(table["seed"]) == 24
    assert table["seed"][:5] == [3, 4, 5, 6, 3]
    assert table["controller"][-1] == "p(k=5,c=2)"
    assert (table["law"][0], table["gains"][-1], table["plant"][4]) == (
        "hinf",
        "k=20 point=tool",
        "stiff",
    )
    assert table["robot"] == ["iiwa"] * 24
    assert table[NAME][0] == cells[0].results[0].figures[NAME]
    assert {len(column) for column in table.values()} == {24}


def test_a_column_of_families_is_there_if_there_are_families(cells):
    figure = find_figure(NAME, cells)
    heads = comparisons.difference_rows(comparisons.differences(cells, figure), "mm")[0]
    alone = [replace(line, family="") for line in comparisons.differences(cells, figure)]
    rows = comparisons.difference_rows(alone, "mm")
    assert heads[0] == "within"
    assert [row[:2] for row in rows[:2]] == [["A", "B"], list(alone[0].names)]


@pytest.mark.parametrize(("pairs", "axis", "count"), [
    ("p:hinf", "controller", 1), ("ideal:stiff", "plant", 1), ("p:hinf,p:hinf", "controller", 1),
])  # fmt: skip
def test_one_pair_is_enough(pairs, axis, count):
    chosen = comparisons.choose(AXES, None, pairs)
    assert (chosen.axis, len(chosen.pairs)) == (axis, count)

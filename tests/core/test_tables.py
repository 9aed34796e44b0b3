"""Rows of cells as text, Markdown and CSV."""

import math

from dqpaint.core import tables

ROWS = [["law", "error"], ["p|q", "1"], ["hinf", "2.5"]]


def test_columns_stand_below_each_other():
    assert tables.align(ROWS) == ["law   error", "p|q   1", "hinf  2.5"]
    assert tables.align([]) == []


def test_a_table_that_is_too_wide_is_turned_round():
    assert tables.fit(ROWS, 11) == tables.align(ROWS)
    assert tables.fit(ROWS, 10) == ["law    p|q  hinf", "error  1    2.5"]


def test_markdown_keeps_bars():
    assert tables.markdown(ROWS).splitlines()[:3] == ["| law | error |", "|---|---|",
                                                      "| p\\|q | 1 |"]  # fmt: skip


def test_csv_has_all_digits_and_nothing_for_nan():
    rows = [["a", "b, c"], [0.1 + 0.2, math.nan], [3, "x"]]
    assert tables.encode_csv(rows) == b'a,"b, c"\n0.30000000000000004,\n3,x\n'

"""The line of the drawing of each row: lines of several files, parts of the rows."""

import numpy as np

from dqpaint.diagnostics import SourceLine
from dqpaint.motion import RowLines

MAIN_9, PETAL_3, PETAL_1 = SourceLine(0, 9), SourceLine(2, 3), SourceLine(2, 1)
SOURCE = RowLines.from_lines([PETAL_3, PETAL_3, MAIN_9, PETAL_1, MAIN_9])


def test_lines_are_in_the_order_of_their_files():
    assert SOURCE.lines == (MAIN_9, PETAL_1, PETAL_3)
    np.testing.assert_array_equal(SOURCE.index, [2, 2, 0, 1, 0])


def test_each_row_has_its_line():
    assert len(SOURCE) == 5
    assert [SOURCE.at(row) for row in range(5)] == [PETAL_3, PETAL_3, MAIN_9, PETAL_1, MAIN_9]
    np.testing.assert_array_equal(SOURCE.file, [2, 2, 0, 2, 0])
    np.testing.assert_array_equal(SOURCE.line, [3, 3, 9, 1, 9])


def test_a_part_of_the_rows_has_the_lines_that_are_present():
    for rows in (slice(0, 3), np.array([0, 2]), np.array([True, False, True, False, False])):
        assert SOURCE[rows].present == [MAIN_9, PETAL_3]
    assert SOURCE.present == [MAIN_9, PETAL_1, PETAL_3]
    assert SOURCE[:0].present == []

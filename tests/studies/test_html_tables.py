"""Tables of a page: bars as long as their numbers, verdicts as what they are, nothing unescaped."""

import re

import pytest

from dqpaint.studies.report.html_tables import LENGTH, table, value_of

HEAD = ["law", "error", "status"]


def drawn(rows, kind):
    made = table([HEAD, *rows], (1,))
    return [float(v) for v in re.findall(kind, made)], made


def test_a_number_is_all_that_a_cell_holds():
    assert value_of("0.876 ± 0.021") == (0.876, 0.021)
    assert value_of("1.2e-05") == (1.2e-5, 0.0)
    assert value_of("-3") == (-3.0, 0.0)
    for word in ("-", "", "nan", "p", "3 mm", "5..7", "1 ± x", "4 x 4 matrix"):
        assert value_of(word) is None, word


def test_bars_are_as_long_as_their_numbers():
    rows = [["p", "3 ± 1", "done"], ["q", "1", "done"], ["r", "-", "failed"], ["s", "0", "done"]]
    lengths, made = drawn(rows, r'<rect y="2" width="([\d.]+)"')
    assert lengths == pytest.approx([0.75 * LENGTH, 0.25 * LENGTH, 0], abs=0.06)
    ends = re.search(r'<path d="M([\d.]+),6H([\d.]+)"/>', made).groups()
    assert [float(end) for end in ends] == pytest.approx([0.5 * LENGTH, LENGTH], abs=0.06)
    assert made.count('<td class="bar">') == 4
    assert made.count("<svg") == 3
    assert '<th colspan="2">error</th>' in made


def test_numbers_far_apart_are_dots_equal_ratios_apart():
    rows = [["p", "0.01", ""], ["q", "1", ""], ["r", "0.1", ""]]
    places, made = drawn(rows, r'cx="([\d.]+)"')
    assert places[1] - places[2] == pytest.approx(places[2] - places[0], abs=0.11)
    assert (places[0], places[1]) == (4, LENGTH - 4)
    assert "<rect" not in made


@pytest.mark.parametrize("numbers", [["-1", "2"], ["0", "0"], ["5", "-"], ["a", "b"]])
def test_what_cannot_be_compared_has_no_bars(numbers):
    _, made = drawn([["p", one, ""] for one in numbers], "x^")
    assert "<svg" not in made


def test_verdicts_are_what_they_are_and_rows_that_went_wrong_too():
    made = table([["claim", "paper", "here"], ["it fails to <b>", "holds: 1 < 2", "fails: 2 > 1"],
                  ["that", "no numbers", "not shown: 1 < 1"]])  # fmt: skip
    assert '<td class="verdict good"><b>holds</b> <span>1 &lt; 2</span></td>' in made
    assert '<td class="verdict wrong"><b>fails</b> <span>2 &gt; 1</span></td>' in made
    assert made.count("verdict open") == 2
    assert "<td>it fails to &lt;b&gt;</td>" in made
    assert "<tr>" in made
    assert "bad" not in made
    rows = [["p", "1", "2 done, 1 oscillates"], ["best", "1", "done"], ["q", "1", "differs: film"]]
    kinds = re.findall(r'<tr class="(\w+)">', table([HEAD, *rows]))
    assert kinds == ["bad", "best", "bad"]


def test_only_tables_of_some_rows_are_sorted():
    rows = [["a", "1", ""], ["b", "2", ""], ["c", "3", ""]]
    assert 'class="sorted"' in table([HEAD, *rows])
    assert 'class="sorted"' not in table([HEAD, *rows[:2]])
    assert 'class="settings"' in table([["", "", ""], *rows])

"""Every message is explained, and the explanations are true."""

import re
from dataclasses import replace
from pathlib import Path

import pytest

import dqpaint
from dqpaint.diagnostics.catalogue import (
    STAGES,
    explanation,
    explanations,
    format_explanation,
    list_explanations,
)
from dqpaint.errors import UsageError
from dqpaint.language import ScriptError, read
from dqpaint.language.writing.formatter import formatted
from dqpaint.planning.check import check

ALL = explanations()
SHOWN = {code: entry for code, entry in ALL.items() if entry.wrong}
CODES = pytest.mark.parametrize("code", [
    pytest.param(code, marks=[pytest.mark.slow] * (entry.stage == "arm"))
    for code, entry in SHOWN.items()
])  # fmt: skip


def laid_down(entry, text, folder):
    """A drawing beside the files of its entry."""
    for name, data in {**entry.files, "a.traj": text}.items():
        (folder / name).write_text(data, "utf-8")
    return folder / "a.traj"


def of_text(path):
    """The codes that reading alone finds."""
    try:
        return [note.code for note in read(path).notes]
    except ScriptError as problem:
        return [note.code for note in problem.diagnostics]


def of_all(path):
    """The codes that `check` finds."""
    result = check(str(path))
    assert not result.fault
    return [finding.code for finding in result.diagnostics]


@CODES
def test_the_wrong_example_leads_to_this_very_message(code, tmp_path):
    """At the stage that is told: what reading the text finds needs neither times nor an arm."""
    path = laid_down(ALL[code], ALL[code].wrong, tmp_path)
    found = of_text(path)
    if ALL[code].stage != "text":
        assert code not in found
        found = of_all(path)
    assert found == [code]


@CODES
def test_the_right_example_leads_to_none(code, tmp_path):
    assert of_all(laid_down(ALL[code], ALL[code].right, tmp_path)) == []
    assert formatted(ALL[code].right) == ALL[code].right + "\n"


def test_every_code_in_use_is_explained_and_no_other():
    folder = Path(dqpaint.__file__).parent
    source = "".join(path.read_text("utf-8") for path in folder.rglob("*.py"))
    assert set(ALL) == set(re.findall(r'"([EW]\d{3})"', source))


def test_entries_are_of_the_house():
    for entry in ALL.values():
        assert entry.stage in STAGES
        assert bool(entry.wrong) == bool(entry.right) == (entry.stage != "other")
        assert entry.title[0].islower() or entry.title[0] in "'"
        assert not entry.title.endswith(".")
        assert entry.says.endswith(".")
        assert max(map(len, entry.says.splitlines())) <= 110
    assert len(ALL) - len(SHOWN) <= len(ALL) / 7  # what no text can show is the exception


def test_told():
    text = format_explanation(explanation("e245"))
    assert text.startswith("E245: an arc through three points that ends where it starts\n\n")
    assert "\n\nwrong:\n\n  arc via (80, 10) mm to (0, 0)\n\nright:\n\n  arc centre" in text
    assert "wrong" not in format_explanation(explanation("E001"))
    beside = replace(explanation("E245"), files={"points.csv": "1,2\n3,4"})
    assert format_explanation(beside).endswith("\n\nand points.csv beside it:\n\n  1,2\n  3,4")
    assert list_explanations().count("\n") + 1 == len(ALL)


@pytest.mark.parametrize(("wrong", "near"), [("E2445", "E244"), ("", ""), ("x" * 999, "")])
def test_unknown_codes(wrong, near):
    with pytest.raises(UsageError, match=f"no message has the code .*{near}.*dqpaint explain$"):
        explanation(wrong)

"""Every message of the catalogue: its code, its words, where its caret stands, what it advises."""

import re
from pathlib import Path

import pytest

from dqpaint import language
from dqpaint.diagnostics.diagnostic import Span, place
from dqpaint.language import render
from tests.support.wrong_drawings import ENTRIES, FILES, LARGE, OF_FILES, found


@pytest.mark.parametrize("entry", ENTRIES, ids=[f"{e[1]}-{e[0][:24]}" for e in ENTRIES])
def test_catalogue(entry: list[str]) -> None:
    source, code, caret, message, label, cure = entry
    text = source.replace("~", "\n")
    path = FILES / "a.traj" if "no file" not in message else None
    (diagnostic,) = (d for d in found(text, path) if d.code != "E140" or code == "E140")
    assert (diagnostic.code, diagnostic.message) == (code, message)
    assert (diagnostic.label, diagnostic.help) == (label, cure)
    if not caret:
        assert diagnostic.span is None
        return
    at, _, words = caret.partition(" ")
    assert diagnostic.span is not None
    line, column = place(text, diagnostic.span.start)
    assert f"{line}:{column}" == at
    assert diagnostic.span.of(text) == words


@pytest.mark.slow
@pytest.mark.parametrize(("text", "expected"), LARGE.items(), ids=[v[0] for v in LARGE.values()])
def test_large(text: str, expected: tuple[str, str]) -> None:
    first = found(text)[0]
    assert first.code == expected[0]
    assert first.message.startswith(expected[1])


def test_catalogue_is_complete() -> None:
    folder = Path(language.__file__).parent
    source = "".join(path.read_text("utf-8") for path in folder.rglob("*.py"))
    codes = set(re.findall(r'"([EW]\d{3})"', source))
    shown = {entry[1] for entry in ENTRIES} | {code for code, _ in LARGE.values()}
    elsewhere = {"E294", "E297", "E299"}  # large files, a missing package: test_tables, _drawings
    assert codes - shown - set(OF_FILES) == {"E999", *elsewhere}


def test_messages_are_of_the_house() -> None:
    for entry in ENTRIES:
        for words in entry[3:]:
            assert not words.endswith(".")
            assert not words[:1].isupper()


def test_rendered() -> None:
    text = "start at (0,0)\n\narc via (80, 10) mm to (0, 0)"
    (diagnostic,) = found(text)
    assert render(diagnostic, "bad3.traj", text) == "\n".join(
        (
            "error[E245]: this arc ends where it starts, so 'via' does not say in which plane"
            " it lies",
            " --> bad3.traj:3:24",
            "  |",
            "3 | arc via (80, 10) mm to (0, 0)",
            "  |                        ^^^^^^ same as the start point",
            "  = help: for a full circle write: arc centre POINT angle 360 deg",
        )
    )


def test_one_pass_finds_all_without_cascades() -> None:
    text = """let r = 3 §
let q = r + 1 mm
line to (q, 0)
lin to (5, 0) mm
arc centre (0, 0) angle 90 deg
line by (0, 0) mm
speed 40
with rotat 3 deg
  line to (5, 0)
end
arc via (5, 5) mm to
repeat i from 1 5
  line to (i*mm, 0)
end
hold 3 min
move to (2, nix) mm
curve (1 mm, t) for t from 0 to 3 mm
line to (1, 1) mm extra
"""
    lines = [place(text, d.span.start)[0] for d in found(text)]
    assert lines == [1, 4, 7, 8, 9, 11, 12, 15, 16, 18]


def test_a_failed_start_is_no_movement() -> None:
    text = "start (0,0)\nperiod 10\nplace at (0,0)\nmove to (1,0) mm\nline by (0,3) mm"
    assert [d.code for d in found(text)] == ["E111", "E218"]


def test_a_mistake_in_a_loop_is_told_once() -> None:
    assert len(found("repeat i from 1 to 9\nline to (i, 0)\nend")) == 1
    assert len(found("repeat 9\nline to (nix, 0)\nline by (2, 0)\nend")) == 2


def test_at_most_twenty_errors() -> None:
    assert len(found("lin\n" * 50)) == 20
    assert len(found("line by (0,0)\n" * 50 + "line by (1,0) mm")) == 20


def test_misspelt_blocks_take_their_end_along() -> None:
    assert [d.code for d in found("repaet 3\nwhile x\nend\nend\nend\nline by (1,0) mm")] == [
        "E120",
        "E121",
        "E131",
    ]


def test_fixes_mend() -> None:
    for text in ("move to (1, 2) mm;", "lin to (0, 1) mm", "line to (0, 0, 70)", "light rde"):
        (diagnostic,) = (d for d in found(text) if d.code != "E140")
        fix = diagnostic.fix
        assert fix is not None
        mended = text[: fix.span.start] + fix.text + text[fix.span.end :]
        assert all(d.code == "E140" for d in found(mended)), mended


def test_internal_error_is_a_message(monkeypatch: pytest.MonkeyPatch) -> None:
    def broken(*_: object) -> None:
        raise RecursionError("too deep")

    monkeypatch.setattr("dqpaint.language.strokes.strokes.draw", broken)
    (diagnostic,) = found("hold 1 s")
    assert diagnostic.code == "E999"
    assert diagnostic.message == "internal error, please report (RecursionError: too deep)"
    assert diagnostic.span == Span(0, 8)

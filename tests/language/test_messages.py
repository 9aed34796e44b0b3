"""Every message of the catalogue: its code, where its caret stands, whether it helps and mends."""

import re
from pathlib import Path

import pytest

from dqpaint import language
from dqpaint.diagnostics.diagnostic import Diagnostic, Span, locate
from dqpaint.language import render
from tests.support.wrong_drawings import ENTRIES, LARGE, OF_FILES, found, only, text_and_path


def stands(diagnostic: Diagnostic, text: str) -> str:
    """Where the caret is and what is there, as the tables write it."""
    if diagnostic.span is None:
        return ""
    at = "{}:{}".format(*locate(text, diagnostic.span.start))
    return f"{at} {diagnostic.span.text_in(text)}"


@pytest.mark.parametrize("entry", ENTRIES, ids=[f"{e[1]}-{e[0][:24]}" for e in ENTRIES])
def test_catalogue(entry: list[str]) -> None:
    diagnostic, (_, code, caret, beside) = only(entry), entry
    assert diagnostic.code == code
    assert stands(diagnostic, text_and_path(entry)[0]) == caret
    assert bool(diagnostic.help) == ("help" in beside)
    assert bool(diagnostic.fix) == ("fix" in beside)


@pytest.mark.parametrize("name", [
    pytest.param(name, marks=[pytest.mark.slow] * (name in ("work", "strokes"))) for name in LARGE
])  # fmt: skip
def test_large(name: str) -> None:
    text, code, at = LARGE[name]
    first = found(text)[0]
    assert first.code == code
    assert stands(first, text).partition(" ")[0] == at


def test_catalogue_is_complete() -> None:
    folder = Path(language.__file__).parent
    source = "".join(path.read_text("utf-8") for path in folder.rglob("*.py"))
    codes = set(re.findall(r'"([EW]\d{3})"', source))
    shown = {entry[1] for entry in ENTRIES} | {code for _, code, _ in LARGE.values()}
    elsewhere = {"E294", "E299"}  # large files: test_tables
    assert codes - shown - {case[0] for case in OF_FILES} == {"E999", *elsewhere}


def test_messages_begin_small_and_have_no_full_stop() -> None:
    for entry in ENTRIES:
        diagnostic = only(entry)
        assert diagnostic.message
        for words in (diagnostic.message, diagnostic.label, diagnostic.help):
            assert not words.endswith(".")
            assert not words[:1].isupper()


def test_rendered() -> None:
    text = "hold 1 s\n\nline to (1, 2)\n"
    span, first = Span(18, 24), Span(0, 4)
    diagnostic = Diagnostic("E999", "so it is", span, "this", "do that", ((first, "see"),))
    assert render(diagnostic, "a.traj", text) == "\n".join(
        (
            "error[E999]: so it is",
            " --> a.traj:3:9",
            "  |",
            "3 | line to (1, 2)",
            "  |         ^^^^^^ this",
            "  = see: a.traj:1:1",
            "  = help: do that",
        )
    )
    bare = Diagnostic("W999", "so it is", None)
    assert render(bare, "a.traj", text) == "warning[W999]: so it is\n --> a.traj"


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
    lines = [locate(text, d.span.start)[0] for d in found(text)]
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
    assert "RecursionError: too deep" in diagnostic.message
    assert diagnostic.span == Span(0, 8)

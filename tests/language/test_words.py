"""The tables of the language agree with what is built on them, and their examples work."""

import shutil
from pathlib import Path

import pytest

from dqpaint.core.examples import examples_folder
from dqpaint.diagnostics.did_you_mean import closest
from dqpaint.language import ScriptError, parse
from dqpaint.language.strokes import strokes
from dqpaint.language.values.functions import TABLE
from dqpaint.language.vocabulary.aliases import FUNCTION_ALIASES, PART_ALIASES, STATEMENT_ALIASES
from dqpaint.language.vocabulary.words import FUNCTIONS, PARTS, PROFILES, SHAPES, STATEMENTS

HERE = str(examples_folder() / "test.traj")  # whose files the examples name


def test_functions() -> None:
    assert set(TABLE) == set(FUNCTIONS) | set(PROFILES)


for name, ends in PROFILES.items():
    assert TABLE[name][1] == bool(ends[-1]) + ends[-1].count(",")


def test_movements_are_drawn() -> None:
    assert {w for w, known in STATEMENTS.items() if known.moves} == set(strokes._DRAW)


def test_parts_are_known() -> None:
    for known in STATEMENTS.values():
        assert set(known.parts) <= set(PARTS)
        assert set(known.many) <= set(known.parts)


@pytest.mark.parametrize("word", [w for w in STATEMENTS if w != "end"])
def test_examples_of_statements(word: str, tmp_path: Path) -> None:
    known = STATEMENTS[word]
    (tmp_path / "f.traj").write_text("line by (5, 0) mm\n")
    start = "" if word in ("traj", "robot", "place", "start", "period") else "start at (0, 9) mm\n"
    end = "\nline by (1, 0) mm\nend" if known.block else ""
    for name in ("orbit.csv", "logo.svg", "astronaut.jpg"):
        shutil.copy(examples_folder() / name, tmp_path)
    text = f"{start}{known.example}{end}\nline by (3, 4) mm"
    here = tmp_path / "a.traj"
    assert parse(text, str(here), here).segments


@pytest.mark.parametrize(
    ("word", "part"),
    [(w, p) for w, known in STATEMENTS.items() for p in known.parts if known.moves],
)
def test_examples_of_parts(word: str, part: str, tmp_path: Path) -> None:
    base = {
        "line": "line by (9, 9) mm",
        "move": "move by (9, 9) mm",
        "arc": "arc centre (0, 0) angle 1 turn",
        "screw": "screw about (0, 0) along z angle 1 turn",
        "curve": "curve polar(9 mm, t) for t from 0 to 1 turn",
        "step": "step to (9, 9) mm",
        "hold": "hold 1 s",
        "text": 'text "A" "B"' + (" height 9 mm" if part != "width" else ""),
        "path": 'path "orbit.csv"' + (" unit mm" if part not in ("height", "width") else ""),
        "svg": 'svg "logo.svg"',
        "photo": 'photo "astronaut.jpg"' + " as hatch" * (part != "as"),
        **{word: STATEMENTS[word].example for word in SHAPES},
    }[word]
    if part == "angle" and "fill" in STATEMENTS[word].parts:
        base += " fill 2 mm"
    if part in ("fill", "angle"):
        base = base.replace('"A" "B"', '"O"')  # which is closed
    if part == "via":
        base = "arc to (-80, 0) mm"
    elif word == "screw" and part in ("to", "tool"):
        base = "screw to (10, 0) mm tool look (0, 0, 5) mm up y"
    elif part == "to" and word == "arc":
        base = "arc via (0, 15) mm"
    elif part == "center":
        base = "arc angle 1 turn"
    elif part in ("radius", "left", "right") and word == "arc":
        base = (
            "arc to (70, 0) mm"
            + " left" * (part == "radius")
            + " radius 20 mm" * (part != "radius")
        )
    elif part == "long":
        base = "arc radius 20 mm to (70, 0) mm right"
    example = "tool keep" if part == "tool" and word != "step" else PARTS[part].example
    line = base if f" {part} " in base else f"{base} {example}"
    here = Path(HERE)
    if word == "svg" and part in ("fill", "angle"):
        here = tmp_path / "a.traj"
        box = '<svg xmlns="http://www.w3.org/2000/svg"><path d="M0 0H9V9Z"/></svg>'
        (tmp_path / "logo.svg").write_text(box)
    assert parse(f"start at (90, 0) mm\n{line}", str(here), here).segments


def test_aliases_lead_to_words() -> None:
    for alias, meant in STATEMENT_ALIASES.items():
        assert alias not in STATEMENTS
        assert meant.split()[0] in STATEMENTS
        assert closest(alias, STATEMENTS, STATEMENT_ALIASES) == meant
    assert set(PART_ALIASES.values()) <= set(PARTS)
    assert set(FUNCTION_ALIASES.values()) <= {*FUNCTIONS, "^"}
    assert not set(FUNCTION_ALIASES) & set(FUNCTIONS)


def test_a_word_that_begins_a_line_names_no_lines_but_a_value():
    with pytest.raises(ScriptError, match="E114"):
        parse("def corner(r)\nline by (r, 0)\nend\ncorner(20 mm)", "a.traj")
    text = "let corner = (50, 9) mm\nlet jump = 2 mm\nline to corner corner jump\ncorner jump"
    (segment,) = parse(f"profile constant\n{text}", "a.traj").segments
    assert segment.jumps
    assert segment.end.position == pytest.approx((0.05, 0.009, 0.0))

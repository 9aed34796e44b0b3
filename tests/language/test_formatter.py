"""One layout: a fixed point of itself, and the same drawing to the last bit."""

import random
import re
from pathlib import Path

import numpy as np
import pytest

from dqpaint.core.examples import example_names, find_drawing
from dqpaint.language import ScriptError, parse
from dqpaint.language.syntax.lexer import lines
from dqpaint.language.vocabulary.words import PARTS, STATEMENTS
from dqpaint.language.writing.formatter import formatted
from dqpaint.motion import plan
from dqpaint.robots.model.card import read_card
from tests.support.drawing_texts import MIXED, SCRAPS

CANVAS = read_card("iiwa").canvas.pose
EXAMPLES = {name: Path(find_drawing(name)).read_text("utf-8") for name in example_names()}
TEXTS = {**EXAMPLES, "mixed": MIXED}
PIECE = re.compile(r'"[^"\n]*"|#[^\n]*|\s+|\w+|°|.')  # of a text, so that blanks stand alone

UGLY = """\ufeff


let   a=-3   mm+ 2*-4mm-(1)  mm   # c\x20\x20
let b = - - 3*a/2mm^ -1+a/mm
curve ( 30mm*sin (t) ,
\t-t*mm, # why

0) for t from -1 to 1turn


repeat i from -1 to   5


 # in
  line  to ( i*mm,2^-2 mm)light red 40 % to "#fff"   speed 4 mm / s
     # last
   end   # done
line by (
1,
 rot( x, 90°)
) mm


"""
FAIR = """\
let a = -3 mm + 2*-4 mm - (1) mm  # c
let b = --3*a/2 mm^-1 + a/mm
curve (30 mm*sin(t),
  -t*mm,  # why

  0) for t from -1 to 1 turn

repeat i from -1 to 5

  # in
  line to (i*mm, 2^-2 mm) light red 40% to "#fff" speed 4 mm/s
  # last
end  # done
line by (
  1,
  rot(x, 90°)
) mm
"""


def words(text):
    return [(token.kind, token.text) for line in lines(text) for token in line.tokens]


def comments(text):
    bare = re.sub(r'"[^"\n]*"', "", text)
    return [found.rstrip() for found in re.findall(r"#[^\n]*", bare)]


def test_the_rules_are_these():
    assert formatted(UGLY) == FAIR


@pytest.mark.parametrize("name", EXAMPLES)
def test_the_examples_are_laid_out(name):
    assert formatted(EXAMPLES[name]) == EXAMPLES[name], f"dqpaint fmt trajectories/{name}.traj"


def shaken(text, chance):
    """The same text with other blanks, empty lines and comments wherever they mean nothing."""
    out, inside = [], 0
    for piece in PIECE.findall(text):
        if piece.isspace() and "\n" in piece:
            blanks = "".join(
                chance.choice(["\n", "\n", "\n \t\n", "\n# shaken  \n"]) for _ in range(2)
            )
            piece = blanks + " " * chance.randint(0, 5)
        elif piece.isspace():
            piece = chance.choice([" ", "\t", "   ", "\u00a0 "])
        inside += (piece == "(") - (piece == ")")
        out.append(piece)
        if piece in "(),=" or (piece in "+*/^" and chance.random() < 0.5):
            out.append(chance.choice(["", " ", "  ", "\n \t" if inside else " "]))
    return "".join(out)


@pytest.mark.parametrize("name", TEXTS)
def test_any_blanks_come_to_the_same_and_stay(name):
    chance = random.Random(name)
    for _ in range(12):
        text = shaken(TEXTS[name], chance)
        made = formatted(text)
        assert formatted(made) == made
        assert words(made) == words(text) == words(TEXTS[name])
        assert comments(made) == comments(text)
        assert not re.search(r"[ \t]\n|\n\n\n|\t|\u00a0", made)


@pytest.mark.parametrize("name", EXAMPLES)
def test_the_motion_is_the_same_to_the_last_bit(name):
    path = find_drawing(name)
    asked = plan(parse(EXAMPLES[name], name, path), CANVAS)
    made = plan(parse(formatted(shaken(EXAMPLES[name], random.Random(7))), name, path), CANVAS)
    for kind in ("t", "pose", "twist", "acceleration", "light", "stroke"):
        assert np.array_equal(getattr(asked, kind), getattr(made, kind)), kind


def test_every_example_of_the_tables_is_laid_out():
    """So the layout knows each word: as a name it would stick to a bracket that follows."""
    for known in STATEMENTS.values():
        if known.word == "end":
            continue
        text = known.example + ("\nend" if known.block else "")
        assert formatted(text) == f"{text}\n"
        for word in known.parts:
            part = f"{known.word} {PARTS[word].example}"
            if part.count("(") == 1 and known.word in ("line", "arc", "screw", "with"):
                tight = part.replace(" (", "(").replace(", ", ",")
                laid = formatted_parts(tight)
                assert laid in (None, part)


def formatted_parts(line):
    """The layout of a line by its first words; None if it needs more to be one."""
    try:
        return formatted(line + ("\nend" if line.startswith("with") else "")).split("\n")[0]
    except ScriptError:
        return None


def test_a_text_that_does_not_parse_is_refused():
    with pytest.raises(ScriptError) as caught:
        formatted("lin to (1, 2) mm\nline to (1, 2 mm\n", "a.traj")
    assert [d.code for d in caught.value.diagnostics] == ["E120", "E103"]
    formatted("line to (nix, 2)")  # its meaning is not asked


@pytest.mark.slow
def test_mutants_are_laid_out_or_refused():
    chance, laid = random.Random(1976), 0
    texts = [PIECE.findall(text) for text in TEXTS.values()]
    for _ in range(1500):
        pieces = list(chance.choice(texts))
        for _ in range(chance.randint(1, 3)):
            i = chance.randrange(len(pieces))
            pieces[i : i + 1] = [chance.choice([*"()+-*/^,=%°#\n", chance.choice(SCRAPS), ""])]
        text = "".join(pieces)
        try:
            made = formatted(text)
        except ScriptError:
            continue
        laid += 1
        assert formatted(made) == made, text
        assert comments(made) == comments(text), text
    assert laid > 60  # `formatted` itself has compared the tokens


def test_nothing_stays_nothing():
    assert formatted("") == formatted(" \n\n") == ""
    assert formatted("# only this") == "# only this\n"

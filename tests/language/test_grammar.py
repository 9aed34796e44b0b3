"""The hand-written parser against a grammar: on mutated lines they accept the same."""

import random
import re
from contextlib import suppress
from pathlib import Path

import pytest
from lark import Lark
from lark.exceptions import LarkError

from dqpaint.brushes import BRUSHES, takes
from dqpaint.diagnostics.collector import DiagnosticCollector, ErrorLimitError
from dqpaint.language.syntax.parser import parse_statements
from dqpaint.language.vocabulary.units import UNITS
from dqpaint.language.vocabulary.words import FREE, RESERVED
from tests.support.drawing_texts import FILES, MIXED, SCRAPS, TOKEN, WHOLE
from tests.support.wrong_drawings import ENTRIES

# What the parser refuses though it is in the grammar.
BEYOND = {
    "E106": "brackets too deep",
    "E111": "a line without to or by",
    "E113": "a part twice",
    "E114": "a name that means something already",
    "E115": "a part that is missing",
    "E118": "another version of the language",
    "E120": "a call of what no line defines",
    "E130": "a block without its end: these are single lines",
    "E131": "an end without its block",
    "E201": "a number too large",
    "E217": "a brightness beyond 100%",
    "E230": "a name twice in one bracket",
    "E264": "a brush that is not there",
    "E265": "a value that the brush does not have",
    "E241": "a time twice",
    "E247": "an arc with centre and end",
    "E248": "parts of two forms",
}


def grammar() -> Lark:
    text = (Path(__file__).parent / "traj.lark").read_text("utf-8")
    text = re.sub(r'"([a-z]+)"', r"/\1(?![A-Za-z0-9_])/", text)
    units = "|".join(sorted(UNITS.keys() - {"°"}, key=len, reverse=True))
    unit = rf"(?:°|(?:{units})(?![A-Za-z0-9_]))"
    not_free = "|".join(sorted({*RESERVED, *UNITS} - {"°"}, key=len, reverse=True))
    others = {*RESERVED, *FREE, "colours"}
    keys = "|".join({key for brush in BRUSHES.values() for key in takes(brush)} - others)
    number = r"((0|[1-9]\d*)(\.\d*)?|\.\d+)([eE][+-]?\d+)?"
    text += rf"""
NAME: /(?!(?:{not_free})(?![A-Za-z0-9_]))[A-Za-z_][A-Za-z0-9_]*/
ANY: /[A-Za-z_][A-Za-z0-9_]*/
KEY.2: /(?:{keys})(?![A-Za-z0-9_])/
ROUND.2: /circle(?![A-Za-z0-9_]|\s*\()/
BOXED.2: /(ellipse|rect)(?![A-Za-z0-9_]|\s*\()/
POINTED.2: /(polygon|star)(?![A-Za-z0-9_]|\s*\()/
CORNER.2: /corner(?![A-Za-z0-9_])/
SHADES.2: /colours(?![A-Za-z0-9_])/
UNIT: /{unit}/
LENGTH: /(mm|cm|m)(?![A-Za-z0-9_])/
NUMBER: /{number}(?:(?={unit})|(?![\w.°]))/
TEXT: /"[^"\n]*"/
FILLED: /"[^"\n]*[^"\s][^"\n]*"/
%ignore /\s+/
%ignore /#[^\n]*/
"""
    return Lark(text, parser="lalr", lexer="contextual")


ORACLE = grammar()


def lark_takes(line: str) -> bool:
    try:
        ORACLE.parse(line)
    except LarkError:
        return False
    return True


def codes(line: str) -> list[str]:
    findings = DiagnosticCollector()
    with suppress(ErrorLimitError):
        parse_statements(line, findings)
    return [diagnostic.code for diagnostic in findings.ordered()]


def agree(line: str) -> bool:
    mine, theirs = codes(line), lark_takes(line)
    if theirs:
        return all(code in BEYOND for code in mine)
    return any(code not in ("E130", "E131") for code in mine)


AUTO = "place auto\nplace auto turned rpy(90 deg, 0 deg, 60 deg)"
LINES = [
    line
    for text in (*FILES, MIXED, WHOLE, AUTO, *(entry[0].replace("~", "\n") for entry in ENTRIES))
    for line in text.split("\n")
    if line.strip() and not line.lstrip().startswith("#")
]


@pytest.mark.parametrize("line", LINES)
def test_lines_of_files_and_of_the_catalogue(line: str) -> None:
    assert agree(line), (codes(line), lark_takes(line))


LATER = r"task|brush \w+ image|star ?\( *\)"
"""What is refused when values are read, and a statement's word before an empty bracket."""


@pytest.mark.slow
def test_mutants() -> None:
    chance = random.Random(19431205)
    differ = []
    taken = 0
    for _ in range(3000):
        words = TOKEN.findall(chance.choice(LINES))
        for _ in range(chance.randint(1, 2)):
            i, scrap = chance.randrange(len(words)), chance.choice(SCRAPS).replace("\n", " ")
            new = chance.choice(([scrap], [words[i], f" {scrap} "], [chance.choice(words)], [" "]))
            words[i : i + 1] = new
        line = "".join(words)
        if re.match(r"\s*(#|end\b|$)", line):  # `end` has no block here
            continue
        if re.fullmatch(LATER, line.strip()):
            continue
        taken += lark_takes(line)
        if not agree(line):
            differ.append((line, codes(line), lark_takes(line)))
    assert taken > 300
    assert not differ, differ[:8]

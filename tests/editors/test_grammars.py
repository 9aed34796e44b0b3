"""Grammars for editors and documents, held to the parser's own tables and tokens."""

import json
import re
from importlib.metadata import entry_points

import pytest

from dqpaint.core.examples import example_names, find_drawing
from dqpaint.editors import textmate
from dqpaint.editors.vocabulary import vocabulary, words
from dqpaint.language.syntax.lexer import lines
from dqpaint.language.vocabulary.units import UNITS
from dqpaint.language.vocabulary.words import (
    CONSTANTS,
    FUNCTIONS,
    LITTLE_WORDS,
    PARTS,
    PROFILES,
    RENAMED,
    STATEMENTS,
)
from dqpaint.program import colours
from tests.support.drawing_texts import MIXED

pygments = pytest.importorskip("pygments")
from pygments.token import Comment, Error, Keyword, Name, Number, String  # noqa: E402

from dqpaint.editors.pygments_lexer import TrajLexer  # noqa: E402

TABLES = {
    "statement": STATEMENTS, "part": PARTS, "word": LITTLE_WORDS, "unit": UNITS,
    "function": FUNCTIONS, "profile": PROFILES, "constant": CONSTANTS, "colour": colours.NAMES,
    "renamed": RENAMED,
}  # fmt: skip
TEXTS = {name: find_drawing(name).read_text("utf-8") for name in example_names()} | {"mixed": MIXED}


def scoped(line):
    """(text, scope) of a line as an editor colours it: the first match from the left."""
    patterns = textmate.grammar()["patterns"]
    at, found = 0, []
    while at < len(line):
        matches = (re.compile(pattern["match"]).search(line, at) for pattern in patterns)
        hits = [(match.start(), i, match) for i, match in enumerate(matches) if match and match[0]]
        if not hits:
            break
        _, i, match = min(hits, key=lambda hit: hit[:2])
        if "name" in patterns[i]:
            found.append((match[0], patterns[i]["name"]))
        for number, scope in patterns[i].get("captures", {}).items():
            if match[int(number)]:
                found.append((match[int(number)], scope["name"]))
        at = match.end()
    return found


@pytest.mark.parametrize("kind", TABLES)
def test_the_vocabulary_is_that_of_the_tables(kind):
    assert set(words(kind)) == set(TABLES[kind])
    assert {entry.kind for entry in vocabulary()} == set(TABLES)
    assert all(entry.meaning and entry.example for entry in vocabulary())


@pytest.mark.parametrize("kind", TABLES)
def test_every_word_is_coloured_by_both_grammars(kind):
    for word in TABLES[kind]:
        line = (
            word if kind == "statement" else f"7 {word}" if kind == "unit" else f"let q = {word} "
        )
        tokens = [(t, v) for t, v in TrajLexer().get_tokens(line) if v == word]
        assert tokens, word
        assert tokens[0][0] is not Name, word
        assert word in [text for text, _ in scoped(line)], word


@pytest.mark.parametrize("name", TEXTS)
def test_pygments_sees_the_tokens_that_the_parser_sees(name):
    text = TEXTS[name]
    ours = [(t.kind, text[t.start : t.end]) for line in lines(text) for t in line.tokens[:-1]]
    theirs = list(TrajLexer().get_tokens(text))
    assert "".join(value for _, value in theirs) == text
    assert not [value for kind, value in theirs if kind is Error]
    assert [v for kind, v in theirs if kind is Keyword] == [n.tokens[0].text for n in lines(text)]
    shown = [(kind, value) for kind, value in theirs if value.strip() and kind not in Comment]
    assert [value for _, value in shown] == [value for _, value in ours]
    for (kind, value), (our_kind, _) in zip(shown, ours, strict=True):
        assert (kind in Number) == (our_kind == "number"), value
        assert (kind in String) == (our_kind == "text"), value
        if our_kind == "name":
            known = value in {entry.word for entry in vocabulary()}
            assert (kind is not Name) == known, value


@pytest.mark.parametrize("name", TEXTS)
def test_textmate_sees_numbers_texts_and_statements(name):
    text = TEXTS[name]
    for line in lines(text):
        first = line.tokens[0]
        start = text.rfind("\n", 0, first.start) + 1
        row = text[start : text.find("\n", start)]
        found = scoped(row)
        assert (first.text, "keyword.control.traj") in found
        tokens = [t for t in line.tokens if t.end <= start + len(row)]
        for kind, scope in (
            ("number", "constant.numeric.traj"),
            ("text", "string.quoted.double.traj"),
        ):
            expected = [text[t.start : t.end] for t in tokens if t.kind == kind]
            assert [value for value, name in found if name == scope] == expected


def test_the_grammar_is_json_and_its_patterns_are_those_of_editors():
    grammar = json.loads(json.dumps(textmate.grammar()))
    assert grammar["scopeName"] == "source.traj"
    for pattern in grammar["patterns"]:
        re.compile(pattern["match"])
        assert "(?P" not in pattern["match"]  # Oniguruma writes named groups otherwise


def test_pygments_finds_the_lexer_by_the_package_s_entry_point():
    pyproject = __import__("tomllib").loads(
        (find_drawing("star").parent.parent / "pyproject.toml").read_text("utf-8")
    )
    target = pyproject["project"]["entry-points"]["pygments.lexers"]["traj"]
    module, _, name = target.partition(":")
    assert getattr(__import__(module, fromlist=[name]), name) is TrajLexer
    for found in entry_points(group="pygments.lexers"):
        if found.name == "traj":
            assert found.value == target

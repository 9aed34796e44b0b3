"""Text -> lines of tokens; an open bracket continues a line, comments are left out."""

import re
import unicodedata
from collections.abc import Iterator
from typing import NamedTuple

from dqpaint.core import record
from dqpaint.diagnostics import Diagnostic, Fix, Span
from dqpaint.language.vocabulary.units import SAME_UNITS, UNITS
from dqpaint.language.vocabulary.words import RENAMED, STATEMENTS


@record
class Token:
    """A word, number, text or sign, with its span."""

    kind: str  # number, name, text, sign; `end` closes every line
    text: str  # of a text: without its quotes
    start: int
    end: int

    @property
    def span(self) -> Span:
        """The span of the token."""
        return Span(self.start, self.end)


class TokenLine(NamedTuple):
    """The tokens of one statement, and the errors in its characters."""

    tokens: list[Token]
    problems: list[Diagnostic]


MOST_TOKENS = 100_000  # of one line
MOST_WRAPPED = 20  # lines of a text whose end is looked for

NUMBER = r"(?:(?:0|[1-9]\d*)(?:\.\d*)?|\.\d+)(?:[eE][+-]?\d+)?"
TOKEN = re.compile(
    rf"""[^\S\n]*(?:
      (?P<name>[A-Za-z_][A-Za-z0-9_]*|°)
    | (?P<number>{NUMBER})(?P<glued>[A-Za-z_°][\w°]*|\.[\d.]*|\d[\d.]*)?
    | (?P<sign>[(),+\-*/^=%])
    | (?P<newline>\n)
    | (?P<comment>\#[^\n]*)
    | (?P<text>"[^"\n]*")
    | (?P<bad>\S)
    | \Z
    )""",
    re.VERBOSE | re.ASCII,
)
_FIRST_WORD = re.compile(r"[^\S\n]*([A-Za-z_]+)(?![A-Za-z0-9_]|[^\S\n]*[,)*/+^])", re.ASCII)

_BLANK = re.compile(r"[^\S\n]*(?:#|$)", re.MULTILINE)  # to the end of a line
# The digits before a comma that was meant as part of a number: 2,000 and 0,05.
_THOUSANDS = re.compile(r"(?<![\w.,])[1-9]\d{0,2}(?:,\d{3})*,$", re.ASCII)
_SPACED = re.compile(r"(?<![\w.,])[1-9]\d{0,2}(?: \d{3})* $", re.ASCII)
_DECIMAL = re.compile(r"(?<![\w.])(\d+),$", re.ASCII)
_LONG_NUMBER = 40
_RANGE = re.compile(r"(\d+(?:\.\d+)?)\.{2,3}(\d+(?:\.\d+)?)", re.ASCII)
_FILE_NAME = re.compile(r"(?:[\w~-]|\.{0,2}[\\/])*$")
_REST_OF_NAME = re.compile(r"\.[\w.~/\\-]+")
_WORD = re.compile(r"\w+")

# Signs that come with copying from elsewhere, and the plain one that is meant.
_LOOKALIKES = {
    "−": "-",
    "–": "-",
    "—": "-",
    "×": "*",
    "·": "*",
    "⋅": "*",
    "∗": "*",
    "÷": "/",
    "∕": "/",
    "“": '"',
    "”": '"',
    "„": '"',
    "«": '"',
    "»": '"',
    "'": '"',
    "‘": '"',
    "’": '"',
    "，": ",",
    "（": "(",
    "）": ")",
    "［": "(",
    "[": "(",
    "]": ")",
    "{": "(",
    "}": ")",
    "º": "°",
}
_QUOTES = "“”„«»'‘’"
_POINTED = re.compile(r"<[^<>\n]*,[^<>\n]*>")
_PART_OF_POINT = re.compile(r"(?<=\w)\.[xyz]\b")
_QUOTED = re.compile(rf"[{_QUOTES}]([^{_QUOTES}\"\n]*)[{_QUOTES}]")
_NAMES_OF_LETTERS = {"π": "pi", "²": "^2", "³": "^3", "√": "sqrt(…)"}


def lines(text: str, begin: int = 0) -> Iterator[TokenLine]:
    """The lines with tokens from an offset on, in order."""
    tokens: list[Token] = []
    problems: list[Diagnostic] = []
    brackets: list[Token] = []
    position, size = begin + text.startswith("\ufeff", begin), len(text)
    match_at = TOKEN.match
    while position < size:
        if len(tokens) > MOST_TOKENS:
            yield _too_long(tokens)
            tokens, problems = [], []
            brackets.clear()
            position = text.find("\n", position) % (size + 1)
            continue
        match = match_at(text, position)
        assert match is not None  # the pattern has an answer to every character
        kind = match.lastgroup
        if kind is None:
            break
        start, position = match.span(kind)
        if kind == "name" or kind == "number":
            tokens.append(Token(kind, text[start:position], start, position))
        elif kind == "sign":
            token = Token("sign", text[start:position], start, position)
            if token.text == "(":
                brackets.append(token)
            elif token.text == ")":
                if not brackets:
                    problems.append(_stray_bracket(token))
                    continue
                brackets.pop()
            tokens.append(token)
        elif kind == "glued":
            number = Token("number", match["number"], *match.span("number"))
            position = _glued(number, match["glued"], tokens, problems, text)
        elif kind == "text":
            tokens.append(Token("text", text[start + 1 : position - 1], start, position))
        elif kind == "bad":
            position = _bad(text, start, tokens, problems, bool(brackets))
        elif kind == "newline" and (not brackets or _begins_statement(text, position)):
            if tokens or problems:
                yield _close(tokens, problems, brackets, start)
                tokens, problems = [], []
            brackets.clear()
    if tokens or problems:
        yield _close(tokens, problems, brackets, size)


def _too_long(tokens: list[Token]) -> TokenLine:
    message = f"this line has more than {MOST_TOKENS:,} words, numbers and signs"
    mistake = Diagnostic("E314", message, tokens[0].span, "begins here", "make several lines of it")
    last = tokens[-1].end
    return TokenLine([*tokens[:2], Token("end", "", last, last)], [mistake])


def _close(
    tokens: list[Token], problems: list[Diagnostic], brackets: list[Token], end: int
) -> TokenLine:
    if brackets:
        problems.append(
            Diagnostic(
                "E103",
                "this '(' is never closed",
                brackets[-1].span,
                "opened here",
                "add ')' before the end of the line",
            )
        )
    end = tokens[-1].end if tokens else end
    tokens.append(Token("end", "", end, end))
    return TokenLine(tokens, problems)


def _begins_statement(text: str, position: int) -> bool:
    """Whether a statement's word comes next, so that a bracket was not closed."""
    match = _FIRST_WORD.match(text, position)
    return match is not None and (match[1] in STATEMENTS or match[1] in RENAMED)


def _stray_bracket(token: Token) -> Diagnostic:
    return Diagnostic(
        "E104",
        "this ')' closes nothing",
        token.span,
        "",
        "take it away, or add '(' before it",
        fix=Fix("take the bracket away", token.span, ""),
    )


def _glued(
    number: Token, letters: str, tokens: list[Token], problems: list[Diagnostic], text: str
) -> int:
    """A number with letters right after it, which must be a unit. Returns the next offset."""
    end = number.end + len(letters)
    tokens.append(number)
    if letters in UNITS:
        tokens.append(Token("name", letters, number.end, end))
        return end
    span, fix = Span(number.start, end), None
    if letters[0].isdigit():
        message, help, fix = _zeros_in_front(span, text)
    elif letters.startswith("."):
        message, help = f"'{span.text_in(text)}' is not a number", "write one decimal point"
        if found := _RANGE.fullmatch(span.text_in(text)):
            written = f"from {found[1]} to {found[2]}"
            help = f"a range is written: {written}"
            if len(tokens) > 1 and tokens[-2].text == "in":
                fix = Fix(f"write {written}", Span(tokens[-2].start, span.end), written)
    elif letters in STATEMENTS or not re.fullmatch(r"[A-Za-z_]\w*", letters, re.ASCII):
        message = f"'{letters}' straight after the number {number.text} is not a unit"
        help = f"put a blank between: {number.text} {letters}"
        fix = Fix("put a blank between", Span(number.end, number.end), " ")
    elif re.fullmatch(r"(_\d+)+", letters, re.ASCII):
        message = f"'{span.text_in(text)}' is not a number"
        help = f"write {number.text}{letters.replace('_', '')}"
        fix = Fix(help, span, help.removeprefix("write "))
    elif letters in SAME_UNITS:
        message = f"'{letters}' straight after the number {number.text} is not a unit"
        help = f"write {number.text} {SAME_UNITS[letters]}"
        fix = Fix(help, span, f"{number.text} {SAME_UNITS[letters]}")
    else:
        message = f"'{letters}' straight after the number {number.text} is not a unit"
        help = f"units are {', '.join(UNITS)}; a product is written {number.text}*{letters}"
    problems.append(Diagnostic("E102", message, span, "", help, fix=fix))
    return end


def _zeros_in_front(span: Span, text: str) -> tuple[str, str, Fix]:
    """The message for `05`, and for `2,000` and `0,05`, which would be several numbers."""
    written = span.text_in(text)
    before = text[max(0, span.start - _LONG_NUMBER) : span.start]
    begin, rule = span.start, ""
    if len(written.partition(".")[0]) == 3 and (found := _THOUSANDS.search(before)):
        begin -= len(found[0])
        number = f"{found[0].replace(',', '')}{written}"
        rule = "commas stand between the numbers of a point; a large one has none: "
    elif len(written) == 3 and (found := _SPACED.search(before)):
        begin -= len(found[0])
        number = f"{found[0].replace(' ', '')}{written}"
        rule = "a large number has no blanks in it: "
    elif found := _DECIMAL.search(before):
        begin -= len(found[0])
        number = f"{found[1]}.{written}"
        rule = "commas stand between the numbers of a point; a decimal has a point: "
    else:
        number = re.sub(r"^0+(?=\d)", "", written)
    fix = Fix(f"write {number}", Span(begin, span.end), number)
    return f"'{written}' is not a number", f"{rule or 'write '}{number}", fix


def _bad(
    text: str, start: int, tokens: list[Token], problems: list[Diagnostic], in_brackets: bool
) -> int:
    """Reports a character outside the language, and returns the next offset."""
    character, end = text[start], start + 1
    if character.isspace():
        return end  # a blank that only Unicode calls one: it comes with copying from elsewhere
    if character == '"':
        return _never_closed(text, start, tokens, problems)
    if character.isalpha():
        end = _whole_word(text, start, tokens)
    if problems:
        return end  # one is enough for a line
    if character in _QUOTES and (closing := _QUOTED.match(text, start)):
        problems.append(_quotes(closing))
        tokens.append(Token("text", closing[1], *closing.span()))
        return closing.end()
    fix = None
    shown = f"'{character}'" if character.isprintable() else f"U+{ord(character):04X}"
    if character in "{}" and not in_brackets and _BLANK.match(text, end):
        help = f"no {character} is needed: a block ends with a line 'end'"
    elif character in _LOOKALIKES:
        plain = _LOOKALIKES[character]
        help = f"write {plain}" if character in "[]{}'" else f"write the plain sign {plain}"
        fix = Fix(help, Span(start, end), plain)
    elif character in _NAMES_OF_LETTERS:
        help = f"write {_NAMES_OF_LETTERS[character]}"
        if "…" not in help:
            fix = Fix(help, Span(start, end), _NAMES_OF_LETTERS[character])
    elif character == ";" and in_brackets:
        help = "the numbers of a point have commas between them"
        fix = Fix("write a comma", Span(start, end), ",")
    elif character == ";" and not tokens:
        help = "a comment begins with #"
    elif character == ";" and not _BLANK.match(text, end):
        help = "a line holds one statement; a comment begins with #"
    elif character == ";":
        help = "no ; is needed: one statement per line"
        fix = Fix("take the ; away", Span(start, end), "")
    elif character == "<" and _POINTED.match(text, start):
        help = "a point stands in round brackets: (10, 0)"
    elif character == "<" and tokens and tokens[0].text == "curve":
        help = "write: for t from 0 to 360 deg"
    elif character in "<>!&|?":
        help = ".traj has no conditions: use repeat, min/max, or write two files"
    elif character == ":":
        help = "no : is needed: a block ends with a line 'end'"
        fix = Fix("take the : away", Span(start, end), "")
    elif character == "/" or text.startswith("//", start):
        help = "a comment begins with #"
    elif character == "." and _PART_OF_POINT.match(text, start):
        help = "a point has no parts with names: give its numbers names, let px = …"
    elif character == ".":
        help, fix = _file_name(text, start)
    elif character.isalpha():
        help, word = "names are made of the letters a to z, digits and _", tokens[-1]
        plain = unicodedata.normalize("NFKD", word.text).encode("ascii", "ignore").decode()
        if len(plain) >= len(word.text) and plain.isidentifier():
            help += f": {plain}"
            fix = Fix(f"write {plain}", word.span, plain)
    elif character.isdecimal():
        help = f"write the plain digit {unicodedata.decimal(character)}"
        fix = Fix(help, Span(start, end), str(unicodedata.decimal(character)))
    else:
        help = "a comment begins with #, a text stands in quotes"
    problems.append(
        Diagnostic(
            "E101", f"unexpected character {shown}", Span(start, start + 1), "", help, fix=fix
        )
    )
    return end


def _file_name(text: str, dot: int) -> tuple[str, Fix | None]:
    """The advice for the name of a file without quotes, by the dot in it."""
    before = _FILE_NAME.search(text, max(0, dot - _LONG_NUMBER), dot)
    after = _REST_OF_NAME.match(text, dot)
    if not before or not after:
        return 'the name of a file stands in quotes: "points.csv"', None
    span = Span(before.start(), after.end())
    written = f'"{span.text_in(text)}"'
    return f"the name of a file stands in quotes: {written}", Fix(f"write {written}", span, written)


def _never_closed(text: str, start: int, tokens: list[Token], problems: list[Diagnostic]) -> int:
    """Reports a text not ended on its line; its end on a later line is no second error."""
    end = text.find("\n", start) % (len(text) + 1)
    words, help = [text[start + 1 : end].rstrip()], 'add " before the end of the line'
    at = end
    while at < len(text) and len(words) < MOST_WRAPPED and not _begins_statement(text, at + 1):
        stop = text.find("\n", at + 1) % (len(text) + 1)
        words.append(text[at + 1 : stop].partition('"')[0].strip())
        if '"' in text[at + 1 : stop]:
            if text.count('"', at + 1, stop) % 2:  # the odd one is its end
                end = text.find('"', at + 1) + 1
                written = " ".join(f'"{line}"' for line in words if line)
                help = f"each line of a text has quotes of its own: {written}"
            break
        at = stop
    opened = Span(start, start + 1)
    problems.append(Diagnostic("E107", "this text is never closed", opened, "opened here", help))
    tokens.append(Token("text", words[0], start, end))
    return end


def _whole_word(text: str, start: int, tokens: list[Token]) -> int:
    """Joins a letter outside the language with its neighbours to one name; returns its end."""
    before = tokens[-1] if tokens else None
    if before and before.kind == "name" and before.end == start and before.text != "°":
        start = tokens.pop().start
    word = _WORD.match(text, start)
    end = word.end() if word else start + 1
    tokens.append(Token("name", text[start:end], start, end))
    return end


def _quotes(found: re.Match[str]) -> Diagnostic:
    """Quotation marks of another kind round a text."""
    message, plain = f"unexpected character '{found[0][0]}'", f'"{found[1]}"'
    fix = Fix(f"write {plain}", Span(*found.span()), plain)
    span = Span(found.start(), found.start() + 1)
    help = f"a text stands in plain double quotes: {plain}"
    return Diagnostic("E101", message, span, "", help, fix=fix)

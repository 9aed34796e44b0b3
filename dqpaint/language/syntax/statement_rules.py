"""Statement -> diagnostics of parts that are missing, doubled or contradict each other."""

import re

from dqpaint.diagnostics import Fix, Problem, Span, locate, problem
from dqpaint.language.syntax import trailing_tokens
from dqpaint.language.syntax.cursor import Cursor
from dqpaint.language.syntax.lexer import Token
from dqpaint.language.syntax.tree import Part, Statement
from dqpaint.language.vocabulary.words import RENAMED, SHAPES, STATEMENTS, TIMES

_FORM_OF_CENTRE = ("axis", "angle", "rise", "grow")
_QUESTION = re.compile(r"did you mean '(\w+)'\?")
_FORM_OF_RADIUS = ("radius", "left", "right", "long")
_FORM_OF_ABOUT = ("along", "angle", "pitch")


def check(statement: Statement, text: str) -> None:
    """Raises a `Problem` if parts are missing, doubled or contradict each other."""
    if len(statement.parts) > 1:
        _once(statement, text)
        _one_time(statement.parts)
    for part in STATEMENTS[statement.word].needs:
        _needs(statement, part)
    checks = {"arc": _arc, "screw": _screw, "with": _with, "frame": _frame, "place": _place}
    angle = statement.part("angle")
    if angle and "fill" in STATEMENTS[statement.word].parts and not statement.part("fill"):
        help = "write how far apart its lines are: fill 2 mm angle 45 deg"
        raise problem("E248", "'angle' is that of the 'fill'", angle.span, "", help)
    if statement.word in checks:
        checks[statement.word](statement)
    elif statement.word in ("line", "move"):
        if not statement.part("to") and not statement.part("by"):
            raise _to_or_by(statement.word, _first_word(statement))
    elif statement.word in ("text", "path", "svg", "photo"):
        _imported(statement)


def _first_word(statement: Statement) -> Span:
    return Span(statement.span.start, statement.span.start + len(statement.word))


def _once(statement: Statement, text: str) -> None:
    many = STATEMENTS[statement.word].many
    seen: dict[str, Part] = {}
    for part in statement.parts:
        word = "centre" if part.word == "center" else part.word
        if word in seen and word not in many:
            line, column = locate(text, seen[word].span.start)
            raise problem(
                "E113",
                f"'{word}' is given twice",
                part.span,
                f"second (first: {line}:{column})",
                "keep one of them",
            )
        seen[word] = part


def _one_time(parts: tuple[Part, ...]) -> None:
    times = [part for part in parts if part.word in TIMES]
    speeds = [part for part in parts if part.word in ("speed", "turnspeed")]
    if len(times) + bool(speeds) > 1:
        given = sorted(times + speeds[:1], key=lambda part: part.span.start)
        raise problem(
            "E241",
            "the time is given twice",
            given[1].span,
            "second",
            "use one of: in TIME, samples N, speed V",
        )


def _to_or_by(word: str, span: Span) -> Problem:
    return problem(
        "E111",
        f"'{word}' needs 'to' or 'by' before the point",
        span,
        "",
        f"{word} to (…) goes to that point; {word} by (…) goes that far from here",
    )


def _needs(statement: Statement, part: str, help: str = "") -> None:
    if statement.part(part) is None:
        help = help or f"for example: {STATEMENTS[statement.word].example}"
        message = f"this '{statement.word}' has no '{part}'"
        raise problem("E115", message, _first_word(statement), "", help)


def _arc(statement: Statement) -> None:
    via = statement.part("via")
    centre = statement.part("centre") or statement.part("center")
    if via is not None:
        for word in ("centre", "center", *_FORM_OF_CENTRE, *_FORM_OF_RADIUS):
            if part := statement.part(word):
                message = f"'arc via' goes through two points; it takes no '{word}'"
                help = "write: arc via POINT to POINT, or: arc centre POINT angle ANGLE"
                raise problem("E248", message, part.span, "", help)
        _needs(statement, "to", "an arc through three points ends at the last: via POINT to POINT")
        return
    if statement.part("radius") is not None:
        _radius(statement)
        return
    for word in ("left", "right", "long"):
        if part := statement.part(word):
            message = f"'{word}' belongs to an arc with a radius"
            help = "write: arc radius 20 mm to (10, 0) mm left"
            raise problem("E248", message, part.span, "", help)
    if to := statement.part("to"):
        if centre is None and not any(statement.part(word) for word in _FORM_OF_CENTRE):
            help = "write: arc via POINT to POINT, or: arc centre POINT angle ANGLE"
            _needs(statement, "via", help)
        raise problem(
            "E247",
            "'arc centre' takes an angle, not an end point",
            to.span,
            "",
            "centre and end point could contradict each other; write: angle 90 deg",
        )
    if centre is None:
        _needs(statement, "centre", "write: arc centre POINT angle ANGLE")
    _needs(statement, "angle", "add how far it turns: angle 360 deg")


def _radius(statement: Statement) -> None:
    if statement.part("centre") or statement.part("center"):
        part = statement.part("radius")
        assert part is not None
        help = "the radius is the distance from here to the centre: first move to the circle"
        raise problem("E248", "'arc centre' takes no 'radius'", part.span, "", help)
    for word in ("angle", "rise", "grow"):
        if part := statement.part(word):
            message = f"'arc radius' goes from here to a point; it takes no '{word}'"
            help = "with a centre, the radius is the distance from here to it"
            raise problem("E248", message, part.span, "", help)
    _needs(statement, "to", "add where it ends: arc radius 20 mm to (10, 0) mm left")
    left, right = statement.part("left"), statement.part("right")
    if left and right:
        span = max(left.span, right.span, key=lambda span: span.start)
        raise problem("E248", "an arc turns left or right, not both", span, "", "keep one of them")
    if not left and not right:
        message = "this 'arc' does not say which way it turns"
        help = "add left (against the clock) or right"
        raise problem("E115", message, _first_word(statement), "", help)


def _frame(statement: Statement) -> None:
    if not statement.parts:
        _needs(statement, "at")


def _screw(statement: Statement) -> None:
    to = statement.part("to")
    if to is not None:
        for word in ("about", *_FORM_OF_ABOUT):
            if part := statement.part(word):
                message = f"'screw to' finds its own axis; it takes no '{word}'"
                help = "write: screw to POINT tool ORIENTATION, or: screw about POINT along …"
                raise problem("E248", message, part.span, "", help)
        return
    for word in ("about", "along", "angle"):
        _needs(statement, word)
    if tool := statement.part("tool"):
        message = "'screw about' moves the tool rigidly; it takes no 'tool'"
        help = "turn the tool before, or write: screw to POINT tool ORIENTATION"
        raise problem("E248", message, tool.span, "", help)


def _place(statement: Statement) -> None:
    if statement.name is None:
        _needs(statement, "at")
    elif at := statement.part("at"):
        message = "'place auto' finds the place itself; it takes no 'at'"
        help = "write: place auto, or: place at POINT turned ORIENTATION"
        raise problem("E248", message, at.span, "", help)


def _with(statement: Statement) -> None:
    if not statement.parts:
        help = f"for example: {STATEMENTS['with'].example}"
        raise problem("E115", "this 'with' changes nothing", statement.span, "", help)
    before = ""
    for part in statement.parts:
        if part.word == "about" and before not in ("rotate", "mirror"):
            message = "'about' says what 'rotate' turns about, and what 'mirror' goes through"
            help = "write: with rotate 30 deg about (10, 0) mm"
            raise problem("E248", message, part.span, "", help)
        before = part.word


def _imported(statement: Statement) -> None:
    """Imported strokes: a size where needed; one file for a drawing, at most three for a path."""
    word, fitted = statement.word, statement.part("height") or statement.part("width")
    unit = statement.part("unit")
    if word == "text" and not fitted:
        _needs(statement, "height", "say how high its capitals are: height 30 mm")
    if word == "path" and not fitted and not unit:
        _needs(statement, "unit", "numbers in a file have no unit; write: unit mm, or height 80 mm")
    if fitted and unit:
        message = f"'unit' and '{fitted.word}' both say how large it is"
        raise problem("E248", message, unit.span, "", "keep one of them")
    most = {"svg": 1, "photo": 1, "path": 3}.get(word)
    if most and len(statement.values) > most:
        drawn = "photo" if word == "photo" else "drawing"
        help = f"one {drawn} to a line" if most == 1 else "one file, or one for each of x, y and z"
        message = f"'{word}' takes {'one file' if most == 1 else 'at most 3 files'}"
        raise problem("E248", message, statement.values[most].span, "", help)


def misplaced(word: str, token: Token) -> Problem | None:
    """The message for a part of other statements, or None."""
    if token.text == "period":
        message = "'period' stands on a line of its own, before the first movement"
        return problem("E123", message, token.span, "", "for example: period 8 ms")
    if word == "move" and token.text == "light":
        message = "'move' is always dark, so it has no 'light'"
        return problem("E110", message, token.span, "", "to shine on the way, use: line to …")
    help = {
        ("hold", "tool"): "to turn on the spot, use: line by (0, 0) tool …",
        ("hold", "in"): "write the time straight after it: hold 1 s",
        ("hold", "samples"): "write the time straight after it: hold 1 s",
        ("step", "in"): "a step takes one sample; to wait after it, use: hold 1 s",
        ("step", "samples"): "a step takes one sample; to wait after it, use: hold 1 s",
        ("step", "speed"): "a step takes one sample; to go there evenly, use: line to",
        ("step", "profile"): "a step takes one sample; to go there evenly, use: line to",
        ("step", "by"): "a step says where to: step to (50, 0) mm",
        ("start", "turned"): "write: start at (0, 0, 0) tool …",
        ("place", "tool"): "write: place at (0, 0, 0) turned …",
        ("screw", "rise"): "a screw advances by its pitch: pitch 50 mm/turn",
        ("arc", "pitch"): "an arc advances by its rise in all: rise 50 mm",
        ("arc", "by"): "an arc names its points: arc via POINT to POINT",
        ("arc", "along"): "did you mean 'axis'?",
        ("arc", "about"): "did you mean 'centre'?",
        ("screw", "axis"): "did you mean 'along'?",
        ("screw", "centre"): "did you mean 'about'?",
        ("with", "turned"): "did you mean 'rotate'?",
        ("curve", "step"): "a curve is smooth and takes no step: leave it out",
        ("line", "from"): "a line begins where the tool is; write before it: move to (0, 0)",
        ("arc", "from"): "an arc begins where the tool is; write before it: move to (0, 0)",
    }.get((word, RENAMED.get(token.text, token.text)))
    if token.text == "with" and STATEMENTS[word].moves:
        help = "parts stand there without 'with', as in: line to (10, 0) mm light red"
    elif token.text == "per":
        help = "a rate is written with a slash: mm/s"
    if help is None:
        return None
    message = f"'{word}' has no part called '{token.text}'"
    meant = _QUESTION.fullmatch(help)
    fix = Fix(f"write {meant[1]}", token.span, meant[1]) if meant else None
    return problem("E110", message, token.span, "", help, fix)


def unexpected(word: str, cursor: Cursor) -> Problem | None:
    """The message for a word that is no part at all, or None."""
    token = cursor.token
    is_value = token.kind == "number" or (token.kind == "sign" and token.text in "(-")
    if word in ("line", "move") and is_value and cursor.before.text == word:
        return _to_or_by(word, token.span)
    if not is_value:
        return trailing_tokens.advice_for(word, cursor)
    needed = {
        **dict.fromkeys(("circle", "ellipse", "rect"), "at"),
        **{"arc": "centre", "screw": "about", "step": "to", "start": "at", "place": "at"},
    }
    if word in needed and cursor.before.text == word:
        message = f"'{word}' needs '{needed[word]}' before the point"
        help = f"for example: {STATEMENTS[word].example}{' at (0, 0)' if word in SHAPES else ''}"
        return problem("E111", message, token.span, "", help)
    return trailing_tokens.advice_for(word, cursor)

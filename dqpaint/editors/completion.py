"""Text and offset -> the meaning of a word, and completions. Offsets are code points."""

import re
from collections.abc import Iterable

from dqpaint.diagnostics import Span
from dqpaint.editors.vocabulary import Entry, vocabulary
from dqpaint.language.vocabulary import PARTS, RENAMED, STATEMENTS

_WORD = re.compile(r"[A-Za-z_°][A-Za-z0-9_]*", re.ASCII)
_TOKEN = re.compile(r'"[^"\n]*"?|#.*|[A-Za-z_°][A-Za-z0-9_]*|[\d.]+|\S', re.ASCII)
_NAMED = re.compile(r"^\s*(?:let|repeat|def|frame)\s+([A-Za-z_][A-Za-z0-9_]*)", re.MULTILINE)


def word_at(text: str, offset: int) -> Span | None:
    """The word at an offset, unless it is in a comment or a quoted text."""
    start, end = _line(text, offset)
    for match in _TOKEN.finditer(text, start, end):
        if match.start() <= offset <= match.end() and _WORD.fullmatch(match[0]):
            return Span(*match.span())
    return None


def meaning_at(text: str, offset: int) -> tuple[Entry, Span] | None:
    """The entry of the word at an offset."""
    span = word_at(text, offset)
    if span is None:
        return None
    start, _ = _line(text, offset)
    first = not text[start : span.start].strip()
    known = [entry for entry in vocabulary() if entry.word == span.text_in(text)]
    if not known:
        return None
    return next((e for e in known if (e.kind == "statement") is first), known[0]), span


def completions(text: str, offset: int) -> list[Entry]:
    """The words that may follow at an offset, where their first letters may be written already."""
    start, _ = _line(text, offset)
    written = _WORD.search(text[start:offset].rpartition(" ")[2].rpartition("(")[2])
    begun = offset - (len(written[0]) if written and text[:offset].endswith(written[0]) else 0)
    tokens = _TOKEN.findall(text[start:begun])
    if tokens and (tokens[-1].startswith("#") or _open_text(tokens[-1])):
        return []
    if not tokens:
        return _entries("statement")
    last = tokens[-1]
    units = _entries("unit")
    if re.fullmatch(r"[\d.]+", last):
        return units
    if RENAMED.get(last, last) == "profile":
        return _entries("profile")
    if last == "brush":
        return _brushes()
    if last == "light":
        return [*_entries("colour", "function"), *_words("on", "off", "rainbow")]
    if last == "to" and "light" in tokens:
        return [*_entries("colour", "function"), *_words("on", "off")]
    if last == "tool":
        return [*_words("keep", "follow", "look"), *_entries("function")]
    found = [*(_words("auto") if last == "place" else ()), *_brush_values(tokens)]
    found += [*_words(*_after_colours(tokens)), *_next_parts(tokens)]
    if last == ")":
        found += units
    return [*found, *_values(text)]


def _brushes() -> list[Entry]:
    from dqpaint.brushes import BRUSHES  # not before a drawing has a brush

    return [
        Entry(name, "word", (model.__doc__ or "").splitlines()[0], f"brush {name}")
        for name, model in BRUSHES.items()
    ]


def _brush_values(tokens: list[str]) -> list[Entry]:
    """The values that the brush of this line may still have."""
    if "brush" not in tokens[:-1]:
        return []
    from dqpaint.brushes import BRUSHES

    name, *said = tokens[tokens.index("brush") + 1 :]
    fields = BRUSHES[name].model_fields if name in BRUSHES else {}
    return [
        Entry(key, "part", field.description or "", f"brush {name} {key}")
        for key, field in fields.items()
        if key not in said
    ]


def _after_colours(tokens: list[str]) -> tuple[str, ...]:
    """What may stand behind the colours of a light."""
    if "light" not in tokens[:-1]:
        return ()
    rest = tokens[tokens.index("light") :]
    return ("hue", "even") if "to" in rest else ("even",)


def _next_parts(tokens: list[str]) -> list[Entry]:
    """The parts that the statement may still have."""
    known = STATEMENTS.get(tokens[0])
    if known is None:
        return []
    free = {p for p in known.parts if p in known.many or p not in tokens[1:]}
    return [entry for entry in _entries("part") if entry.word in free]


def _values(text: str) -> list[Entry]:
    named = (Entry(name, "name", "a name of this drawing", name) for name in _NAMED.findall(text))
    return [*dict.fromkeys(named), *_entries("function", "constant")]


def _entries(*kinds: str) -> list[Entry]:
    return [entry for entry in vocabulary() if entry.kind in kinds]


def _words(*words: str) -> list[Entry]:
    return [entry for entry in vocabulary() if entry.kind == "word" and entry.word in words]


def _open_text(token: str) -> bool:
    return token.startswith('"') and (len(token) == 1 or not token.endswith('"'))


def _line(text: str, offset: int) -> tuple[int, int]:
    start = text.rfind("\n", 0, offset) + 1
    end = text.find("\n", offset)
    return start, len(text) if end < 0 else end


def listed(parts: Iterable[str]) -> str:
    """Parts with their examples, for a hover."""
    return "\n".join(f"- `{PARTS[word].example}`: {PARTS[word].meaning}" for word in parts)

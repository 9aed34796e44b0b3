"""SVG style sheets -> attributes of the elements they select.

After this an element's attributes say all: the rules of the sheets in the order of their weight,
then the element's own `style`, as CSS has it. Selectors are a tag, classes and an id; rules with
others are named, not followed.
"""

import re
from collections.abc import Callable, Iterator
from typing import NamedTuple

from dqpaint.language.imports.svg.guard import Element

Remark = Callable[[Element, str], None]

_COMMENT = re.compile(r"/\*.*?(?:\*/|\Z)", re.DOTALL)
_RULE = re.compile(r"([^{}]*)\{([^{}]*)\}")
_SELECTOR = re.compile(r"(\*|[a-zA-Z][\w-]*)?((?:[.#][\w-]+)*)")
_PART = re.compile(r"[.#][\w-]+")
_AT = re.compile(r"\s*(@[\w-]+)?")
_IMPORTANT = re.compile(r"\s*!\s*important$")
_BRACKETS = re.compile(r"[{}]")
_STATES = re.compile(r"::?[a-z-]+(\(|$)")  # such as :hover: not of a still picture


MOST_WORK = 3_000_000  # of rules tried on elements


class TooManyRulesError(Exception):
    """More rules and elements than are matched against each other."""


class _Declared(NamedTuple):
    """The declarations of a rule, and those of them marked important."""

    plain: dict[str, str]
    important: dict[str, str]


class _Rule(NamedTuple):
    """A rule with one selector; `weight` orders rules as in CSS: ids, classes, tag, position."""

    weight: tuple[int, int, bool, int]
    names: frozenset[str]  # `#id`, `.class` and `tag`, all of which an element must have
    declared: _Declared


def inline(root: Element, known: frozenset[str], remark: Remark) -> None:
    """Writes the declarations of all styles into attributes; only `known` names are used.

    Raises:
        TooManyRulesError: it would take too long.
    """
    rules: dict[str, list[_Rule]] = {}  # by the first of their names; "" for those of all
    for sheet in root:
        if sheet.tag == "style":
            for rule in _rules(sheet, known, remark):
                rules.setdefault(min(rule.names, default=""), []).append(rule)
    work = 0
    for element in root:
        has = element.has
        own = _declared(has.pop("style", ""), known)
        holding: list[_Declared] = []
        if rules:
            names = {f".{one}" for one in has.get("class", "").split()}
            names |= {element.tag, f"#{has.get('id', '')}"}
            tried = [rule for name in ("", *names) for rule in rules.get(name, ())]
            work += len(tried)
            if work > MOST_WORK:
                raise TooManyRulesError
            tried.sort(key=lambda rule: rule.weight)
            holding = [rule.declared for rule in tried if rule.names <= names]
        for declared in (*holding, own):
            has.update(declared.plain)
        for declared in (*holding, own):
            has.update(declared.important)


def _rules(sheet: Element, known: frozenset[str], remark: Remark) -> Iterator[_Rule]:
    text = _COMMENT.sub(" ", "".join(sheet.text)).replace("<!--", " ").replace("-->", " ")
    for order, (selectors, body) in enumerate(_blocks(text, sheet, remark)):
        declared = _declared(body, known)
        for selector in map(str.strip, selectors.split(",") if any(declared) else ()):
            match = _SELECTOR.fullmatch(selector)
            if match and selector:
                names = {part[0] for part in _PART.finditer(match[2])}
                ids = sum(name.startswith("#") for name in names)
                tag = {match[1]} - {None, "*"}
                weight = (ids, len(names) - ids, bool(tag), order)
                yield _Rule(weight, frozenset(names | tag), declared)
            elif not _STATES.search(selector):
                remark(sheet, f"the style of '{' '.join(selector.split())[:40]}' is not followed")


def _blocks(text: str, sheet: Element, remark: Remark) -> Iterator[tuple[str, str]]:
    """The rules of a sheet; at-rules are ignored."""
    at, size = 0, len(text)
    while at < size:
        match = _AT.match(text, at)
        if match and match[1]:
            brace, semicolon = text.find("{", at), text.find(";", at)
            if match[1] in ("@import", "@media", "@supports"):
                remark(sheet, f"its {match[1]} is not followed")
            at = semicolon + 1 if 0 <= semicolon < (brace % (size + 1)) else _close(text, brace)
            continue
        rule = _RULE.match(text, at)
        if not rule:
            return
        yield rule[1].strip(), rule[2]
        at = rule.end()


def _close(text: str, brace: int) -> int:
    """The offset after the matching closing brace; the end of the text if there is none."""
    if brace < 0:
        return len(text)
    depth = 0
    for match in _BRACKETS.finditer(text, brace):
        depth += 1 if match[0] == "{" else -1
        if not depth:
            return match.end()
    return len(text)


def _declared(text: str, known: frozenset[str]) -> _Declared:
    """The known declarations; the last of a name wins."""
    found = _Declared({}, {})
    for declaration in _COMMENT.sub(" ", text).split(";"):
        name, colon, value = declaration.partition(":")
        name, value = name.strip().lower(), value.strip()
        if colon and name in known:
            plain = _IMPORTANT.sub("", value)
            (found.plain if plain == value else found.important)[name] = plain
    return found

"""Whatever is in an SVG file: lines of finite numbers, or a message, and soon."""

import random
import re
from pathlib import Path
from xml.etree import ElementTree

import numpy as np
import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from dqpaint.language import ScriptError, parse
from dqpaint.language.imports.svg import reader
from dqpaint.program.program import PiecewiseCurve
from tests.support.work import Calls

FILES = [
    *sorted((Path(__file__).parent / "files").glob("*.svg")),
    Path(__file__).parents[2] / "trajectories" / "logo.svg",
]
MOST_CALLS = 2_000_000
KNOWN = {"E201", "E263", "E298", "W420", "W421", "W422"}


def told(error: ScriptError) -> None:
    assert not {d.code for d in error.diagnostics} - KNOWN


def sound(folder: Path) -> bool:
    """Compiles the drawing; whether it could be drawn. Warnings of numpy are errors here."""
    reader._read.cache_clear()
    try:
        with Calls(MOST_CALLS):
            program = parse('svg "f.svg" height 9 mm', "a.traj", folder / "a.traj")
    except ScriptError as error:
        told(error)
        return False
    for segment in program.segments:
        assert np.isfinite(segment.end.position).all()
        if isinstance(segment.path, PiecewiseCurve):
            for numbers in (segment.path.cubic, segment.path.ellipse, segment.path.angles):
                assert np.isfinite(numbers).all()
    return True


# Made up.

NUMBERS = ["0", "1", "-1", ".5", "1e3", "1e-9", "1e400", "nan", "-0", "99999999", "7"]
COMMANDS = [*"MLHVCSQTAZmlhvcsqtaz,", "1 1 0 0 1", *NUMBERS]
WORDS = [
    *("red", "none", "#12", "url(#a)", "#a", "fill:red;stroke:", "10%", "1em", "rgb(300)", "%"),
    *("scale(0)", "rotate(30)", "matrix(1 0 0 0 1 1)", "skewX(90)", "translate(1e400)", "0 0 0 0"),
]
PATHS = st.lists(st.sampled_from(COMMANDS), max_size=12).map(" ".join)
VALUES = st.one_of(st.sampled_from(NUMBERS), PATHS, st.sampled_from(WORDS))
NAMES = [
    *("d", "points", "x", "y", "x1", "x2", "r", "cx", "rx", "ry", "width", "height", "viewBox"),
    *("transform", "stroke", "fill", "style", "href", "id", "stroke-opacity", "class"),
]
ATTRIBUTES = st.dictionaries(st.sampled_from(NAMES), VALUES, max_size=6)
SHAPES = ["path", "circle", "rect", "ellipse", "polyline", "polygon", "line"]
TAGS = st.sampled_from([*SHAPES, "g", "use", "svg", "symbol", "a"])


def element(tag: str, attributes: dict[str, str], inside: list[str]) -> str:
    said = " ".join(f'{name}="{value}"' for name, value in attributes.items())
    return f"<{tag} {said}>{''.join(inside)}</{tag}>"


TREES = st.recursive(
    st.builds(element, TAGS, ATTRIBUTES, st.just([])),
    lambda inner: st.builds(element, TAGS, ATTRIBUTES, st.lists(inner, max_size=3)),
    max_leaves=5,
)


@pytest.mark.slow
@settings(max_examples=250, deadline=None, suppress_health_check=list(HealthCheck))
@given(TREES, ATTRIBUTES)
def test_whatever_is_in_a_drawing(tmp_path: Path, body: str, root: dict[str, str]) -> None:
    (tmp_path / "f.svg").write_text(element("svg", root, [body]), "utf-8")
    sound(tmp_path)


# Real files, with a few things in them changed.

TRIED = 1000
TOKEN = re.compile(r"[-+]?(?:\d+\.?\d*|\.\d+)(?:[eE][-+]?\d+)?|[A-Za-z]+|.", re.DOTALL)
SCRAPS = [
    *("0", "-1", "nan", "inf", "1e400", "1e9", "-1e9", "1e-9", "1e-300", "5e-324", "50%", "3em"),
    *("", ",", "M", "L", "A", "C", "Z", "X", "#", "blu", "url(#a)", "none", "(", ")", "scale(0)"),
]
WHOLE = [
    *[("transform", f"{t}") for t in ("scale(1e9 1e-9)", "skewX(90)", "matrix(1 1 1 1 0 0)", "x")],
    *[
        ("d", d)
        for d in ("M0 0A1e9 1e-9 33 1 0 3 3", "M1 1", "M0 0C0 0 0 0 0 0", "M0 0A5 5 0 0 0 0 0")
    ],
    *[("style", s) for s in ("stroke:blu", "display:none", "opacity:.5;stroke:red!important")],
    *[("viewBox", v) for v in ("0 0 0 0", "0 0 1e9 1e-9", "-1e9 -1e9 1e9 1e9")],
    *[("href", "#a"), ("id", "a"), ("width", "1e-9"), ("opacity", "nan"), ("stroke", "url(#a)")],
]


@pytest.mark.slow
def test_mutants_of_files(tmp_path: Path) -> None:
    chance = random.Random(4)
    texts = [path.read_text("utf-8") for path in FILES]
    drawn = 0
    for _ in range(TRIED):
        root = ElementTree.fromstring(chance.choice(texts))
        elements = list(root.iter())
        for _ in range(chance.randint(1, 3)):
            has = chance.choice(elements).attrib
            if has and chance.random() < 0.7:
                name = chance.choice(list(has))
                parts = TOKEN.findall(has[name]) or [""]
                parts[chance.randrange(len(parts))] = chance.choice(SCRAPS)
                has[name] = "".join(parts)
            else:
                has.update([chance.choice(WHOLE)])
        (tmp_path / "f.svg").write_bytes(ElementTree.tostring(root))
        drawn += sound(tmp_path)
    assert 0 < drawn < TRIED

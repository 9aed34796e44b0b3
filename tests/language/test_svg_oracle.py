"""Random SVG drawings against two other readers: svgelements, and Chromium where that is wrong.

svgelements shows a symbol where it stands, without its view box, takes no group's opacity and no
percentage of `r`, puts an inner <svg> elsewhere, writes the scale of a view box with twelve
decimals, hands on the colour of `currentColor` and lets a class go before an id: its drawings have
none of these, and a scale of 4. Chromium has seven digits of places, and no place of what is turned
but that of the box around it.
"""

import io
import json
import re
from pathlib import Path

import numpy as np
import pytest
import svgelements
from numpy.typing import NDArray

from dqpaint.language.imports.svg.nested_svg import paper
from dqpaint.language.imports.svg.reader import PIXEL, _colour, _lines, _paints, _shapes
from dqpaint.program import Colour
from tests.support.browser import needs_browser, opened
from tests.support.random_svg import Made, Placed, Styled
from tests.support.svg import by_library, outline, tree

Floats = NDArray[np.float64]


Lines = list[tuple[Floats, Colour | None]]  # places [px], y down, and the light


def by_svgelements(text: str) -> Lines:
    """The lines of a drawing in their order."""
    made = []
    root = svgelements.SVG.parse(io.BytesIO(text.encode()), reify=False, ppi=96.0)
    for shape in root.select(lambda one: isinstance(one, svgelements.Shape)):
        paints = [one for one in (shape.stroke, shape.fill) if one.value is not None and one.alpha]
        if paints and shape.values.get("visibility") not in ("hidden", "collapse"):
            paint = bytes(getattr(paints[0], name) for name in ("red", "green", "blue", "alpha"))
            m = shape.transform
            for line in by_library(shape):
                made.append((line @ [[m.a, m.b], [m.c, m.d]] + [m.e, m.f], _colour(paint)))
    return made


def by_dqpaint(text: str) -> Lines:
    """The same."""
    return [(outline(line) / PIXEL * [1, -1], colour) for line, colour in _lines(tree(text))]


@pytest.mark.parametrize("seed", range(5))
def test_drawings_are_as_svgelements_has_them(seed: int) -> None:
    lines = 0
    for number in range(40):
        text = Made(1000 * seed + number).text()
        own, wanted = by_dqpaint(text), by_svgelements(text)
        assert len(own) == len(wanted), text
        size = max((np.abs(line).max() for line, _ in wanted), default=0.0)
        for (line, colour), (other, light) in zip(own, wanted, strict=True):
            np.testing.assert_allclose(line, other, rtol=0, atol=1e-12 * size, err_msg=text)
            assert colour == light, text
        lines += len(own)
    assert lines > 300


# In a browser.


def asked(folder: Path, drawings: list[str], script: str) -> list[list[object]]:
    """What a script says of drawings on a page."""
    page = folder / "page.html"
    within = "".join(f'<div style="position:absolute;left:0;top:0">{one}</div>' for one in drawings)
    said = f"document.getElementById('said').textContent = JSON.stringify({script})"
    page.write_text(f'<!doctype html>{within}<pre id="said"></pre><script>{said}</script>', "utf-8")
    found = re.search(r'<pre id="said">(.*?)</pre>', opened(page)[0])
    assert found
    return list(json.loads(found[1]))


@pytest.mark.slow
@needs_browser
def test_viewports_are_as_chromium_has_them(tmp_path: Path) -> None:
    drawings = [Placed(seed).text() for seed in range(400)]
    boxes = "[...document.querySelectorAll('g.all')].map(g => g.getBoundingClientRect())"
    script = f"{boxes}.map(box => [box.x, box.y, box.right, box.bottom])"
    for text, box in zip(drawings, asked(tmp_path, drawings, script), strict=True):
        ((line, _),) = by_dqpaint(text)
        own = [*line.min(axis=0), *line.max(axis=0)]
        np.testing.assert_allclose(own, box, rtol=1e-3, atol=1e-2, err_msg=text)


@pytest.mark.slow
@needs_browser
def test_paints_are_as_chromium_has_them(tmp_path: Path) -> None:
    drawings = [Styled(seed).text() for seed in range(30)]
    script = """[...document.querySelectorAll('path')].map(path => {
        const has = getComputedStyle(path); let opacity = 1;
        for (let at = path; at; at = at.parentElement) opacity *= getComputedStyle(at).opacity;
        const own = [has.stroke, has.strokeOpacity, has.fill, has.fillOpacity, has.visibility];
        return [...own, opacity]})"""
    said = iter(asked(tmp_path, drawings, script))
    for text in drawings:
        root = tree(text)
        for _, state in _shapes(root, paper(root)):
            stroke, stroke_opacity, fill, fill_opacity, visibility, opacity = map(str, next(said))
            wanted = [seen(stroke, stroke_opacity, opacity), seen(fill, fill_opacity, opacity)]
            found = [tuple(one) if one else None for one in _paints(state.style)]
            assert found == (wanted if visibility == "visible" else [None, None]), text
    assert next(said, None) is None


def seen(paint: str, own: str, opacity: str) -> tuple[int, ...] | None:
    """A computed colour with its opacities."""
    if paint == "none":
        return None
    red, green, blue, *alpha = map(float, re.findall(r"[\d.]+", paint))
    share = round(255 * (alpha or [1.0])[0]) / 255
    return round(red), round(green), round(blue), round(255 * float(own) * float(opacity) * share)

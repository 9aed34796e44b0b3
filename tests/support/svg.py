"""SVG drawings as texts, made for tests, and places on their lines."""

from collections.abc import Iterator

import numpy as np
import svgelements
from numpy.typing import NDArray

from dqpaint.language.imports.svg import attributes
from dqpaint.language.imports.svg.attributes import Node
from dqpaint.language.imports.svg.guard import guard
from dqpaint.program import PiecewiseCurve, piecewise

G = np.linspace(0.0, 1.0, 9)  # along a piece of a line
OPEN = '<svg xmlns="http://www.w3.org/2000/svg" xmlns:xlink="http://www.w3.org/1999/xlink">'
WITH = OPEN.replace(">", " {}>")  # with attributes


def nested_uses(levels: int) -> str:
    """Each group uses the one before it twice: 2^levels circles."""
    groups = "".join(
        f'<g id="a{i}"><use href="#a{i - 1}"/><use xlink:href="#a{i - 1}"/></g>'
        for i in range(1, levels + 1)
    )
    return f'{OPEN}<circle id="a0" r="1"/>{groups}</svg>'


def drawing_of(shapes: Iterator[str]) -> str:
    """An SVG of 1000 by 1000 pixels."""
    root = '<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 1000 1000" stroke="red">'
    return f"{root}{''.join(shapes)}</svg>"


def dots(count: int) -> Iterator[str]:
    for i in range(count):
        yield f'<circle cx="{i * 7919 % 1000}" cy="{i * 104729 % 997}" r="1"/>'


def curves(count: int) -> Iterator[str]:
    yield '<path fill="none" d="M500 500'
    for i in range(count):
        end = f"{i * 7919 % 31 - 15} {i * 104729 % 29 - 14}"
        yield f"c{i % 7}.5 {i % 5}.25 {i % 3}.5 {i % 11} {end}"
    yield '"/>'


def tree(text: str) -> Node:
    """A drawing with its attributes."""
    return attributes.read(guard(text.encode()))[0]


def outline(path: PiecewiseCurve) -> NDArray[np.float64]:
    """Places (N, 2) along all pieces of a line."""
    piece = np.repeat(np.arange(len(path.cubic)), len(G))
    at = piecewise.derivatives(path, piece, np.tile(G, len(path.cubic)))[0]
    return np.asarray(at[:, :2])


def by_library(shape: svgelements.Shape) -> list[NDArray[np.float64]]:
    """The same of each line of a shape, as svgelements has it, without the shape's transform."""
    if isinstance(shape, (svgelements.Circle, svgelements.Ellipse)):  # there it is four arcs
        turned = np.stack([np.cos(2 * np.pi * G), np.sin(2 * np.pi * G)], axis=1)
        return [turned * [float(shape.rx), float(shape.ry)] + [float(shape.cx), float(shape.cy)]]
    lines: list[list[NDArray[np.float64]]] = []
    lifted = True
    for segment in shape.segments(transformed=False):
        if isinstance(segment, svgelements.Move):
            lifted = True
            continue
        at = np.array([[p.x, p.y] for p in map(segment.point, G)])
        if np.abs(at - at[0]).max() > 0.0:
            if lifted:
                lines.append([])
            lines[-1].append(at)
            lifted = isinstance(segment, svgelements.Close)
    return [np.concatenate(line) for line in lines]

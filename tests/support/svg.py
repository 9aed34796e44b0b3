"""SVG drawings as texts, made for tests."""

from collections.abc import Iterator

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

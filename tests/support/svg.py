"""SVG drawings as texts, made for tests."""

OPEN = '<svg xmlns="http://www.w3.org/2000/svg" xmlns:xlink="http://www.w3.org/1999/xlink">'
WITH = OPEN.replace(">", " {}>")  # with attributes


def nested_uses(levels: int) -> str:
    """Each group uses the one before it twice: 2^levels circles."""
    groups = "".join(
        f'<g id="a{i}"><use href="#a{i - 1}"/><use xlink:href="#a{i - 1}"/></g>'
        for i in range(1, levels + 1)
    )
    return f'{OPEN}<circle id="a0" r="1"/>{groups}</svg>'

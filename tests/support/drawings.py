"""Drawings by chance, of all that a stroke can be, for tests that compare two ways to plan one."""

import random

TOOLS = [
    *("", "", ""),
    "tool rpy({} deg, {} deg, {} deg)",
    "tool follow",
    "tool look (500, 400, -700) mm",
    "tool look line (500, 400, -700) mm along (1, 2, 3)",
]
LIGHTS = ["", "", "light red", "light red to blue", "light white even", "light off",
          "light red to blue even", "light lime even brush bar 30 mm"]  # fmt: skip
TIMES = ["", "", "in 0.5 s", "in 0.333 s", "samples 17", "speed 90 mm/s",
         "speed 30 mm/s turnspeed 40 deg/s"]  # fmt: skip
PROFILES = ["", "", "profile constant", "profile cubic", "profile quintic",
            "profile cubic(10 mm/s, -5 mm/s)",
            "profile quintic(5 mm/s, 10 mm/s, 3 mm/s^2, -2 mm/s^2)"]  # fmt: skip
STROKES = ["", "in 2 s", "samples 40", "profile constant", "profile cubic(10 mm/s, 10 mm/s) in 3 s"]
FAULTS = [
    "line by (10, 0) mm speed 1e-6 mm/s",
    "hold 1 s\nline by (9, 0) mm in 90000 s",
    "line by (1, 0) mm profile cubic(500 mm/s, 500 mm/s)",
    "line by (0, 0) mm tool rpy(10 deg, 0, 77 deg) profile cubic(9 mm/s, 9 mm/s)",
    "curve (10 + 3*t^3, 3*t^2) mm for t from -1 to 1",
    "curve (9*abs(t - 0.37)^1.5, 3*t) mm for t from 0 to 1 samples 100 light red to blue",
]


def number(rng: random.Random, least: float, most: float) -> str:
    return f"{rng.uniform(least, most):.2f}"


def point(rng: random.Random, size: float = 60.0) -> str:
    x, y, z = number(rng, -size, size), number(rng, -size, size), number(rng, -20, 20)
    return f"({x}, {y}, {z}) mm"


def way(rng: random.Random, inside: bool) -> str:
    """What goes somewhere; within a stroke it goes on."""
    turn = number(rng, 20, 200)
    ways = [
        f"line to {point(rng)}",
        f"line by {point(rng, 20)}",
        f"arc centre {point(rng)} angle {turn} deg",
        f"arc centre {point(rng)} angle -{turn} deg rise {number(rng, -9, 9)} mm "
        f"grow {number(rng, 1, 9)} mm axis (1, -2, 2)",
    ]
    if not inside:
        x, y = number(rng, 1, 9), number(rng, 1, 9)
        ways.append(f"curve ({x} + 20*t, {y} + 10*t^2, 9*t^3) mm for t from 0.1 to 1")
    return rng.choice(ways)


def statement(rng: random.Random, inside: bool = False) -> str:
    kind = rng.random()
    turn = f"{number(rng, 10, 90)} deg"
    if kind < 0.1:
        return f"screw about {point(rng)} along (1, -2, 2) angle {turn} pitch 9 mm/turn"
    if not inside and kind < 0.15:
        return f"screw to {point(rng)} tool rpy({turn}, 0, {turn}) {rng.choice(LIGHTS)}"
    if not inside and kind < 0.25:
        return rng.choice([f"hold {number(rng, 10, 300)} ms", f"step to {point(rng)}"])
    if not inside and kind < 0.3:
        return f'text "Wo" height 9 mm at {point(rng)} light {rng.choice(["red", "red to blue"])}'
    tool = rng.choice(TOOLS).format(*(number(rng, -60, 60) for _ in range(3)))
    parts = [tool, rng.choice(LIGHTS)]
    if inside:
        parts = [part for part in parts if "look" not in part]
    else:
        parts += [rng.choice(TIMES), rng.choice(PROFILES)]
    return " ".join([way(rng, inside), *filter(None, parts)])


def drawing(seed: int, faults: int = 0) -> str:
    """A drawing of 3 to 30 statements, some of which are strokes of several lines."""
    rng = random.Random(seed)
    lines = [f"period {rng.choice([4, 8, 10])} ms", "speed 80 mm/s"]
    lines.append("start at (1, 2, 3) mm tool rpy(10 deg, 20 deg, 30 deg)")
    if rng.random() < 0.3:
        lines.append(f"profile {rng.choice(['constant', 'quintic', 'cubic'])}")
    body = []
    for _ in range(rng.randint(3, 30)):
        if rng.random() < 0.2:
            head = f"stroke {rng.choice(STROKES)} {rng.choice(LIGHTS[:5])}"
            inner = ["  " + statement(rng, inside=True) for _ in range(rng.randint(1, 5))]
            body.append("\n".join([head, *inner, "end"]))
        else:
            body.append(statement(rng))
    for _ in range(faults):
        body.insert(rng.randint(1, len(body)), rng.choice(FAULTS))
    return "\n".join([*lines, *body]) + "\n"

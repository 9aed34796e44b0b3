"""The README's generated tables: `python -m tests.generated` writes them, test_docs compares."""

from pathlib import Path

END = "<!-- end -->"
README = Path(__file__).parent.parent / "README.md"

COLUMNS = {
    "t_s": "time",
    "line": "the line of the drawing that asks for what follows",
    "lit": "1 while the light shines until the next row",
    "desired_x_m, desired_y_m, desired_z_m": "asked place",
    "desired_qw, desired_qx, desired_qy, desired_qz": "asked orientation, scalar first",
    "x_m, y_m, z_m": "measured place",
    "qw, qx, qy, qz": "measured orientation",
    "position_error_m": "distance from the asked place",
    "orientation_error_rad": "angle from the asked orientation",
    "invariant_error": "norm of 1 - x* x_d",
    "speed_m_s": "of the light, until the next row",
    "acceleration_m_s2": "of the light",
    "effort_rad": "how far the joints move until the next row",
    "manipulability": "square root of det(J J')",
    "q1_rad ...": "joint angles",
    "command1_rad_s ...": "joint rates the arm is given",
}


def table(heads, rows):
    lines = ["| " + " | ".join(heads) + " |", "|" + "---|" * len(heads)]
    return "\n".join(lines + ["| " + " | ".join(row) + " |" for row in rows])


def statements():
    from dqpaint.language.words import STATEMENTS

    rows = [
        [f"`{s.word}`", s.says, " ".join(s.parts), f"`{s.example}`"] for s in STATEMENTS.values()
    ]
    return table(["statement", "what it says", "its parts", "for example"], rows)


def parts():
    from dqpaint.language.words import PARTS

    rows = [[f"`{p.word}`", p.says, f"`{p.example}`"] for p in PARTS.values()]
    return table(["part", "what it says", "for example"], rows)


def values():
    from dqpaint.language.units import UNITS
    from dqpaint.language.words import CONSTANTS, FUNCTIONS, LAWS

    ends = {0: "", 2: "(v0, v1)", 4: "(v0, v1, a0, a1)"}  # rates and accelerations at the ends
    laws = [f"{name}{ends[count]}" for name, counts in LAWS.items() for count in counts]
    kinds = {
        "units": [f"`{u}`" for u in UNITS],
        "constants": [f"`{c}`" for c in CONSTANTS],
        "laws": [f"`{law}`" for law in laws],
        "functions": [f"`{call}`" for call in FUNCTIONS.values()],
    }
    return table(["", ""], [[kind, " ".join(words)] for kind, words in kinds.items()])


def controllers():
    from dqpaint.controllers import CONTROLLERS

    rows = [[f"`{c.name}`", c.summary, c.list_gains(), c.source] for c in CONTROLLERS.values()]
    return table(["name", "what it does", "gains", "from"], rows)


def robots():
    from dqpaint.robots.card import card_names, read_card

    cards = [read_card(name) for name in card_names()]
    rows = [[f"`{c.name}`", c.title, str(c.joints), c.origin] for c in cards]
    return table(["robot", "", "joints", "from"], rows)


def plants():
    from dqpaint.plants import PLANTS

    return table(["plant", ""], [[f"`{n}`", p.__doc__.splitlines()[0]] for n, p in PLANTS.items()])


def columns():
    return table(["column", ""], [[f"`{name}`", about] for name, about in COLUMNS.items()])


TABLES = [statements, parts, values, controllers, robots, plants, columns]


def renewed(text):
    for make in TABLES:
        mark = f"<!-- {make.__name__} -->"
        before, found, rest = text.partition(mark)
        assert found, mark
        after = rest[rest.index(END) :]
        text = f"{before}{mark}\n{make()}\n{after}"
    return text


if __name__ == "__main__":
    README.write_text(renewed(README.read_text("utf-8")), "utf-8")

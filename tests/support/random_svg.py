"""Random SVG drawings, made for tests."""

import random

from tests.support.svg import WITH

COLOURS = ("red", "#0f0", "#123456", "rgb(51, 77, 230)", "currentColor", "none")
SHEET = "<style>.a { stroke: lime } .b{fill:#00f;stroke-opacity:.9} rect{fill:aqua}</style>"


class Made:
    """Makes one drawing of many kinds of elements."""

    def __init__(self, seed: int) -> None:
        self.chance = random.Random(seed)
        self.ids: list[str] = []

    def number(self, least: float = -50, most: float = 50) -> str:
        return f"{self.chance.uniform(least, most):.3f}"

    def numbers(self, count: int, least: float = -50, most: float = 50) -> str:
        return " ".join(self.number(least, most) for _ in range(count))

    def often(self, share: float) -> bool:
        return self.chance.random() < share

    def transform(self) -> str:
        made = [
            self.chance.choice(
                (
                    f"translate({self.numbers(2)})",
                    f"translate({self.number()})",
                    f"rotate({self.number(-180, 180)})",
                    f"rotate({self.numbers(3, -180, 180)})",
                    f"scale({self.number(0.3, 2)})",
                    f"scale({self.number(0.3, 2)},{self.number(-2, -0.3)})",
                    f"skewX({self.number()})",
                    f"skewY({self.number()})",
                    f"matrix({self.numbers(6, -2, 2)})",
                )
            )
            for _ in range(self.chance.randint(1, 3))
        ]
        return f'transform="{" ".join(made)}"'

    def style(self) -> list[str]:
        made = [self.transform()] if self.often(0.4) else []
        for name, share in (("stroke", 0.5), ("fill", 0.3)):
            if self.often(share):
                value = self.chance.choice(COLOURS)
                made.append(f'{name}="{value}"' if self.often(0.6) else f'style="{name}: {value}"')
        if self.often(0.15):
            made.append(f'{self.chance.choice(("stroke", "fill"))}-opacity="{self.number(0, 1)}"')
        if self.often(0.1):
            made.append(f'visibility="{self.chance.choice(("hidden", "visible", "collapse"))}"')
        if self.often(0.05):
            made.append('display="none"')
        if self.often(0.3):
            made.append(f'class="{self.chance.choice("ab")}"')
        named = {one.partition("=")[0]: one for one in made}  # each of them once
        return list(named.values())

    def shape(self) -> tuple[str, list[str]]:
        tag = self.chance.choice(
            ("path", "line", "polyline", "polygon", "rect", "circle", "ellipse")
        )
        own = []
        if tag == "path":
            letters = self.chance.choices("LHVCQZMlhvcqzm", k=4)
            counts = {"l": 2, "m": 2, "h": 1, "v": 1, "c": 6, "q": 4, "z": 0}
            data = "".join(one + self.numbers(counts[one.lower()]) for one in letters)
            own = [f'd="M{self.numbers(2)}{data}"']
        elif tag in ("polyline", "polygon"):
            own = [f'points="{self.numbers(2 * self.chance.randint(1, 5))}"']
        places = {"line": "x1 y1 x2 y2", "rect": "x y", "circle": "cx cy", "ellipse": "cx cy"}
        for name in places.get(tag, "").split():
            own += [f'{name}="{self.number()}"'] if self.often(0.9) else []
        for name in {"rect": "width height", "circle": "r", "ellipse": "rx ry"}.get(
            tag, ""
        ).split():
            own.append(f'{name}="{self.number(20)}"')
        if tag == "rect" and self.often(0.3):
            own.append(f'rx="{self.number(1, 9)}"')
        return tag, own

    def element(self, depth: int) -> str:
        within, tag, own = "", "use", []
        if self.ids and self.often(0.25):
            link = self.chance.choice(("href", "xlink:href"))
            own = [f'{link}="#{self.chance.choice(self.ids)}"']
            own += [f'{name}="{self.number()}"' for name in "xy" if self.often(0.6)]
        elif depth == 0 or self.often(0.4):
            tag, own = self.shape()
        else:
            tag = self.chance.choice(("g", "g", "g", "a", "defs", "symbol"))
            within = "".join(self.element(depth - 1) for _ in range(self.chance.randint(1, 4)))
        own += self.style()
        if tag != "defs" and self.often(0.4):  # which shows nothing by a `use`
            own.append(f'id="i{len(self.ids)}"')
            self.ids.append(f"i{len(self.ids)}")
        made = f"<{tag} {' '.join(own)}>{within}</{tag}>\n"
        return f"<defs>{made}</defs>" if tag == "symbol" else made

    def text(self) -> str:
        root = 'width="2000" height="1000" viewBox="-30 40 500 250" color="#a04000"'
        body = "".join(self.element(4) for _ in range(8))
        return f"{WITH.format(root)}{SHEET}\n{body}</svg>"


class Placed(Made):
    """Makes drawings of one line, within viewports and what a `use` shows of them."""

    def view(self) -> str:
        words = ("none", "xMinYMax", "xMaxYMid slice", "xMidYMin meet", "xMaxYMax slice", "else")
        box = f'viewBox="{self.numbers(2)} {self.numbers(2, 20, 100)}" ' if self.often(0.6) else ""
        ratio = f'preserveAspectRatio="{self.chance.choice(words)}"' if self.often(0.6) else ""
        return box + ratio

    def lengths(self, names: str, least: float) -> str:
        made = [
            f'{name}="{self.number(least)}{self.chance.choice(("", "%"))}"'
            for name in names.split()
        ]
        return " ".join(one for one in made if self.often(0.6))

    def place(self) -> str:
        return f"{self.lengths('x y', -50)} {self.lengths('width height', 10)}"

    def transform(self) -> str:
        one = (f"translate({self.numbers(2)})", "scale(-1.5)", f"scale({self.numbers(2, 0.5, 2)})")
        return f'transform="{self.chance.choice(one)}"' if self.often(0.3) else ""

    def element(self, depth: int) -> str:
        if depth == 0:
            return f'<line {self.lengths("x1 y1", -50)} x2="60" y2="{self.number(60, 90)}%"/>'
        within = self.element(depth - 1)
        tag = self.chance.choice(("g", "svg", "symbol", "used", "used"))
        if tag == "g":
            return f"<g {self.transform()}>{within}</g>"
        if tag == "svg":
            return f"<svg {self.place()} {self.view()}>{within}</svg>"
        name, tag = (
            f"k{self.chance.random()}",
            tag.replace("used", self.chance.choice(("g", "svg"))),
        )
        own = self.transform() if tag == "g" else f"{self.place()} {self.view()}"
        hidden = self.chance.choice(("<defs>{}</defs>", '<g display="none">{}</g>'))
        self.ids.append(hidden.format(f'<{tag} id="{name}" {own}>{within}</{tag}>'))
        return f'<use href="#{name}" {self.place()} {self.transform()}/>'

    def text(self) -> str:
        body = self.element(self.chance.randint(1, 5))
        size = f'width="{self.number(100, 300)}" height="{self.number(100, 300)}" {self.view()}'
        root = WITH.format(f'stroke="red" style="overflow:visible" {size}')
        return f'{root}{"".join(self.ids)}<g class="all">{body}</g></svg>'


class Styled(Made):
    """Makes drawings of paths in groups, with paints of all kinds."""

    def element(self, depth: int) -> str:
        within = "".join(self.element(depth - 1) for _ in range(3)) if depth else ""
        tag, own = "g" if depth else "path", []
        for name, values in {
            **dict.fromkeys(("stroke", "fill"), (*COLOURS, "inherit", "blu", "#12345680", "")),
            "color": (*COLOURS[:4], "CurrentColor", "inherit"),
            **dict.fromkeys(
                ("stroke-opacity", "fill-opacity", "opacity"), (".5", "30%", "2", "0.8")
            ),
            "visibility": ("hidden", "visible", "inherit", "collapse", "else"),
            "class": ("a", "b", "a b"),
        }.items():
            if self.often(0.25):
                value = self.chance.choice(values)
                own.append(f'{name}="{value}"' if self.often(0.6) else f'style="{name}: {value}"')
        named = {one.partition("=")[0]: one for one in own}  # each of them once
        return f"<{tag} {' '.join(named.values())}>{within}</{tag}>"

    def text(self) -> str:
        sheet = (
            "<style>.a{stroke:lime;opacity:.9} path.b{fill:#00f!important} .b{color:red}</style>"
        )
        return f"{WITH.format('')}{sheet}{self.element(3)}</svg>"

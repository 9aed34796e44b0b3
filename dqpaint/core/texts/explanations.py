"""The docstring of a registered thing -> its explanation: equations, idea, limits, what to try.

The first line says what it does. Behind `Equation:` stand its equations, one a line, written as
`mathematics` reads them; behind `Idea:` up to three lines; behind `Error:`, of a law,
where its error is taken; behind `Stable:` when it is; behind `Fails:` when it does not do what one
might expect; behind `Try:` commands to type. What stands behind a label is indented.
"""

import inspect
import re
from collections.abc import Mapping
from dataclasses import dataclass

LABEL = re.compile(r"(Equation|Idea|Error|Stable|Fails|Try):\s*$")


@dataclass(frozen=True)
class Sections:
    """A docstring taken apart.

    Attributes:
        summary: its first line.
        equations: one each.
        texts: the other sections by their labels in lower case, each as one paragraph.
        try_: commands to type, one each.
    """

    summary: str
    equations: tuple[str, ...]
    texts: Mapping[str, str]
    try_: tuple[str, ...]

    def missing(self, labels: tuple[str, ...]) -> list[str]:
        """Those of some labels that are not there."""
        there = {"equation": self.equations, "try": self.try_, **self.texts}
        return [label for label in labels if not there.get(label)]


def read_sections(docstring: str | None) -> Sections:
    """The sections of a docstring; nothing is refused."""
    first, *rest = inspect.cleandoc(docstring or "").splitlines() or [""]
    found: dict[str, list[str]] = {}
    label = ""
    for line in rest:
        if head := LABEL.match(line):
            label = head[1].lower()
        elif line.strip() and not line.startswith(" "):
            label = ""
        elif label and line.strip():
            found.setdefault(label, []).append(line.strip())
    equations, commands = (tuple(found.pop(name, ())) for name in ("equation", "try"))
    texts = {name: " ".join(lines) for name, lines in found.items()}
    return Sections(first.strip(), equations, texts, commands)

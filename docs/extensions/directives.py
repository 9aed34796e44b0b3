"""`{traj}` and `{picture}`: a text or a command -> its picture, and what dqpaint says."""

import json
import shlex
from typing import Any, ClassVar

from docutils import nodes
from docutils.parsers.rst import directives
from sphinx.util.docutils import SphinxDirective

from extensions import made

SIZE = ("--size", "480x270")


class Traj(SphinxDirective):
    """A drawing beside its reference picture, or beside the message that it gets.

    `wrong` says that `check` has to refuse it or to warn; otherwise it has to find nothing worse
    than a warning. `view` is that of `preview`, `beside` a JSON object of files by their names.
    """

    has_content = True
    option_spec: ClassVar[dict[str, Any]] = {
        "view": directives.unchanged,
        "wrong": directives.flag,
        "quiet": directives.flag,
        "beside": directives.unchanged,
    }

    def run(self) -> list[nodes.Node]:
        """The text, and its picture or what is said."""
        text = "\n".join(self.content) + "\n"
        files = json.loads(self.options.get("beside", "{}"))
        view = ("--view", self.options["view"]) if "view" in self.options else ()
        result = made.of_drawing(text, files, (*SIZE, *view))
        wrong = "wrong" in self.options
        if wrong and not any(f"[{kind}" in result.said for kind in "EW"):
            raise self.error(f"nothing is wrong here: {text}")
        if result.code and not wrong:
            raise self.error(f"this is no drawing: {result.said}")
        code = nodes.literal_block(text, text, language="traj")
        shown: list[nodes.Node] = [code]
        for name, data in files.items():
            if name in text:
                shown.append(
                    nodes.literal_block(data, f"{name} beside it:\n\n{data}", language="none")
                )
        if result.picture and not (wrong and "quiet" in self.options):
            shown.append(_picture(result.picture, "what this drawing is seen as"))
        if wrong or "[W" in result.said:
            shown.append(nodes.literal_block(result.said, result.said, language="none"))
        return [_beside(shown, "traj wrong" if wrong else "traj")]


class Picture(SphinxDirective):
    """A command, and the picture that it writes."""

    has_content = True

    def run(self) -> list[nodes.Node]:
        """The command and its picture."""
        line = " ".join(self.content)
        result = made.of_command(tuple(shlex.split(line)[1:]))
        if result.code or not result.picture:
            raise self.error(f"{line}: {result.said or 'writes no picture'}")
        text = f"$ {line}"
        return [_beside([nodes.literal_block(text, text, language="console"),
                         _picture(result.picture, line)], "command")]  # fmt: skip


def _picture(name: str, alternative: str) -> nodes.Node:
    return nodes.image(uri=f"/generated/pictures/{name}", alt=alternative)


def _beside(shown: list[nodes.Node], kind: str) -> nodes.Node:
    return nodes.container("", *shown, classes=["shown", *kind.split()])

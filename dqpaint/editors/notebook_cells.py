"""A notebook's `%%traj` cell -> its painting, or its reference picture.

After `%load_ext dqpaint` a cell that begins with `%%traj` is a drawing. Options stand behind it, as
those of the command line: `%%traj --controller hinf --size 640x360`. Without an option of a run the
reference picture is shown.
"""

import shlex
import sys
from typing import Any

from dqpaint import api
from dqpaint.errors import DqpaintError, UsageError
from dqpaint.settings import COMMANDS, SETTINGS, check_keywords, settings_of

KEYWORDS = {setting.name: keyword for keyword, setting in SETTINGS.items()}
"""The keyword in Python of each option."""


def traj(line: str, cell: str) -> Any:
    """The `Painting` or `Preview` of a cell; None, with the message, if it has a fault.

    Args:
        line: options, each `--name value`, or `--name` alone for yes.
        cell: the drawing.
    """
    try:
        choices = read_options(line)
        check_keywords("%%traj", choices, SETTINGS.values(), ["settings"])
        of_preview = {setting.keyword for setting in settings_of(*COMMANDS["preview"])}
        make = api.preview if choices.keys() <= {*of_preview, "settings"} else api.draw
        return make(text=cell, **choices)
    except DqpaintError as problem:
        print(problem, file=sys.stderr)
        return None


def read_options(line: str) -> dict[str, Any]:
    """The keywords that options stand for; one that is repeated has a list.

    Raises:
        UsageError: a word that is no option, or a quote that is not closed.
    """
    found: dict[str, Any] = {}
    try:
        words = shlex.split(line)
    except ValueError as problem:
        raise UsageError(f"%%traj {line}: {str(problem).lower()}") from None
    while words:
        word = words.pop(0)
        if not word.startswith("--"):
            raise UsageError(f"'{word}' is no option; %%traj takes --name value")
        name, sign, value = word[2:].partition("=")
        if not sign:
            value = words.pop(0) if words and not words[0].startswith("--") else ""
        keyword = KEYWORDS.get(name, name.replace("-", "_"))
        given: Any = value or True
        if keyword in found:
            before = found[keyword]
            given = [*(before if isinstance(before, list) else [before]), given]
        found[keyword] = given
    return found


def load_ipython_extension(shell: Any) -> None:
    """Register `%%traj` with a shell of IPython."""
    shell.register_magic_function(traj, "cell", "traj")

r"""Light paintings by a simulated robot arm.

::

    text -language-> Program -motion-> Motion -simulation-> Track -painting-> Film -> png
                                          |                   \-metrics-> csv, json
                                          \-painting-> the reference picture, without an arm

The rooms, in the order in which data moves through them:

`dq` is the algebra and its conventions, `errors` what is raised, `core` registries and files.
`diagnostics` are messages at their place in a text. `language` compiles a text to a `program`,
`settings` hold every other choice, `motion` is the reference at every sample in closed form.
`robots` are the arms, `plants` how they answer a command, `disturbances` what no law knows of,
`controllers` the laws, and `simulation` closes the loop. `light` integrates emitted light to a
picture and knows no robot; `render` puts the arm before the camera. `planning` says beforehand what
an arm will meet, `metrics` measure a run. `painting` is the whole flow as one function, `outputs`
are the files, also for real arms. `api` is all of it from Python; `studies` are many paintings and
what they show together, `testing` what a plugin is held to, `editors` the language in editors,
`cli` the command line.

Data moves along this line and never back; each room is entered by what its `__init__` names. The
contracts in pyproject.toml and `tests/test_architecture.py` hold the code to both.
"""

import importlib
from typing import TYPE_CHECKING, Any

from dqpaint.errors import DqpaintError

if TYPE_CHECKING:
    from dqpaint.api import develop, draw, preview, save
    from dqpaint.language.writing.builder import Drawing
    from dqpaint.painting.paint import Painting
    from dqpaint.studies.api import compare, replay, study, sweep, tune, verify
    from dqpaint.studies.plot import plot

__version__ = "0.1.0"

__all__ = [
    "DqpaintError",
    "Drawing",
    "Painting",
    "compare",
    "develop",
    "draw",
    "plot",
    "preview",
    "replay",
    "save",
    "study",
    "sweep",
    "tune",
    "verify",
]


_ROOMS = {
    "Drawing": "dqpaint.language.writing.builder",
    "Painting": "dqpaint.painting.paint",
    "develop": "dqpaint.api",
    "draw": "dqpaint.api",
    "load_ipython_extension": "dqpaint.editors.notebook_cells",
    "plot": "dqpaint.studies.plot",
    "preview": "dqpaint.api",
    "save": "dqpaint.api",
    **dict.fromkeys(
        ("compare", "replay", "study", "sweep", "tune", "verify"), "dqpaint.studies.api"
    ),
}


def __getattr__(name: str) -> Any:
    """Import on first use: the command line must start without the simulator."""
    room = _ROOMS.get(name)
    if room is not None:
        return getattr(importlib.import_module(room), name)
    raise AttributeError(f"module 'dqpaint' has no attribute '{name}'")


def __dir__() -> list[str]:
    return sorted({*globals(), *__all__})

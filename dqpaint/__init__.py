r"""Light paintings by a simulated robot arm.

    text -parse-> Program -plan-> Motion -track-> Track -shine-> Light -expose-> Film -develop-> png
                                     |               \-measure-> Metrics -> csv, json
                                     \-shine-> the asked picture, without an arm

`language` reads the text, `motion` says what is asked at every sample, `controllers` turn what is
seen into a command, `robots` know the arms, `plants` answer as an arm does, `disturbances` are what
no law knows of, `driving` tells the plant what the law says, `tracking` closes the loop, `metrics`
measure, `shining` and `scene` say what shines and `light` takes its pictures, `stage` puts the arm
before the camera, `paint` is the flow as one function, `sketch` the same without an arm, `forecast`
what the arm says beforehand, `negative` what is kept to develop again, `exports` what a real arm is
given. `studies` are many paintings and what they say together, `papers` the published numbers to
compare them with, `cli` and `studying` the command line. `dq` holds the algebra and its
conventions, `outputs` the files. Data moves along this line and never back: `tests/test_house.py`
holds the modules to it.
"""

import importlib
from typing import TYPE_CHECKING, Any

from dqpaint.errors import DqpaintError

if TYPE_CHECKING:
    from dqpaint.api import develop, draw, preview, save
    from dqpaint.language.writing.builder import Drawing
    from dqpaint.painting.paint import Painting
    from dqpaint.studies.api import compare, sweep, tune, verify

__version__ = "0.1.0"

__all__ = [
    "DqpaintError",
    "Drawing",
    "Painting",
    "compare",
    "develop",
    "draw",
    "preview",
    "save",
    "sweep",
    "tune",
    "verify",
]


_ROOMS = {
    "Drawing": "dqpaint.language.writing.builder",
    "Painting": "dqpaint.painting.paint",
    "develop": "dqpaint.api",
    "draw": "dqpaint.api",
    "preview": "dqpaint.api",
    "save": "dqpaint.api",
    **dict.fromkeys(("compare", "sweep", "tune", "verify"), "dqpaint.studies.api"),
}


def __getattr__(name: str) -> Any:
    """Import on first use: the command line must start without the simulator."""
    room = _ROOMS.get(name)
    if room is not None:
        return getattr(importlib.import_module(room), name)
    raise AttributeError(f"module 'dqpaint' has no attribute '{name}'")


def __dir__() -> list[str]:
    return sorted({*globals(), *__all__})

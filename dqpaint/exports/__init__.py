"""To a real arm: what was executed, as a time-stamped joint trajectory, and the light beside it.

A painting comes in, files go out. A new format is a function in a new file of this folder under
`@FORMATS.add(name)`: a `Trajectory` in, the ending of its file and its text out.
"""

import importlib
import pkgutil

from dqpaint.exports.files import files_of
from dqpaint.exports.trajectory import FORMATS, Trajectory

for _module in pkgutil.iter_modules(__path__):
    importlib.import_module(f"{__name__}.{_module.name}")

__all__ = ["FORMATS", "Trajectory", "files_of"]

"""How a replay's numbers come about here: one function a kind, in a file of its own.

What comes in is a paper's experiment (`dqpaint.studies.replay.papers`) and what a person asked
for; what goes out is `Measured`: numbers by the names of cell and figure, and files. A new kind
registers under `@MEASURES.add(name)`; a paper's TOML says which one it needs.
"""

import importlib
import pkgutil

from dqpaint.studies.replay.measure import MEASURES, Asked, Measured

for _module in pkgutil.iter_modules(__path__):
    importlib.import_module(f"{__name__}.{_module.name}")

__all__ = ["MEASURES", "Asked", "Measured"]

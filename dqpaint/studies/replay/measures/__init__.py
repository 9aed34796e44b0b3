"""A paper's experiment -> its numbers here; one measure a file.

What comes in is an experiment (`studies.replay.papers`) and what was asked for; what goes out is
`MeasureResult`: numbers by the names of cell and figure, and files. A new measure registers under
`@MEASURES.add(name)`; a paper's TOML says which one it needs.
"""

import importlib
import pkgutil

from dqpaint.studies.replay.measure import MEASURES, MeasureRequest, MeasureResult

for _module in pkgutil.iter_modules(__path__):
    importlib.import_module(f"{__name__}.{_module.name}")

__all__ = ["MEASURES", "MeasureRequest", "MeasureResult"]

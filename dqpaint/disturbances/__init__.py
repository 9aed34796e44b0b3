"""What a run meets that no law knows of; all off by default, all repeatable by the seed.

A new disturbance is a model in a new file of this folder under `@DISTURBANCES.add(name)`; it is
found by itself. It brings what `disturbance.Disturbance` lists.
"""

import importlib
import pkgutil

from dqpaint.disturbances.disturbance import DISTURBANCES, Disturbance, make_disturbances

for _module in pkgutil.iter_modules(__path__):
    importlib.import_module(f"{__name__}.{_module.name}")

__all__ = ["DISTURBANCES", "Disturbance", "make_disturbances"]

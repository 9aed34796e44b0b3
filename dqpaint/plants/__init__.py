"""How an arm answers a command. PyBullet is met here and nowhere else.

A new plant is a class in a new file of this folder under `@PLANTS.add(name)`; it is found by
itself. It brings what `plant.Plant` lists.
"""

import importlib
import pkgutil

from dqpaint.plants.plant import PLANTS, Plant, choose_plant

for _module in pkgutil.iter_modules(__path__):
    importlib.import_module(f"{__name__}.{_module.name}")

__all__ = ["PLANTS", "Plant", "choose_plant"]

"""How an arm answers a command. PyBullet is met here and nowhere else.

A new plant is a class in a new file of this folder under `@PLANTS.add(name)`; it is found by
itself. It brings what `plant.Plant` lists.
"""

from dqpaint.plants.plant import PLANTS, Plant, choose_plant

__all__ = ["PLANTS", "Plant", "choose_plant"]

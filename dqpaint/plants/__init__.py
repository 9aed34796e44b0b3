"""Commands -> the arm's answer: joint angles, rates and torques after each control period.

A new plant is a class in a new file of this folder under `@PLANTS.add(name)`; it is found by
itself and brings what `plant.Plant` lists.
"""

from dqpaint.plants.engines import ENGINES, Engine, available_engines, choose_engine
from dqpaint.plants.ideal import Ideal
from dqpaint.plants.plant import (
    DEFAULT_PLANTS, PLANTS, ConfiguredPlant, Plant, PlantMaker, PlantOptions, Takes, Trait,
    as_plant_maker, choose_plant, find_plant,
)
from dqpaint.plants.world import UNDISTURBED, ForceCourse, Payload, Push, World, pushes_at

__all__ = [
    "DEFAULT_PLANTS", "ENGINES", "PLANTS", "UNDISTURBED", "ConfiguredPlant", "Engine",
    "ForceCourse", "Ideal", "Payload", "Plant", "PlantMaker", "PlantOptions", "Push", "Takes",
    "Trait", "World", "as_plant_maker", "available_engines", "choose_engine", "choose_plant",
    "find_plant", "pushes_at",
]

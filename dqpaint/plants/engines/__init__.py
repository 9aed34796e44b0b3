"""The name of a physics engine -> the rigid bodies of a card's arm, simulated by it.

Plants say what motors do; an engine says how bodies answer. It is a class that has what
`bodies.Bodies` lists, a line in `choice.ENGINES`, and the door to its library.
"""

from dqpaint.plants.engines.bodies import STOP_DISTANCE, Bodies
from dqpaint.plants.engines.choice import (
    ENGINES, Engine, EngineName, available_engines, choose_engine,
)

__all__ = [
    "ENGINES", "STOP_DISTANCE", "Bodies", "Engine", "EngineName", "available_engines",
    "choose_engine",
]

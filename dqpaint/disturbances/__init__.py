"""Options and a seed -> disturbances of a run that no law knows: errors of arm and world.

All are off by default and repeatable by their seed. A new disturbance is a model in a new file of
this folder under `@DISTURBANCES.add(name)`; it is found by itself and brings what
`disturbance.Disturbance` lists.
"""

from dqpaint.disturbances.disturbance import (
    DISTURBANCES, Disturbance, Encoder, find_files, kind_of, make_disturbances,
)

__all__ = [
    "DISTURBANCES", "Disturbance", "Encoder", "find_files", "kind_of", "make_disturbances",
]

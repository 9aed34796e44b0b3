"""What a run meets that no law knows of; all off by default, all repeatable by the seed.

A new disturbance is a model in a new file of this folder under `@DISTURBANCES.add(name)`; it is
found by itself. It brings what `disturbance.Disturbance` lists.
"""

from dqpaint.disturbances.disturbance import DISTURBANCES, Disturbance, make_disturbances

__all__ = ["DISTURBANCES", "Disturbance", "make_disturbances"]

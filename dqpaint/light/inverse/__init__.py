"""A wanted picture and a lamp's path -> the energies along it whose developed picture that is.

`exposing` is the film's own deposit and spread as a linear map and its transpose, `developing` the
film's curve and its slope, `solving` the optimiser, `likeness` what is reached.
"""

from dqpaint.light.inverse.developing import developed, light_for
from dqpaint.light.inverse.exposing import Box, Exposing, boxed
from dqpaint.light.inverse.likeness import Likeness, likeness, seen_through
from dqpaint.light.inverse.solving import WHITE, Solution, solve

__all__ = [
    "WHITE", "Box", "Exposing", "Likeness", "Solution", "boxed", "developed", "light_for",
    "likeness", "seen_through", "solve",
]

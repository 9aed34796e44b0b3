"""Light sent to a camera -> linear film -> image spread by the lens -> developed picture.

A new look is a function in `looks` under `@LOOKS.add(name)`.
"""

from dqpaint.light.film.auto_exposure import automatic_exposure, line_exposure
from dqpaint.light.film.discs import DIAMETER_RATIO
from dqpaint.light.film.film import PAD, Film, FilmAccumulator, expose
from dqpaint.light.film.looks import LOOKS, with_noise
from dqpaint.light.film.point_spread import REFERENCE_HEIGHT, point_spread, spread
from dqpaint.light.film.starburst import BLADE_RANGE, with_starburst

__all__ = [
    "BLADE_RANGE", "DIAMETER_RATIO", "LOOKS", "PAD", "REFERENCE_HEIGHT", "Film", "FilmAccumulator",
    "automatic_exposure", "expose",
    "line_exposure", "point_spread", "spread", "with_noise", "with_starburst",
]

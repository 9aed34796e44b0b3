"""A brush -> whether its light is described, repeated, and all on the film or accounted for."""

import numpy as np

from dqpaint import dq
from dqpaint.brushes import BRUSHES, Brush, Emitters, describe_fields
from dqpaint.core import subclass
from dqpaint.dq import Floats
from dqpaint.light.camera import Camera, View, frame_points
from dqpaint.light.film import Film, expose
from dqpaint.light.sources import Sweep
from dqpaint.testing.runs import require

SAMPLES = 120
PERIOD = 0.01  # [s]
COLOUR = (1.0, 0.6, 0.2)
BALANCE = 1e-9  # of the light
VIEWS = (View(0.0, 0.0), View(20.0, 15.0), View(200.0, -40.0))


def check_brush(brush: str | type[Brush], even: bool = True) -> None:
    """Check what every brush promises, at its default values.

    Every value has a default and a description; what is emitted is on the film or counted as lost,
    seen from several sides and with a strobe; two exposures have the same bits; a standing light
    loses nothing; and, unless it paints an image, it gives as much light as one lamp.

    Args:
        brush: its name, or its model.
        even: whether it should give as much light as one lamp.

    Raises:
        AssertionError: a promise that is not kept.
    """
    model = BRUSHES[brush] if isinstance(brush, str) else subclass(Brush, "brush", brush)
    require(bool((model.__doc__ or "").strip()), "a brush has a docstring")
    for name, field in model.model_fields.items():
        require(bool(field.description), f"its value '{name}' has a description")
        require(not field.is_required(), f"its value '{name}' has a default")
    require(len(describe_fields(model)) == len(model.model_fields), "its values can be listed")
    emitters = model.model_validate({}).emitters()
    if even:
        total = emitters.tints.sum(axis=1)
        require(bool(np.allclose(total, 1.0, rtol=1e-12)), f"it gives the light of {total} lamps")
    for strobe in (None, np.tile((37.0, 0.3), (SAMPLES - 1, 1))):
        sweep = Sweep(PERIOD, screw(), _colours(), emitters, strobe=strobe)
        for view in VIEWS:
            camera = frame_points(sweep.lit_points, np.eye(3), view, (160, 90))
            _check_balance(expose(sweep, camera))
    _check_bits(sweep, camera)
    _check_still(emitters)


def screw() -> Floats:
    """Poses (N, 8) of a screw about a slanted line, off the origin, from a general orientation."""
    u = np.linspace(0, 1, SAMPLES)
    twist = np.array([0.4, -1.2, 2.2, 0.1, 0.05, 0.15])
    begin = dq.pose_from([0.5, -0.1, 0.4], np.array([0.8, 0.2, -0.4, 0.4]))
    return np.asarray(dq.mul(dq.exp(0.5 * u[:, None] * twist), begin))


def _colours() -> Floats:
    return np.tile(COLOUR, (SAMPLES - 1, 1))


def _check_balance(film: Film) -> None:
    found, sent = film.on_film + film.lost, film.emitted
    require(bool(np.allclose(found, sent, rtol=BALANCE)), f"of {sent} emitted {found} is found")
    require(bool((film.planes >= 0).all()), "light is never negative")
    require(bool((film.on_film > 0).all()), "some of its light is seen")


def _check_bits(sweep: Sweep, camera: Camera) -> None:
    first, second = (expose(sweep, camera).planes for _ in range(2))
    require(np.array_equal(first, second), "two exposures have the same bits")


def _check_still(emitters: Emitters) -> None:
    moving = Sweep(PERIOD, screw(), _colours(), emitters)
    still = Sweep(PERIOD, np.tile(screw()[:1], (SAMPLES, 1)), _colours(), emitters)
    camera = frame_points(moving.lit_points, np.eye(3), VIEWS[1], (640, 360))
    film = expose(still, camera)
    kept = np.allclose(film.on_film, film.emitted, rtol=BALANCE)
    require(bool(kept), "a standing light in the middle of the picture loses nothing")

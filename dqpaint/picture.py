"""Points -> Picture: one way to the film, for what was asked and for what was reached."""

from dataclasses import dataclass

import cv2
import numpy as np
from numpy.typing import NDArray

from dqpaint import dq
from dqpaint.dq import Floats
from dqpaint.errors import DqpaintError
from dqpaint.light.brushes import Light, shine
from dqpaint.light.camera import FILL, Camera, frame, parse_view
from dqpaint.light.develop import develop
from dqpaint.light.exposure import automatic_exposure
from dqpaint.light.film import Film, expose
from dqpaint.light.spread import point_spread, spread
from dqpaint.motion import Motion
from dqpaint.settings import Settings
from dqpaint.stage.staging import Hidden, Staging, account

BESIDE_ARM = 0.45  # of the limiting dimension a drawing takes that leaves room for the arm
SETTLING = 0.25  # [s] in which a jump of the set point counts as drawn

# run lengths suit black ground with dithered halos: smaller and faster than the default search
PNG = [cv2.IMWRITE_PNG_STRATEGY, cv2.IMWRITE_PNG_STRATEGY_RLE]


@dataclass(frozen=True, repr=False, eq=False)
class Picture:
    """A developed picture and the film it came from.

    Attributes:
        image: (H, W, 3) 8-bit sRGB.
        film: the light that fell on it, linear.
        exposure: the factor that was applied to the film, `ev` not included.
        camera: where it was taken from.
        motion: what was asked.
        hidden: what the arm's own body kept from the film; None if that was not traced.
    """

    image: NDArray[np.uint8]
    film: Film
    exposure: float
    camera: Camera
    motion: Motion
    hidden: Hidden | None = None

    @property
    def emitted(self) -> Floats:
        """(3,) what the light gave off: on the film, lost and hidden, linear RGB [lamp s]."""
        return self.film.emitted + (0.0 if self.hidden is None else self.hidden.energy)

    @property
    def png(self) -> bytes:
        """The image as a PNG file."""
        done, data = cv2.imencode(".png", self.image[..., ::-1], PNG)
        if not done:
            raise DqpaintError("the picture could not be encoded as PNG")
        return data.tobytes()

    def _repr_png_(self) -> bytes:
        return self.png


def take(
    motion: Motion, points: Floats, settings: Settings, staging: Staging | None = None
) -> Picture:
    """The long exposure of a light that goes through points (N, 3) in the colours of a motion.

    Camera and exposure are chosen from what was asked, not from the points: so pictures of two
    control laws can be laid over each other.

    Args:
        motion: what was asked.
        points: where the light was.
        settings: size, view, exposure, and whether the arm is seen and hides light.
        staging: the arm; None is a picture without one.
    """
    if not motion.lit.any():
        raise DqpaintError(
            f"{motion.program.name}: no light is on anywhere, so the picture would be black"
        )
    size = (settings.width, settings.height)
    asked = shine(motion.points, _metered(motion), motion.period)
    front = dq.matrix_from_quaternion(motion.front)
    shown = shine(motion.points, motion.light, motion.period).lit_points
    fill = BESIDE_ARM if settings.ghost else FILL
    camera = frame(shown, front, parse_view(settings.view), size, fill)
    psf = point_spread(settings.height)
    exposure = automatic_exposure(asked, camera, psf)
    light, hidden = shine(points, motion.light, motion.period), None
    lights = [(light.points, light.energy)]
    if staging is not None and settings.occlusion and staging.solid:
        light, hidden = _unhidden(light, camera, staging, motion)
    film = expose(light, camera)
    image = spread(film, psf)
    if staging is not None and settings.ghost:
        image += staging.photograph(camera, lights, exposure)
    return Picture(develop(image, exposure, settings.ev), film, exposure, camera, motion, hidden)


def _unhidden(
    light: Light, camera: Camera, staging: Staging, motion: Motion
) -> tuple[Light, Hidden]:
    """What of a light the arm's own body lets through, and the rest."""
    time = np.asarray((0.5 + np.arange(len(light.energy))) * motion.period)
    lit = np.asarray(light.energy.any(axis=1))
    middle = 0.5 * (light.points[1:] + light.points[:-1])
    seen = staging.visible(time, middle[:, None], lit, camera.position)
    hidden = light.energy * (1.0 - seen)
    return Light(light.points, light.energy * seen), account(hidden, light.energy, motion.line[:-1])


def _metered(motion: Motion) -> Floats:
    """The colours (N, 3) the exposure is chosen from.

    A set point that jumps leaves no line, but the arm that follows it does: the jump counts as a
    line drawn in `SETTLING`.
    """
    weight = np.where(motion.jump, SETTLING / motion.period, 1.0)
    return np.asarray(motion.light * weight[:, None])

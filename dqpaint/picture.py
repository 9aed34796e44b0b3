"""Points -> Picture: one way to the film, for what was asked and for what was reached."""

from dataclasses import dataclass

import cv2
import numpy as np
from numpy.typing import NDArray

from dqpaint import dq
from dqpaint.dq import Floats
from dqpaint.errors import DqpaintError
from dqpaint.light.brushes import shine
from dqpaint.light.camera import Camera, frame, parse_view
from dqpaint.light.develop import develop
from dqpaint.light.exposure import automatic_exposure
from dqpaint.light.film import Film, expose
from dqpaint.light.spread import point_spread, spread
from dqpaint.motion import Motion
from dqpaint.settings import Settings

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
    """

    image: NDArray[np.uint8]
    film: Film
    exposure: float
    camera: Camera
    motion: Motion

    @property
    def png(self) -> bytes:
        """The image as a PNG file."""
        done, data = cv2.imencode(".png", self.image[..., ::-1], PNG)
        if not done:
            raise DqpaintError("the picture could not be encoded as PNG")
        return data.tobytes()

    def _repr_png_(self) -> bytes:
        return self.png


def take(motion: Motion, points: Floats, settings: Settings) -> Picture:
    """The long exposure of a light that goes through points (N, 3) in the colours of a motion.

    Camera and exposure are chosen from what was asked, not from the points: so pictures of two
    control laws can be laid over each other.
    """
    if not motion.lit.any():
        raise DqpaintError(
            f"{motion.program.name}: no light is on anywhere, so the picture would be black"
        )
    size = (settings.width, settings.height)
    asked = shine(motion.points, _metered(motion), motion.period)
    front = dq.matrix_from_quaternion(motion.front)
    shown = shine(motion.points, motion.light, motion.period).lit_points
    camera = frame(shown, front, parse_view(settings.view), size)
    psf = point_spread(settings.height)
    exposure = automatic_exposure(asked, camera, psf)
    film = expose(shine(points, motion.light, motion.period), camera)
    image = develop(spread(film, psf), exposure, settings.ev)
    return Picture(image, film, exposure, camera, motion)


def _metered(motion: Motion) -> Floats:
    """The colours (N, 3) the exposure is chosen from.

    A set point that jumps leaves no line, but the arm that follows it does: the jump counts as a
    line drawn in `SETTLING`.
    """
    weight = np.where(motion.jump, SETTLING / motion.period, 1.0)
    return np.asarray(motion.light * weight[:, None])

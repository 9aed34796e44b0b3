"""The film of an exposure: the painting as it grows, frame by frame."""

import os
import sys
import tempfile
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from functools import partial
from itertools import pairwise, repeat
from pathlib import Path

import cv2
import numpy as np
from numpy.typing import NDArray

from dqpaint.errors import DqpaintError
from dqpaint.light import Image
from dqpaint.light.camera import parse_exposure
from dqpaint.light.film import FilmAccumulator
from dqpaint.painting.picture import Picture, beneath, finish, lights_of, linear
from dqpaint.painting.scene import Scene
from dqpaint.render import SceneArm
from dqpaint.settings import Settings

RATE = 25  # frames a second
LONGEST = 10.0  # [s]: a longer painting is shown faster
LEAST = 2.0  # [s]: a shorter one slower
REST = 1.5  # [s] the finished picture is shown
SMALL = 640  # columns of an animation for a page
SLOW_RATE = 12

Told = Callable[[float], None]


def frames(
    scene: Scene,
    picture: Picture,
    settings: Settings,
    count: int,
    progress: Told,
    staging: SceneArm | None = None,
) -> Iterator[NDArray[np.uint8]]:
    """The picture as it grows, (H, W, 3) each; the last frame is the picture itself.

    Each frame adds to the film only what has shone since the one before. The arm, if it is shown,
    stands in each as it stood then, lit by what was painted so far.

    Args:
        scene: what is photographed.
        picture: the finished one.
        settings: of the picture.
        count: of frames.
        progress: called with the part done, 0 to 1.
        staging: the arm; None leaves it out till the end.
    """
    exposing = FilmAccumulator(picture.camera)
    falloff = parse_exposure(settings.exposure or "auto") is not None
    camera, exposure = picture.camera, picture.exposure
    under = beneath(scene, exposure, camera, settings) if scene.under else None
    steps = max(len(sweep.colours) for sweep in scene.light)
    edges = [steps * i // count for i in range(count)]
    arms: Iterator[Image | None] = repeat(None)
    if staging is not None and settings.ghost:
        arms = staging.render_frames(
            camera, partial(lights_of, scene), exposure, falloff, edges[1:]
        )
    for i, (first, last) in enumerate(pairwise(edges)):
        for sweep in picture.light:
            for piece in sweep.emission_to(picture.camera, falloff, slice(first, last)):
                exposing.add(piece)
        image = linear(scene, exposing.film(), exposure, camera, settings, under, next(arms))
        progress((i + 1) / count)
        yield finish(scene, image, picture.exposure, settings)
    yield picture.image


def count_frames(scene: Scene, rate: int) -> int:
    """How many frames the growing takes."""
    return max(2, round(min(max(scene.seconds, LEAST), LONGEST) * rate))


def webm(
    scene: Scene,
    picture: Picture,
    settings: Settings,
    progress: Told,
    staging: SceneArm | None = None,
) -> bytes:
    """A video browsers play: VP9 in WebM; arguments as those of `frames`.

    Raises:
        DqpaintError: This build of OpenCV cannot write it.
    """
    height, width = (
        side - side % 2 for side in picture.image.shape[:2]
    )  # colour has half the rows
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "video.webm"
        fourcc = cv2.VideoWriter.fourcc(*"VP90")
        with _hushed():
            writer = cv2.VideoWriter(str(path), fourcc, float(RATE), (width, height))
        if not writer.isOpened():
            raise DqpaintError("this build of OpenCV has no VP9 encoder for --save video")
        try:
            count = count_frames(scene, RATE)
            for frame in frames(scene, picture, settings, count, progress, staging):
                shown = np.ascontiguousarray(frame[:height, :width, ::-1])
                writer.write(shown)
            for _ in range(round(REST * RATE)):
                writer.write(shown)
        finally:
            writer.release()
        return path.read_bytes()


@contextmanager
def _hushed() -> Iterator[None]:
    """Nothing on standard error: OpenCV's encoder warns there of the tag that WebM itself asks for.

    It writes past Python's streams.
    """
    sys.stderr.flush()
    try:
        kept = os.dup(2)
    except OSError:  # it is closed, so there is nothing to hush
        yield
        return
    with open(os.devnull, "wb") as nowhere:
        os.dup2(nowhere.fileno(), 2)
    try:
        yield
    finally:
        os.dup2(kept, 2)
        os.close(kept)


def webp(
    scene: Scene,
    picture: Picture,
    settings: Settings,
    progress: Told,
    staging: SceneArm | None = None,
) -> bytes:
    """An animation a README shows: WebP, small, over and over; arguments as those of `frames`.

    Raises:
        DqpaintError: This build of OpenCV cannot write it.
    """
    if not hasattr(cv2, "imencodeanimation"):
        raise DqpaintError("this build of OpenCV writes no animated WebP; 4.12 and later do")
    height, width = picture.image.shape[:2]
    scale = min(1.0, SMALL / width)
    size = max(1, round(scale * width)), max(1, round(scale * height))
    count = count_frames(scene, SLOW_RATE)
    shown = [
        cv2.resize(frame[..., ::-1], size, interpolation=cv2.INTER_AREA)
        for frame in frames(scene, picture, settings, count, progress, staging)
    ]
    animation = cv2.Animation()
    animation.frames = shown
    animation.durations = [1000 // SLOW_RATE] * (count - 1) + [round(1000 * REST)]
    done, data = cv2.imencodeanimation(".webp", animation, [cv2.IMWRITE_WEBP_QUALITY, 85])
    if not done:
        raise DqpaintError("the animation could not be encoded as WebP")
    return bytes(np.asarray(data).tobytes())

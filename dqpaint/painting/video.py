"""Scene and finished picture -> a video or animation of the growing picture."""

import os
import shutil
import subprocess
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

from dqpaint.clean_stream import printable
from dqpaint.errors import DqpaintError
from dqpaint.light import Image
from dqpaint.light.camera import parse_exposure
from dqpaint.light.film import FilmAccumulator
from dqpaint.painting.picture import Picture, develop_image, lamp_paths, linear_image, overlay_image
from dqpaint.painting.scene import Scene, with_shutter
from dqpaint.render import SceneArm
from dqpaint.settings import Settings

VIDEO_RATE = 25  # frames a second
LONGEST_VIDEO = 10.0  # [s]: a longer painting is shown faster
SHORTEST_VIDEO = 2.0  # [s]: a shorter one slower
FINAL_TIME = 1.5  # [s] the finished picture is shown
WEBP_WIDTH = 640  # columns of an animation for a page
WEBP_RATE = 12
GIF_DITHER = 3  # -1 for none to 3, OpenCV's finest

Progress = Callable[[float], None]
Frame = NDArray[np.uint8]


def frames(
    scene: Scene,
    picture: Picture,
    settings: Settings,
    count: int,
    progress: Progress,
    scene_arm: SceneArm | None = None,
) -> Iterator[Frame]:
    """The picture as it grows, (H, W, 3) each; the last frame is the picture itself.

    Each frame adds the light since the one before to the film. The arm, if it is shown, has its
    posture of that time, lit by the light so far.

    Args:
        scene: what is photographed.
        picture: the finished one.
        settings: of the picture.
        count: of frames.
        progress: called with the part done, 0 to 1.
        scene_arm: the arm; None leaves it out till the end.
    """
    scene = with_shutter(scene, settings)
    exposing = FilmAccumulator(picture.camera)
    falloff = parse_exposure(settings.exposure or "auto") is not None
    camera, exposure = picture.camera, picture.exposure
    under = overlay_image(scene, exposure, camera, settings) if scene.overlay else None
    steps = max(len(sweep.colours) for sweep in scene.light)
    edges = [steps * i // count for i in range(count)]
    arms: Iterator[Image | None] = repeat(None)
    if scene_arm is not None and settings.ghost:
        arms = scene_arm.render_frames(
            camera, partial(lamp_paths, scene), exposure, falloff, edges[1:]
        )
    for i, (first, last) in enumerate(pairwise(edges)):
        for sweep in picture.light:
            for piece in sweep.emission_to(picture.camera, falloff, slice(first, last)):
                exposing.add(piece)
        image = linear_image(scene, exposing.film(), exposure, camera, settings, under, next(arms))
        progress((i + 1) / count)
        yield develop_image(scene, image, picture.exposure, settings)
    yield picture.image


def count_frames(scene: Scene, rate: int) -> int:
    """The number of frames."""
    return max(2, round(min(max(scene.seconds, SHORTEST_VIDEO), LONGEST_VIDEO) * rate))


def movie(
    scene: Scene,
    picture: Picture,
    settings: Settings,
    progress: Progress,
    scene_arm: SceneArm | None,
    ending: str,
) -> bytes:
    """A movie of the growing picture, encoded.

    Args:
        scene: what is photographed.
        picture: the finished one.
        settings: of the painting.
        progress: called with the part done, 0 to 1.
        scene_arm: the arm, where it is shown.
        ending: of the file, one of `ENCODERS`.

    Raises:
        DqpaintError: this build of OpenCV, or ffmpeg, cannot write it.
    """
    rate, encode = ENCODERS[ending]
    shown = frames(scene, picture, settings, count_frames(scene, rate), progress, scene_arm)
    return encode(shown, picture.image.shape)


def _held(shown: Iterator[Frame], size: tuple[int, int]) -> Iterator[Frame]:
    """The frames as blue, green and red, cut to a size; the last is held."""
    width, height = size
    for frame in shown:
        last = np.ascontiguousarray(frame[:height, :width, ::-1])
        yield last
    yield from repeat(last, round(FINAL_TIME * VIDEO_RATE))


def _even(shape: tuple[int, ...]) -> tuple[int, int]:
    """Width and height of a video: colour has half the rows and columns."""
    height, width = (side - side % 2 for side in shape[:2])
    return width, height


def _vp9(shown: Iterator[Frame], shape: tuple[int, ...], name: str, tag: str) -> bytes:
    size = _even(shape)
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / name
        with _silent_stderr():
            fourcc = cv2.VideoWriter.fourcc(*tag)
            writer = cv2.VideoWriter(str(path), fourcc, float(VIDEO_RATE), size)
        if not writer.isOpened():
            raise DqpaintError(f"this build of OpenCV has no VP9 encoder for a {path.suffix} file")
        try:
            for frame in _held(shown, size):
                writer.write(frame)
        finally:
            writer.release()
        return path.read_bytes()


def _h264(shown: Iterator[Frame], shape: tuple[int, ...], program: str) -> bytes:
    width, height = size = _even(shape)
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "video.mp4"
        command = [
            *(program, "-loglevel", "error", "-f", "rawvideo", "-pix_fmt", "bgr24"),
            *("-video_size", f"{width}x{height}", "-framerate", str(VIDEO_RATE), "-i", "-"),
            *("-c:v", "libx264", "-crf", "18", "-pix_fmt", "yuv420p"),
            *("-movflags", "+faststart", "-y", str(path)),
        ]
        with (
            tempfile.TemporaryFile() as said,
            subprocess.Popen(command, stdin=subprocess.PIPE, stderr=said) as encoder,
        ):
            assert encoder.stdin is not None
            try:
                for frame in _held(shown, size):
                    encoder.stdin.write(frame.tobytes())
                encoder.stdin.close()
                encoder.wait()
            except OSError:  # it ended before its input did, and says why
                encoder.wait()
            except BaseException:
                encoder.kill()
                raise
            said.seek(0)
            why = said.read().decode(errors="replace").strip().rpartition("\n")[2]
        if encoder.returncode or not path.exists():
            raise DqpaintError(
                f"{program} could not write H.264: {printable(why or 'it did not say why')}; "
                "--save video needs no ffmpeg"
            )
        return path.read_bytes()


@contextmanager
def _silent_stderr() -> Iterator[None]:
    """Discard standard error: OpenCV's encoder warns there of the tag that WebM itself requires.

    It writes past Python's streams.
    """
    sys.stderr.flush()
    try:
        kept = os.dup(2)
    except OSError:  # it is closed
        yield
        return
    with open(os.devnull, "wb") as nowhere:
        os.dup2(nowhere.fileno(), 2)
    try:
        yield
    finally:
        os.dup2(kept, 2)
        os.close(kept)


def _mp4(shown: Iterator[Frame], shape: tuple[int, ...]) -> bytes:
    """H.264 by an `ffmpeg` on the search path, which slides play; else VP9."""
    program = shutil.which("ffmpeg")
    if program is not None:
        return _h264(shown, shape, program)
    return _vp9(shown, shape, "video.mp4", "vp09")


def _animation(
    shown: Iterator[Frame], shape: tuple[int, ...], ending: str, how: list[int]
) -> bytes:
    """A small animation that is looped."""
    if not hasattr(cv2, "imencodeanimation"):
        raise DqpaintError(f"this build of OpenCV writes no animated {ending}; 4.12 and later do")
    height, width = shape[:2]
    scale = min(1.0, WEBP_WIDTH / width)
    size = max(1, round(scale * width)), max(1, round(scale * height))
    animation = cv2.Animation()
    animation.frames = [
        cv2.resize(frame[..., ::-1], size, interpolation=cv2.INTER_AREA) for frame in shown
    ]
    still = len(animation.frames) - 1
    animation.durations = [1000 // WEBP_RATE] * still + [round(1000 * FINAL_TIME)]
    done, data = cv2.imencodeanimation(ending, animation, how)
    if not done:
        raise DqpaintError(f"the animation could not be encoded as {ending}")
    return bytes(np.asarray(data).tobytes())


def _gif(shown: Iterator[Frame], shape: tuple[int, ...]) -> bytes:
    return _animation(shown, shape, ".gif", [cv2.IMWRITE_GIF_DITHER, GIF_DITHER])


def _webp(shown: Iterator[Frame], shape: tuple[int, ...]) -> bytes:
    return _animation(shown, shape, ".webp", [cv2.IMWRITE_WEBP_QUALITY, 85])


ENCODERS: dict[str, tuple[int, Callable[[Iterator[Frame], tuple[int, ...]], bytes]]] = {
    ".webm": (VIDEO_RATE, partial(_vp9, name="video.webm", tag="VP90")),
    ".mp4": (VIDEO_RATE, _mp4),
    ".gif": (WEBP_RATE, _gif),
    ".webp": (WEBP_RATE, _webp),
}
"""Frames a second and what encodes them, by the ending of the file."""

"""A painting -> its pictures, its linear film, and movies of the growing picture."""

from collections.abc import Sequence
from typing import TYPE_CHECKING

from dqpaint.outputs.registry import Files, Progress, writer

if TYPE_CHECKING:
    from dqpaint.painting import paint, picture


@writer("png", ".png")
def png(painting: "paint.Painting") -> Files:
    """The pictures, one a view."""
    return encode_pictures(painting.pictures)


def encode_pictures(taken: "Sequence[picture.Picture]", ending: str = ".png") -> dict[str, bytes]:
    """Pictures by their endings; if there are several, each has the name of its view."""
    if len(taken) == 1:
        return {ending: taken[0].encoded(ending)}
    return {f"-{shot.name}{ending}": shot.encoded(ending) for shot in taken}


@writer("jpeg", ".jpg")
def jpeg(painting: "paint.Painting") -> Files:
    """The pictures as JPEG, one a view: for messages and pages."""
    return encode_pictures(painting.pictures, ".jpg")


@writer("film", "-film.npz")
def film(painting: "paint.Painting") -> Files:
    """The light, camera and settings, to develop again, and the linear film as a float TIFF."""
    from dqpaint.painting import film_file

    scene, settings = painting.scene, painting.settings
    exact = film_file.encode_linear(scene, painting.picture, settings, ".tiff")
    worked = painting.picture.render_cache(settings.ghost)
    kept = film_file.encode(scene, settings, painting.arm_motion, worked)
    return {"-film.npz": kept, "-film.tiff": exact}


@writer("hdr", ".hdr")
def hdr(painting: "paint.Painting") -> bytes:
    """The linear film as Radiance HDR, which picture editors open."""
    from dqpaint.painting import film_file

    return film_file.encode_linear(painting.scene, painting.picture, painting.settings, ".hdr")


@writer("video", ".webm")
def video(painting: "paint.Painting", progress: Progress) -> bytes:
    """The painting as it grows: VP9 in WebM."""
    return _movie(painting, progress, ".webm")


@writer("mp4", ".mp4")
def mp4(painting: "paint.Painting", progress: Progress) -> bytes:
    """The painting as it grows, for slides: H.264 by the system's ffmpeg, else VP9."""
    return _movie(painting, progress, ".mp4")


@writer("gif", ".gif")
def gif(painting: "paint.Painting", progress: Progress) -> bytes:
    """The painting as it grows, small, with 256 colours: where nothing else plays."""
    return _movie(painting, progress, ".gif")


@writer("webp", ".webp")
def webp(painting: "paint.Painting", progress: Progress) -> bytes:
    """The painting as it grows, small, as an animation for a page."""
    return _movie(painting, progress, ".webp")


def _movie(painting: "paint.Painting", progress: Progress, ending: str) -> bytes:
    from dqpaint.painting import video as movies

    with painting.scene_arm() as arm:
        return movies.movie(
            painting.scene, painting.picture, painting.settings, progress, arm, ending
        )

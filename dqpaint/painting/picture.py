"""Scene and settings -> Pictures, one a view, for the reference and for runs alike."""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from functools import partial

import cv2
import numpy as np
from numpy.typing import NDArray

from dqpaint.dq import Floats
from dqpaint.errors import DqpaintError
from dqpaint.light import Image
from dqpaint.light.camera import (
    Camera,
    Shot,
    distance_to,
    equivalent_exposure,
    parse_exposure,
    parse_views,
)
from dqpaint.light.film import (
    LOOKS,
    Film,
    automatic_exposure,
    expose,
    line_exposure,
    point_spread,
    spread,
    with_noise,
    with_starburst,
)
from dqpaint.light.images import LEGEND_EXPOSURE, with_legend, with_notes
from dqpaint.light.sources import ALL_SAMPLES, Occlusion, Sweep, occlusion_by, view_camera
from dqpaint.motion import RowLines
from dqpaint.painting.memory import check_picture_memory
from dqpaint.painting.scene import Scene, with_shutter
from dqpaint.render import HiddenLight, SceneArm, hidden_by_line
from dqpaint.settings import Settings

# run lengths suit black ground with dithered halos: smaller and faster than the default search
ENCODED = {
    ".png": [cv2.IMWRITE_PNG_STRATEGY, cv2.IMWRITE_PNG_STRATEGY_RLE],
    ".jpg": [cv2.IMWRITE_JPEG_QUALITY, 95, cv2.IMWRITE_JPEG_SAMPLING_FACTOR,
             cv2.IMWRITE_JPEG_SAMPLING_FACTOR_444],  # red lines keep their edges
}  # fmt: skip
OVERLAY_EXPOSURE = 0.25  # exposure of the reference's lines below the light
FILMS_KEPT = 1  # pictures of one painting that keep their films; the others keep the sums


@dataclass(frozen=True, repr=False, eq=False)
class Picture:
    """A developed picture and the film it came from.

    Attributes:
        image: (H, W, 3) 8-bit sRGB.
        film: the light that fell on it, linear.
        exposure: the factor that was applied to the film, `ev` not included.
        camera: where it was taken from.
        name: of the view.
        exposure_text: the exposure in a photographer's terms, for reports.
        light: the sweeps, with the occlusion of this view.
        occluded: light that the arm kept from the film; None if that was not traced.
        arm: (H, W, 3) linear light of the arm and the floor, if they are shown.
        remarks: parts of the arm that could not be shown or traced.
    """

    image: NDArray[np.uint8]
    film: Film
    exposure: float
    camera: Camera
    name: str
    exposure_text: str
    light: tuple[Sweep, ...] = ()
    occluded: HiddenLight | None = None
    arm: Image | None = None
    remarks: tuple[str, ...] = ()

    @property
    def emitted(self) -> Floats:
        """(3,) all emitted light: on the film, lost and occluded, in the film's unit."""
        return self.film.emitted + (0.0 if self.occluded is None else self.occluded.energy)

    def render_cache(self, ghost: bool | str) -> "RenderCache":
        """The rendered arm and occlusion of this picture, to be used again."""
        shades = [sweep.occlusion for sweep in self.light if sweep.occlusion is not None]
        shares = tuple(shade.share for shade in shades)
        return RenderCache(
            render_key(self.camera, self.exposure), ghost, self.arm, shares, self.remarks
        )

    @property
    def png(self) -> bytes:
        """The image as a PNG file."""
        return self.encoded(".png")

    def encoded(self, ending: str) -> bytes:
        """The image as a file: .png or .jpg."""
        done, data = cv2.imencode(ending, self.image[..., ::-1], ENCODED[ending])
        if not done:
            raise DqpaintError(f"the picture could not be encoded as {ending}")
        return data.tobytes()

    def _repr_png_(self) -> bytes:
        return self.png


class PictureSet:
    """Something with pictures, one a view; a notebook shows the first."""

    pictures: tuple[Picture, ...]

    @property
    def picture(self) -> Picture:
        """The picture of the first view."""
        return self.pictures[0]

    @property
    def image(self) -> NDArray[np.uint8]:
        """The picture (H, W, 3), sRGB."""
        return self.picture.image

    def _repr_png_(self) -> bytes:
        return self.picture.png


@dataclass(frozen=True, eq=False)
class RenderCache:
    """The rendered arm and occlusion of one picture, to be used again for the same view.

    Attributes:
        key: (18,) the picture's camera and exposure, see `render_key`.
        ghost: how the arm is shown in it.
        arm: (H, W, 3) linear light of the arm and the floor, if they are shown.
        shares: (N-1, P) of each sweep what the arm let through; none if that was not traced.
        remarks: parts that could not be shown or traced.
    """

    key: Floats
    ghost: bool | str
    arm: Image | None
    shares: tuple[Floats, ...]
    remarks: tuple[str, ...]

    def has_render(self, key: Floats, settings: Settings) -> bool:
        """Whether the rendered arm is the one of another picture."""
        same = self.arm is not None and self.ghost == settings.ghost
        return same and bool(np.array_equal(key, self.key))

    def has_occlusion(self, key: Floats) -> bool:
        """Whether the occlusion is that of another camera."""
        return bool(self.shares) and bool(np.array_equal(key[:3], self.key[:3]))

    def with_occlusion(self, light: tuple[Sweep, ...]) -> tuple[Sweep, ...]:
        """The light with its occlusion."""
        return tuple(
            replace(sweep, occlusion=Occlusion(sweep.period, share))
            for sweep, share in zip(light, self.shares, strict=True)
        )


def render_key(camera: Camera, exposure: float) -> Floats:
    """(18,) numbers that a picture of the arm depends on besides arm and light; position first."""
    numbers = (camera.focal, *camera.centre, camera.width, camera.height, exposure)
    return np.concatenate([camera.position, camera.rotation.ravel(), numbers])


def photograph(
    scene: Scene,
    settings: Settings,
    scene_arm: SceneArm | None = None,
    cache: RenderCache | None = None,
) -> Iterator[Picture]:
    """The pictures of a scene: one for each view of the settings, all of one run.

    The views of a series (a stereo pair, an orbit) have the exposure of its first.

    Args:
        scene: what is photographed.
        settings: views, size, exposure, look, and whether the arm is seen and hides light.
        scene_arm: the arm; None is a picture without one, that hides nothing.
        cache: what of the arm is known already.
    """
    scene = with_shutter(scene, settings)
    series: dict[int, float] = {}
    for i, shot in enumerate(parse_views(settings.view)):
        picture = _take_picture(scene, settings, shot, series.get(shot.series), scene_arm, cache)
        if shot.series:
            series.setdefault(shot.series, picture.exposure)
        if i >= FILMS_KEPT:
            sums = picture.film.on_film[:, None, None]
            picture = replace(picture, film=replace(picture.film, planes=sums), light=(), arm=None)
        yield picture


def camera_of_view(scene: Scene, settings: Settings, shot: Shot) -> Camera:
    """The camera of one view."""
    return view_camera(scene.shown_points, scene.front, settings, shot)


def _take_picture(
    scene: Scene,
    settings: Settings,
    shot: Shot,
    series_exposure: float | None,
    scene_arm: SceneArm | None,
    cache: RenderCache | None,
) -> Picture:
    camera = camera_of_view(scene, settings, shot)
    check_picture_memory(scene.light, camera, settings)
    exposure, told = _exposure(scene, settings, camera, shot, series_exposure)
    staged = RenderCache(render_key(camera, exposure), False, None, (), ())
    if scene_arm is not None:
        staged = _render_arm(scene, settings, camera, exposure, scene_arm, cache)
    light = staged.with_occlusion(scene.light) if staged.shares else scene.light
    film = expose(light, camera, _is_manual_exposure(settings))
    hidden = (
        _occluded_light(light, scene_arm.source)
        if scene_arm is not None and staged.shares
        else None
    )
    image = linear_image(scene, film, exposure, camera, settings, arm=staged.arm)
    return Picture(
        develop_image(scene, image, exposure, settings), film, exposure, camera, shot.name, told,
        light, hidden, staged.arm, staged.remarks,
    )  # fmt: skip


def _render_arm(
    scene: Scene,
    settings: Settings,
    camera: Camera,
    exposure: float,
    scene_arm: SceneArm,
    cache: RenderCache | None,
) -> RenderCache:
    """The rendered arm and its occlusion; from the cache where that fits."""
    key, fresh = render_key(camera, exposure), False
    arm: Image | None = None
    shares: tuple[Floats, ...] = ()
    if settings.traced and cache is not None and cache.has_occlusion(key):
        shares = cache.shares
    elif settings.traced:
        fresh = True
        if scene_arm.can_occlude:
            shares = tuple(
                occlusion_by(sweep, scene_arm, camera.position).share for sweep in scene.light
            )
    if settings.ghost and cache is not None and cache.has_render(key, settings):
        arm = cache.arm
    elif settings.ghost:
        fresh = True
        take = scene_arm.render_blurred if settings.ghost == "motion" else scene_arm.render_still
        arm = take(camera, partial(lamp_paths, scene), exposure, _is_manual_exposure(settings))
    remarks = tuple(scene_arm.remarks) if fresh or cache is None else cache.remarks
    return RenderCache(key, settings.ghost, arm, shares, remarks)


def lamp_paths(scene: Scene, samples: slice = ALL_SAMPLES) -> list[tuple[Floats, Floats]]:
    """The paths (N, 3) and energies (N-1, 3) of a scene's lamps, of some steps between samples."""
    return [lamp for sweep in scene.light for lamp in sweep.lamp_paths(samples)]


def _occluded_light(light: Sequence[Sweep], source: RowLines) -> HiddenLight:
    """The occluded light of some sweeps, by the lines (N,) of the drawing."""
    shades = [sweep.occlusion for sweep in light if sweep.occlusion is not None]
    hidden = np.sum([shade.hidden for shade in shades], axis=0)
    emitted = np.sum([shade.emitted for shade in shades], axis=0)
    return hidden_by_line(hidden, emitted, source[:-1])


def _is_manual_exposure(settings: Settings) -> bool:
    return parse_exposure(settings.exposure or "auto") is not None


def _exposure(
    scene: Scene, settings: Settings, camera: Camera, shot: Shot, series_exposure: float | None
) -> tuple[float, str]:
    """The factor from film to saturation, and the same in a photographer's terms."""
    real = parse_exposure(settings.exposure or "auto")
    if real is not None:
        early = ""
        if real.shutter is not None and real.shutter < scene.seconds:
            early = f"; the shutter closes {real.shutter:g} s into {scene.seconds:.2f} s"
        return real.factor(camera), f"{real}{early}"
    if series_exposure is None:
        level = None if scene.legend is None else LEGEND_EXPOSURE
        if scene.exposure is None:
            series_exposure = automatic_exposure(scene.reference, camera, level)
        else:
            series_exposure = exposure_to(camera, scene.corners, scene.exposure)
    shown = series_exposure * 2.0**settings.ev
    points = scene.shown_points
    middle = camera.position - distance_to(camera, points) * camera.rotation[2]
    text = equivalent_exposure(shown, camera, middle, scene.seconds, shot.position is not None)
    return series_exposure, f"automatic, {text}"


def exposure_to(camera: Camera, points: Floats, exposure: float) -> float:
    """The factor from lamp s / px^2 to saturation, of light per area at points (K, 3) [m].

    Args:
        camera: where it is seen from.
        points: of the canvas.
        exposure: [m^2 / (lamp s)].
    """
    return exposure * (camera.focal / distance_to(camera, points)) ** 2


def linear_image(
    scene: Scene,
    film: Film,
    exposure: float,
    camera: Camera,
    settings: Settings,
    overlay: Image | None = None,
    arm: Image | None = None,
) -> Image:
    """(H, W, 3) linear light on the sensor, before it is developed.

    Args:
        scene: What is photographed.
        film: What fell on the film.
        exposure: Of the picture.
        camera: Where it was taken from.
        settings: Of the picture.
        overlay: From `overlay_image`, where it is already there.
        arm: Light of the arm and the floor, where they are shown.
    """
    image = spread(film, point_spread(settings.height))
    if scene.overlay:
        image += overlay_image(scene, exposure, camera, settings) if overlay is None else overlay
    if arm is not None:
        image += arm
    if settings.starburst:
        image = with_starburst(image, settings.starburst)
    return image


def overlay_image(scene: Scene, exposure: float, camera: Camera, settings: Settings) -> Image:
    """(H, W, 3) faint lines of the reference, on the scale of the film's light."""
    psf = point_spread(settings.height)
    ridge = line_exposure(scene.overlay, camera, psf)
    faint = np.float32(OVERLAY_EXPOSURE * ridge / (exposure * 2.0**settings.ev))
    return spread(expose(scene.overlay, camera), psf) * faint


def develop_image(
    scene: Scene, image: Image, exposure: float, settings: Settings
) -> NDArray[np.uint8]:
    """The picture of linear light: noise, look, legend, notes."""
    if settings.noise is not None:
        image = with_noise(image, exposure * 2.0**settings.ev, settings.noise)
    shown = LOOKS[settings.look](image, exposure, settings.ev)
    if scene.legend is not None:
        shown = with_legend(shown, scene.legend, settings.look)
    return with_notes(shown, deviation_notes(settings))


def deviation_notes(settings: Settings) -> list[str]:
    """What is in a picture besides the light of a run, as it was."""
    notes = ["grey lines: the reference"] if settings.overlay else []
    if settings.magnify != 1.0:
        of = "it" if settings.overlay else "the reference"
        notes.append(f"deviations from {of} {settings.magnify:g} times as large")
    return notes

"""An arm and the light it painted -> linear light of arm and floor at the end of the run.

A long exposure of a dark room shows no arm: it moves, and nothing shines on it but its lamp. So a
photographer flashes it once, when the light is out (rear-curtain flash). Here the flash is faint,
two lamps behind the arm draw its outline in the colours of the painting's own left and right ends,
and all that was painted shines on arm and floor as a cloud of lamps. Light adds: strokes drawn
while the arm was elsewhere stay in front of it. How bright the arm is against the strokes is taste;
everything else is optics.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import cv2
import numpy as np
from numpy.typing import NDArray

from dqpaint.dq import Floats
from dqpaint.light import Image
from dqpaint.light.camera import Camera
from dqpaint.render.arm_shapes import Arm
from dqpaint.render.floor import floor_light
from dqpaint.render.geometry_buffer import Numbers, Surfaces, measure_surfaces
from dqpaint.render.lamps import Lamps, gather_lamps
from dqpaint.render.shading import fresnel, points_seen_from, shade_by_direction, shade_by_lamps

KEY_EXPOSURE = 0.6
"""Exposure of a white surface by all of the painting's light at `LAMP_CLEARANCE` plus its spread; 1
saturates."""
LAMP_CLEARANCE = 0.15
"""Distance in addition to the spread of the light: about a flange and a lamp holder [m]."""
BLACK_ALBEDO, ALBEDO_SHARE = 0.04, 0.22
"""Albedo of a black body, and the share of its colour's brightness that a body adds."""
GREY_SHARE = 0.7
"""Share of a file's colour that is replaced by grey."""
COAT_SHARPNESS = 64
"""Specular exponent of the coat."""
FLASH, FLASH_COLOUR = 0.012, (1.0, 0.95, 0.88)
FLASH_DIRECTION = (-0.4, 0.8, 0.6)
"""Direction of the flash: right, up, back towards the viewer."""
FLASH_GLINT = 40.0
RIM, RIM_DULL, RIM_GLINT, RIM_GLOSS = 0.33, 0.6, 4.0, 4
RIM_DIRECTION = (0.8, 0.3, -0.75)
"""Direction of the right lamp behind the arm; the left one is its mirror image."""
RIM_COLOUR_SPREAD = 8
"""How strongly the rims take the colours of the painting's outermost light."""
ARM_BLUR = 0.7
"""Blur of the arm; the lens blurs a line more [px]."""
OUTLINE_REACH = (5, 5)
"""Pixels around an outline that take its colour."""
LEAST_RIM_LUMINANCE = 0.28
"""Least luminance of a rim's colour."""
LUMINANCE = np.array([0.2126, 0.7152, 0.0722])
MIRROR_POINTS = 4096
"""Number of points that represent the painting in the mirror of the floor."""

Lights = Sequence[tuple[Floats, Floats]]


@dataclass(frozen=True, eq=False)
class Glow:
    """A painting's light as it falls on nearby surfaces.

    Attributes:
        lamps: a few lamps that light surfaces.
        path: many, for what mirrors.
        gain: factor from what lamps send [lamp s / m^2] to saturation.
        whole: all of the painting, where this is a part of it; its ends colour the rims.
    """

    lamps: Lamps
    path: Lamps
    gain: float
    whole: Lamps

    def part(self, lights: Lights, most: int) -> Glow:
        """A part of this light at the same gain, in at most `most` lamps."""
        return Glow(
            gather_lamps(lights, most), gather_lamps(lights, MIRROR_POINTS), self.gain, self.whole
        )


def gather_glow(lights: Lights) -> Glow:
    """The glow of lamps along their paths.

    Its gain does not depend on a camera: several views of one painting show one arm.

    Args:
        lights: of each lamp its points (N, 3) [m] and the energy (N-1, 3) between them [lamp s].
    """
    lamps = gather_lamps(lights)
    total = float(lamps.total.max(initial=0.0))
    if total == 0.0:
        return Glow(lamps, lamps, 0.0, lamps)
    spread = ((lamps.position - lamps.middle) ** 2).sum(axis=1).mean()
    return Glow(
        lamps,
        gather_lamps(lights, MIRROR_POINTS),
        KEY_EXPOSURE * np.pi * (spread + LAMP_CLEARANCE**2) / total,
        lamps,
    )


def render_arm(
    arm: Arm,
    camera: Camera,
    light: Glow,
    exposure: float,
    falloff: bool = False,
    scale: float = 1.0,
) -> Image:
    """Linear light (H, W, 3) of arm and floor, to be added before development.

    Args:
        arm: in its posture.
        camera: that of the picture.
        light: of the painting.
        exposure: of the picture: factor from its own unit [lamp s / px^2] to saturation.
        falloff: whether that unit is divided by the distance squared [lamp s / (m px)^2].
        scale: 1 / width of the rendered pixels, for frames of a movie.
    """
    seen = camera if scale == 1.0 else camera.scaled(scale)
    shown = render_floor(seen, light, exposure * scale**2, falloff)
    surfaces = measure_surfaces(arm, seen)
    if surfaces is not None:
        part = surfaces.box.crop(shown)
        cover = surfaces.cover[..., None]
        part *= 1.0 - cover
        part += cover * _spread(light_surfaces(arm, surfaces, seen, light), surfaces.sure)
    return to_picture_size(shown, camera, exposure, scale)


def render_floor(camera: Camera, light: Glow, exposure: float, falloff: bool) -> Image:
    """Light (H, W, 3) of the floor for the camera; 1 saturates it. Arguments as above."""
    shown = floor_light(camera, light.lamps, light.path, light.gain, exposure, falloff)
    return np.zeros((camera.height, camera.width, 3), np.float32) if shown is None else shown


def to_picture_size(shown: Image, camera: Camera, exposure: float, scale: float = 1.0) -> Image:
    """Light of arm and floor in the picture's unit, size and sharpness."""
    soft = cv2.GaussianBlur(shown, (0, 0), ARM_BLUR)
    if scale != 1.0:
        whole = cv2.resize(soft, None, fx=1 / scale, fy=1 / scale, interpolation=cv2.INTER_LINEAR)
        soft = whole[: camera.height, : camera.width]
    return np.asarray(soft * np.float32(1.0 / exposure), np.float32)


def light_surfaces(
    arm: Arm, surfaces: Surfaces, camera: Camera, light: Glow, room: float = 1.0
) -> Numbers:
    """Light (P, 3) that the arm's surfaces send to the camera; 1 saturates it.

    Args:
        arm: in its posture.
        surfaces: of it that are seen.
        camera: by which they are.
        light: that is painted meanwhile.
        room: how strong the other lamps are: those behind the arm, and the flash.
    """
    points = points_seen_from(camera.position, surfaces.position, surfaces.normal)
    body, coat = _albedo(arm)[surfaces.link + 1], fresnel(points.cosine_to_eye)[:, None]
    dull, glossy = shade_by_lamps(points, light.lamps, COAT_SHARPNESS)
    shown = (body * dull + coat * glossy) * np.float32(light.gain)
    sides = np.stack(
        [camera.rotation.T @ np.multiply(RIM_DIRECTION, (sign, 1, 1)) for sign in (1, -1)]
    )
    for way, colour in zip(sides, _rims(light.whole, camera), strict=True):
        dull, glossy = shade_by_direction(points, way, RIM_GLOSS)
        edge = np.float32(RIM_DULL) * body * dull + np.float32(RIM_GLINT) * coat * glossy
        shown += np.float32(room * RIM) * colour * edge
    dull, glossy = shade_by_direction(points, camera.rotation.T @ FLASH_DIRECTION, COAT_SHARPNESS)
    flash = np.float32(room * FLASH) * np.array(FLASH_COLOUR, np.float32)
    shown += flash * (dull + np.float32(FLASH_GLINT) * coat * glossy)
    return np.asarray(shown, np.float32)


def _spread(colours: Numbers, sure: NDArray[np.bool_]) -> Image:
    """Colours (h, w, 3) of points (P, 3); pixels between and beside them get their mean."""
    image = np.zeros((*sure.shape, 3), np.float32)
    image[sure] = colours
    weight = cv2.blur(sure.astype(np.float32), OUTLINE_REACH, borderType=cv2.BORDER_CONSTANT)
    around = np.asarray(cv2.blur(image, OUTLINE_REACH, borderType=cv2.BORDER_CONSTANT), np.float32)
    around /= np.maximum(weight, np.float32(1e-6))[..., None]
    around[sure] = colours
    return around


def _rims(lamps: Lamps, camera: Camera) -> tuple[Numbers, Numbers]:
    """The colours (3,) of the painting's right and left ends, at full brightness."""
    if len(lamps.position) == 0:
        return np.ones(3, np.float32), np.ones(3, np.float32)
    side = (lamps.position - lamps.middle) @ camera.rotation[0]
    reach = max(float(np.abs(side).max()), 1e-9)
    found = []
    for sign in (1.0, -1.0):
        weight = (0.5 + 0.5 * sign * side / reach) ** RIM_COLOUR_SPREAD
        colour = (weight[:, None] * lamps.energy).sum(axis=0)
        found.append(_outline_colour(colour / colour.max()))
    return found[0], found[1]


def _outline_colour(colour: Floats) -> Numbers:
    """A colour (3,) for an outline: deep blue gets some white and more strength."""
    luminance = float(LUMINANCE @ colour)
    white = max(0.0, LEAST_RIM_LUMINANCE - luminance) / (1.0 - luminance + 1e-9)
    pale = colour + white * (1.0 - colour)
    return np.asarray(pale * np.sqrt(0.5 / max(luminance, LEAST_RIM_LUMINANCE)), np.float32)


def _albedo(arm: Arm) -> Numbers:
    """Albedo (L + 1, 3) of each link: its colour in the file, greyer and darker."""
    found = np.full((len(arm.links) + 1, 3), 0.5, np.float32)
    for shape in arm.shapes:
        linear = np.asarray(shape.colour, np.float32) ** 2.2
        grey = linear @ LUMINANCE.astype(np.float32)
        found[shape.link + 1] = linear + np.float32(GREY_SHARE) * (grey - linear)
    return np.float32(BLACK_ALBEDO) + np.float32(ALBEDO_SHARE) * found

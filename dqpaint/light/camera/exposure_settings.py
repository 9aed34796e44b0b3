"""Real camera settings (candela, f-number, ISO) -> the exposure factor of a picture."""

from __future__ import annotations

import math
import re
from dataclasses import dataclass

import numpy as np

from dqpaint.errors import UsageError
from dqpaint.light.arrays import Floats
from dqpaint.light.camera.camera import DEFAULT_LENS, Camera

SENSOR_WIDTH = 0.036
"""Long side of a full-frame sensor [m]."""
SATURATION = 78.0
"""Exposure times speed at saturation: H = 78 / S lux s (ISO 12232:2019)."""
TRANSMISSION = 0.9
"""Share of light that the glass of a usual lens transmits."""
COMMON_LENSES = (0.024, 0.028, 0.035, 0.05, 0.085, 0.1, 0.135, 0.2, 0.3, 0.4)
"""Focal lengths that are common on a full-frame sensor [m]."""
CAMERA_CLEARANCE = 1.5
"""Least distance of an advised camera from the arm's base [m]: no arm here reaches as far."""
LONGEST_TIMED = 30.0
"""Longest exposure that cameras time by themselves [s]; a longer one is held open by hand."""
BRIGHT_LED = 1.0
"""Intensity of an LED as it is sold [cd]; a picture that needs less can have a filter."""


@dataclass(frozen=True)
class Exposure:
    """Exposure settings of a real camera, and the light source it photographs.

    Attributes:
        f_number: Focal length over the diameter of the aperture.
        iso: Speed of the sensor.
        focal: Focal length [m], on a sensor 36 mm wide.
        nd: Stops a neutral-density filter takes.
        candela: Luminous intensity of a lamp of full brightness, of all its LEDs together [cd].
        distance: From the camera to the middle of the drawing [m]; None frames the drawing.
        shutter: How long the shutter stays open from the start of the drawing on [s]; None: until
            its end.
    """

    f_number: float = 8.0
    iso: float = 100.0
    focal: float = DEFAULT_LENS * SENSOR_WIDTH
    nd: float = 0.0
    candela: float = 1.0
    distance: float | None = None
    shutter: float | None = None

    @property
    def lens(self) -> float:
        """Focal length over the long side of the sensor."""
        return self.focal / SENSOR_WIDTH

    def factor(self, camera: Camera) -> float:
        """The exposure factor: lamp s / (m^2 px^2), with inverse-square falloff, to saturation.

            dH / H_sat = I dt (pi/4) (f/N)^2 T 2^-ND / (r^2 p^2) S / 78

        Illuminance on the sensor is what the aperture catches of the lamp's flux, over the area of
        a pixel; I [cd], r [m], pixel pitch p [m].
        """
        pitch = SENSOR_WIDTH / max(camera.width, camera.height)
        aperture = math.pi / 4.0 * (self.focal / self.f_number) ** 2
        caught = self.candela * aperture * TRANSMISSION * 2.0**-self.nd
        return float(caught / pitch**2 * self.iso / SATURATION)

    def __str__(self) -> str:
        parts = [f"f/{self.f_number:g}", f"ISO {self.iso:g}", f"{1e3 * self.focal:g} mm"]
        if self.shutter is not None:
            parts.append(f"{self.shutter:g} s")
        if self.nd:
            parts.append(f"ND {self.nd:g} stops")
        return f"{', '.join(parts)}, LED of {format_intensity(self.candela)}"


@dataclass(frozen=True)
class _Part:
    """One part of an exposure's text: its pattern, field, bounds and unit."""

    pattern: str
    field: str
    least: float
    most: float
    scale: float
    example: str


NUMBER = r"(\d+(?:\.\d+)?|\.\d+)"
EXPOSURE_PARTS = (
    _Part(rf"f/{NUMBER}", "f_number", 0.5, 128.0, 1.0, "f/8"),
    _Part(rf"iso{NUMBER}", "iso", 1.0, 1e6, 1.0, "iso100"),
    _Part(rf"{NUMBER}mm", "focal", 4.0, 2000.0, 1e-3, "35mm"),
    _Part(rf"nd{NUMBER}", "nd", 0.0, 30.0, 1.0, "nd3"),
    _Part(rf"{NUMBER}cd", "candela", 1e-6, 1e6, 1.0, "0.1cd"),
    _Part(rf"{NUMBER}m", "distance", 0.01, 100.0, 1.0, "2.2m"),
    _Part(rf"{NUMBER}s", "shutter", 1e-3, 86_400.0, 1.0, "30s"),
)
EXPOSURE_HELP = (
    "f/8 (aperture), iso100, 35mm (focal length), nd3 (filter, in stops), "
    "0.1cd (the lamp), 2.2m (distance), 30s (shutter)"
)


def parse_exposure(text: str) -> Exposure | None:
    """Parse settings such as `f/8,iso100,35mm,nd3,1cd,2.2m,30s`, in any order; None for `auto`.

    Raises:
        UsageError: a part is unknown, given twice or out of bounds.
    """
    if text.strip() == "auto":
        return None
    given: dict[str, float] = {}
    for word in text.split(","):
        part, number = _read(text, word.strip())
        if part.field in given:
            raise UsageError(f"exposure '{text}': a part like {part.example} is given twice")
        if not part.least <= number <= part.most:
            bounds = f"from {part.least:g} to {part.most:g}, as in {part.example}"
            raise UsageError(f"exposure '{text}': '{word.strip()}' must be {bounds}")
        given[part.field] = number * part.scale
    return Exposure(**given)


def _read(text: str, word: str) -> tuple[_Part, float]:
    for part in EXPOSURE_PARTS:
        found = re.fullmatch(part.pattern, word, re.IGNORECASE)
        if found is not None:
            return part, float(found[1])
    raise UsageError(
        f"exposure '{text[:60]}': '{word[:20]}' is not a part of an exposure; "
        f"its parts: {EXPOSURE_HELP}"
    )


def equivalent_exposure(
    factor: float, camera: Camera, middle: Floats, seconds: float, fixed: bool = False
) -> str:
    """Real camera settings that are equivalent to an automatic exposure, as text.

    The lens is the shortest common one with which the same frame is filled from outside an arm's
    reach: at equal f-number a lens twice as long at twice the distance gets the same light.

    Args:
        factor: From lamp s / px^2 to sensor saturation.
        camera: That took the picture.
        middle: (3,) of the drawing, base frame [m].
        seconds: How long the shutter is open: as long as the drawing takes [s].
        fixed: Whether the position of the camera was chosen, so that lens and distance stay.
    """
    focal = camera.focal / max(camera.width, camera.height) * SENSOR_WIDTH
    back = camera.rotation[2]
    distance = float((camera.position - middle) @ back)
    candela = factor * distance**2 / Exposure(focal=focal).factor(camera)
    if not fixed:
        sets = ((lens, distance * lens / focal) for lens in COMMON_LENSES)
        far = (
            (lens, away)
            for lens, away in sets
            if np.linalg.norm(middle + away * back) >= CAMERA_CLEARANCE
        )
        longest = COMMON_LENSES[-1]
        focal, distance = next(far, (longest, distance * longest / focal))
    timed = f"{math.ceil(seconds)} s{' (bulb)' if seconds > LONGEST_TIMED else ''}"
    stops = round(math.log2(BRIGHT_LED / candela)) if candela < BRIGHT_LED else 0
    filtered = f" (or {format_intensity(candela * 2.0**stops)} behind {stops} stops of ND)"
    return (
        f"as f/8, ISO 100, {timed}, {1e3 * focal:.0f} mm at {distance:.2g} m, "
        f"LED of {format_intensity(candela)}{filtered if stops > 1 else ''}"
    )


def format_intensity(candela: float) -> str:
    """Luminous intensity as text, in cd or mcd."""
    return f"{1e3 * candela:.2g} mcd" if candela < 0.1 else f"{candela:.3g} cd"

"""The built-in brushes, one class each: values -> `Emitters` in the tool frame."""

from __future__ import annotations

from typing import Annotated, ClassVar

import numpy as np
from pydantic import Field

from dqpaint.brushes.brush import BRUSHES, Brush, Direction, ImageFile, Leds, Length, Shades, X
from dqpaint.brushes.emitters import Emitters
from dqpaint.brushes.images import columns, striped_image
from dqpaint.core.arrays import Floats
from dqpaint.program import colours as named

LEDS_PER_METRE = 144.0
"""Density of the densest common LED strips."""
Z = np.array([0.0, 0.0, 1.0])


@BRUSHES.add("point")
class Point(Brush):
    """A single LED at the tool's tip."""

    several: ClassVar[bool] = False

    def emitters(self) -> Emitters:
        """One lamp."""
        return Emitters(lobe=self.lobe)


@BRUSHES.add("ball")
class Ball(Brush):
    """A diffuse ball: an even disc from wherever it is seen."""

    several: ClassVar[bool] = False

    size: Length = Field(0.04, description="diameter")

    def emitters(self) -> Emitters:
        """One lamp with a size."""
        return Emitters(lobe=self.lobe, size=self.size)


class StraightBrush(Brush):
    """Lamps on a straight line, centred on the tool."""

    length: Length = Field(0.2, description="from end to end")
    along: Direction = Field(X, description="axis of the tool it lies along: x, y, z, -x, ...")
    colours: Shades = Field(
        (named.WHITE,),
        description="from one end to the other, a/b/c; the stroke's colour dims them",
    )

    def lamps_on_line(self, leds: int, tints: Floats, joined: float) -> Emitters:
        """`leds` lamps on the line, with tints (R, leds, 3) relative to full brightness."""
        along = np.array(self.along) / np.linalg.norm(self.along)
        across = Z - along * along[2]  # a bar shines towards the tool's z, as far as it can
        if across @ across < 1e-12:
            across = X - along * along[0]
        u = (np.arange(leds) + 0.5) / leds - 0.5
        places = self.length * u[:, None] * along
        normal = across / np.linalg.norm(across)
        return Emitters(places, tints / leds, 0.0, joined, normal, self.lobe)

    def gradient(self, leds: int) -> Floats:
        """The colours (1, leds, 3) from end to end."""
        stops = np.linspace(0.0, 1.0, len(self.colours))
        u = (np.arange(leds) + 0.5) / leds
        shades = np.array(self.colours)
        return np.stack([np.interp(u, stops, channel) for channel in shades.T], axis=1)[None]

    def led_count(self, leds: int) -> int:
        """The number of LEDs, or the default number if `leds` is 0."""
        return leds or max(2, round(self.length * LEDS_PER_METRE))


@BRUSHES.add("bar")
class Bar(StraightBrush):
    """A bar of LEDs behind a little diffusion: threads on a veil."""

    leds: Leds = Field(0, description="how many; 0 is 144 a metre")
    joined: Annotated[float, Field(ge=0.0, le=1.0)] = Field(
        0.45, description="share of the light between the LEDs, 0 to 1"
    )

    def emitters(self) -> Emitters:
        """The LEDs and the diffuse light between them."""
        leds = self.led_count(self.leds)
        return self.lamps_on_line(leds, self.gradient(leds), self.joined)


@BRUSHES.add("ribbon")
class Ribbon(StraightBrush):
    """An even line of light without gaps."""

    def emitters(self) -> Emitters:
        """Only the diffuse light."""
        fine = 128 if len(self.colours) > 1 else 2
        return self.lamps_on_line(fine, self.gradient(fine), 1.0)


@BRUSHES.add("pixelstick")
class Pixelstick(StraightBrush):
    """A bar of LEDs that shows an image column by column along its way."""

    image: ImageFile = Field("", description="a picture file; without one, a pattern of stripes")
    times: Annotated[int, Field(ge=1, le=100)] = Field(
        1, description="how often the image is shown along the way"
    )
    leds: Leds = Field(0, description="how many; 0 is 144 a metre")
    joined: Annotated[float, Field(ge=0.0, le=1.0)] = Field(
        0.5, description="share of the light between the LEDs, 0 to 1"
    )

    def emitters(self) -> Emitters:
        """A row of tints for each column of the image."""
        leds = self.led_count(self.leds)
        shown = columns(self.image, leds) if self.image else striped_image(leds)
        return self.lamps_on_line(
            leds, np.tile(shown, (self.times, 1, 1)) * self.gradient(leds), self.joined
        )


@BRUSHES.add("fibre")
class Fibre(Brush):
    """A brush of glass fibres: fine soft parallel lines, dimmer at the rim."""

    width: Length = Field(0.02, description="diameter of the brush")
    fibres: Annotated[int, Field(ge=1, le=2000)] = Field(48, description="how many")
    seed: Annotated[int, Field(ge=0)] = Field(1, description="of the fibres' places")

    def emitters(self) -> Emitters:
        """Fibres scattered over a disc across the tool's z."""
        random = np.random.default_rng(self.seed)
        k = np.arange(self.fibres) + 0.5
        radius = np.sqrt(k / self.fibres)
        turn = k * np.pi * (3.0 - np.sqrt(5.0)) + random.normal(0.0, 0.25, self.fibres)
        radius = np.clip(radius + random.normal(0.0, 0.05, self.fibres), 0.0, 1.0)
        places = (
            0.5 * self.width * radius[:, None] * np.stack([np.cos(turn), np.sin(turn), 0 * turn], 1)
        )
        power = (1.0 - 0.8 * radius**2) * random.uniform(0.35, 1.0, self.fibres)
        tints = np.repeat((power / power.sum())[None, :, None], 3, axis=2)
        return Emitters(places, tints, lobe=self.lobe)

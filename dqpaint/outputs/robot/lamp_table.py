"""A painting -> the light as a table for the lamp's own controller, started by one wire.

Streams jitter; a table that is in the lamp does not. Each entry holds all LEDs for some ticks: how
many, 16 bits with the low byte first, and then red, green and blue of each, 8 bits.
"""

from dataclasses import dataclass
from math import gcd
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from dqpaint.errors import DqpaintError
from dqpaint.light.sources import Sweep, sweeps
from dqpaint.outputs.robot.trajectory import trajectory_of

if TYPE_CHECKING:
    from dqpaint.painting import paint

FULL = 255
LONGEST = 65535  # ticks of an entry
LARGEST = 1_000_000  # bytes of a table
LED_TIME = 30  # [us] in which a WS2812 hears its 24 bits
LATCH = 300  # [us] of silence before it shows them


@dataclass(frozen=True)
class LampTable:
    """The light of a drawing, from its beginning on.

    Attributes:
        leds: how many.
        tick: [us].
        data: the entries.
        about: lines that describe it.
    """

    leds: int
    tick: int
    data: bytes
    about: tuple[str, ...]


def lamp_table(painting: "paint.Painting") -> LampTable:
    """The light of a painting's motion, as 8 bits of each LED can show it.

    Raises:
        DqpaintError: brushes of different lamps, colours that follow each other faster than the
            LEDs can be told, or a table that is too long.
    """
    motion = painting.motion
    light = sweeps(motion, motion.pose, motion.light, painting.settings)
    places = light[0].emitters.positions
    if any(not np.array_equal(one.emitters.positions, places) for one in light):
        raise DqpaintError("the drawing has brushes of different lamps, and a table is for one")
    times, glow = _glow(light)
    full = max(float(glow.max()), float(max(one.emitters.tints.max() for one in light)))
    levels = np.floor(FULL * glow / full + 0.5).astype(np.uint8)
    lost = int(((glow > 0) & (levels == 0)).sum())
    starts = np.append(True, (np.diff(levels.reshape(len(levels), -1), axis=0) != 0).any(axis=1))
    held = np.diff(np.append(times[:-1][starts], times[-1]))
    levels, leds = levels[starts], len(places)
    busy = leds * LED_TIME + LATCH
    if held.min() < busy:
        raise DqpaintError(
            f"colours are held for {held.min() / 1e3:g} ms, and {leds} LEDs take {busy / 1e3:g} ms "
            "to be told: write a longer period, a slower strobe, or a brush of fewer lamps"
        )
    tick = gcd(*held.tolist())
    data = _encoded(held // tick, levels)
    if len(data) > LARGEST:
        raise DqpaintError(
            f"the table would have {len(data):,} bytes, more than {LARGEST:,}: write a longer "
            "period, plainer colours, or a brush of fewer lamps"
        )
    about = (
        "The light, baked: one wire from the robot starts it. Never run on a board.",
        trajectory_of(painting).about[0],
        f"{leds} LEDs, {len(held)} colours in {times[-1] / 1e6:.9g} s, {len(data)} bytes; linear, "
        f"{FULL} is {full:.6g} of the brush's light; no gamma: film is linear.",
        f"The shortest is held for {held.min() / 1e3:g} ms; WS2812 show it {busy / 1e3:g} ms late.",
        *([f"{lost} values are too dim for 8 bits and are off."] if lost else []),
    )
    return LampTable(leds, tick, data, about)


def _glow(light: tuple[Sweep, ...]) -> tuple[NDArray[np.int64], NDArray[np.float64]]:
    """Times (M + 1,) [us] between which every LED (M, K, 3) holds."""
    first = light[0]
    rows = np.round(first.time * 1e6).astype(np.int64)
    edges = rows
    if first.strobe is not None:
        edges = np.unique(np.concatenate([rows, *_flashes(first, rows)]))
    middle = 0.5 * (edges[1:] + edges[:-1])
    row = np.clip(np.searchsorted(rows, middle, side="right") - 1, 0, len(rows) - 2)
    glow = np.zeros((len(middle), len(first.emitters.positions), 3))
    for one in light:
        looks = one.emitters.tints
        look = np.minimum((one.progress[row] * len(looks)).astype(int), len(looks) - 1)
        glow += one.colours[row][:, None, :] * looks[look]
    if first.strobe is not None:
        frequency, duty = first.strobe[row].T
        glow[(middle * 1e-6 * frequency) % 1.0 >= duty] = 0.0
    return edges, glow


def _flashes(sweep: Sweep, rows: NDArray[np.int64]) -> list[NDArray[np.int64]]:
    """When strobes go on and off [us], each within its own rows."""
    assert sweep.strobe is not None
    found = []
    for frequency, duty in np.unique(sweep.strobe, axis=0).tolist():
        if frequency == 0.0:
            continue
        cycles = np.arange(int(rows[-1] * 1e-6 * frequency) + 1)
        for part in (0.0, duty):
            at = np.round((cycles + part) / frequency * 1e6).astype(np.int64)
            row = np.searchsorted(rows, at, side="right") - 1
            inside = (at < rows[-1]) & (row < len(sweep.strobe))
            at, row = at[inside], row[inside]
            found.append(at[(sweep.strobe[row] == (frequency, duty)).all(axis=1)])
    return found


def _encoded(ticks: NDArray[np.int64], levels: NDArray[np.uint8]) -> bytes:
    """The entries; one that is longer than 16 bits hold is several."""
    out = bytearray()
    for count, colours in zip(ticks.tolist(), levels, strict=True):
        rest = count
        while rest:
            now = min(rest, LONGEST)
            out += now.to_bytes(2, "little") + colours.tobytes()
            rest -= now
    return bytes(out)

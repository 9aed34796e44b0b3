"""Poses and a brush -> sweeps of light, cut where anything changes, and their emission."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from dqpaint import dq
from dqpaint.brushes import POINT, Emitters
from dqpaint.errors import DqpaintError
from dqpaint.light.arrays import BATCH, Floats, checked_array
from dqpaint.light.camera.camera import NEAREST_DEPTH, Camera
from dqpaint.light.sources import interpolation
from dqpaint.light.sources import strobe as gates
from dqpaint.light.sources.emission import Light, inverse_square, lit_instants
from dqpaint.light.sources.occlusion import Occluder, Occlusion, occlusion_by
from dqpaint.light.sources.sheet import Sheet

ALL_SAMPLES = slice(None)
CHORD_TOLERANCE = 0.15
"""Largest deviation of a chord from the smooth path [px]."""
LAMP_GROUPS = 8
"""Number of lamp groups that represent a brush when it lights a scene."""
LAMP_CHORD_TOLERANCE = 0.005
"""Largest deviation of a chord from the smooth path for these groups [m]."""


@dataclass(frozen=True, eq=False)
class Steps:
    """M steps of a sweep, cut where anything changes.

    Attributes:
        time: (M+1,) [s].
        position: (M+1, 3) of the tool [m].
        rotation: (M+1, 4) of the tool.
        energy: (M, 3) of the whole brush, before its tints [lamp s].
        row: (M,) which row of the tints holds.
    """

    time: Floats
    position: Floats
    rotation: Floats
    energy: Floats
    row: NDArray[np.int64]


@dataclass(frozen=True, eq=False)
class Sweep:
    """A brush carried through N instants a period apart. Arrays are copied and read-only.

    Attributes:
        period: [s].
        pose: (N, 8) of the tool, base frame.
        colours: (N-1, 3) mean linear RGB from instant k to k+1.
        emitters: what the tool carries.
        strobe: (N-1, 2) frequency [Hz], 0 for a steady light, and duty from 0 to 1.
        pwm: frequency at which the lamps are dimmed [Hz]; 0 dims them evenly.
        occlusion: what hides it from the one camera it is for; None: nothing does.
    """

    period: float
    pose: Floats
    colours: Floats
    emitters: Emitters = POINT
    strobe: Floats | None = None
    pwm: float = 0.0
    occlusion: Occlusion | None = None

    def __post_init__(self) -> None:
        if not (np.isfinite(self.period) and self.period > 0.0):
            raise DqpaintError(f"period {self.period} s must be positive")
        pose = checked_array("tool pose", self.pose, (None, 8))
        if len(pose) == 0:
            raise ValueError("the tool has no poses; it needs at least one")
        object.__setattr__(self, "pose", pose)
        colours = checked_array("lamp colour", self.colours, (len(pose) - 1, 3))
        if colours.min(initial=0.0) < 0.0:
            raise DqpaintError(f"lamp colour {colours.min()} is negative")
        object.__setattr__(self, "colours", colours)
        if self.strobe is not None:
            object.__setattr__(
                self, "strobe", checked_array("strobe", self.strobe, (len(colours), 2))
            )
        if not (np.isfinite(self.pwm) and self.pwm >= 0.0):
            raise DqpaintError(f"PWM frequency {self.pwm} Hz must not be negative")

    @cached_property
    def time(self) -> Floats:
        """Times (N,) on the run's clock [s]."""
        return np.arange(len(self.pose), dtype=np.float64) * self.period

    @cached_property
    def positions(self) -> Floats:
        """Positions (N, 3) of the tool [m]."""
        return dq.translation(self.pose)

    @cached_property
    def rotations(self) -> Floats:
        """Orientations (N, 4) of the tool."""
        return dq.rotation(self.pose)

    @cached_property
    def _tangents(self) -> tuple[Floats, Floats]:
        return interpolation.tangents(self.positions)

    @cached_property
    def lamp_travel(self) -> Floats:
        """Mean distance (N-1,) that the lamps move from one instant to the next [m]."""
        ends = self.base_positions(self.positions, self.rotations, self.emitters.outermost)
        return np.asarray(np.sqrt((np.diff(ends, axis=0) ** 2).sum(axis=2)).mean(axis=1))

    @cached_property
    def progress(self) -> Floats:
        """Progress (N,) of the brush along its lit path at each instant, 0 to 1.

        The way is the mean of what the ends of the brush walk, so that a bar that only turns gets
        on, too.
        """
        walked = np.where(self.colours.any(axis=1), self.lamp_travel, 0.0)
        total = walked.sum()
        if total == 0.0:
            return np.zeros(len(self.pose))
        return np.concatenate([[0.0], np.minimum(np.cumsum(walked) / total, 1.0)])

    def base_positions(self, position: Floats, rotation: Floats, local: Floats) -> Floats:
        """Base-frame positions (M, K, 3) of points `local` (K, 3) in the tool frame [m]."""
        return np.asarray(position[:, None, :] + dq.rotate(rotation[:, None, :], local[None, :, :]))

    def occluded_by(self, body: Occluder, eye: Floats) -> Sweep:
        """The same sweep as an eye (3,) [m] sees it, occluded by a body."""
        return replace(self, occlusion=occlusion_by(self, body, eye))

    def lamp_paths(self, samples: slice = ALL_SAMPLES) -> Iterator[tuple[Floats, Floats]]:
        """Paths (N, 3) and energies (N-1, 3) of lamps that light a scene as the brush does.

        All of its energy, in a few groups of its lamps; beams are not regarded [m, lamp s].
        """
        groups = np.array_split(np.arange(len(self.emitters.positions)), LAMP_GROUPS)
        for steps in self.steps(LAMP_CHORD_TOLERANCE, samples):
            for group in groups:
                if len(group):
                    middle = self.emitters.positions[group].mean(axis=0, keepdims=True)
                    points = self.base_positions(steps.position, steps.rotation, middle)[:, 0]
                    tints = self.emitters.tints[:, group].sum(axis=1)
                    yield points, steps.energy * tints[steps.row]

    @property
    def lit_points(self) -> Floats:
        """Outermost lamps (K, 3) at both ends of every lit step [m], to frame a picture."""
        lit = lit_instants(self.colours)
        if self.emitters.single:
            return np.asarray(self.positions[lit])
        rotation = self.rotations[lit]
        return self.base_positions(self.positions[lit], rotation, self.emitters.outermost).reshape(
            -1, 3
        )

    def chord_tolerance(self, camera: Camera) -> float:
        """`CHORD_TOLERANCE` at the nearest lit position [m]."""
        lit = lit_instants(self.colours)
        _, depth = camera.project(self.positions[lit])
        seen = depth[depth > NEAREST_DEPTH]
        return CHORD_TOLERANCE * float(seen.min() if len(seen) else 1.0) / camera.focal

    def steps(self, tolerance: float, samples: slice = ALL_SAMPLES) -> Iterator[Steps]:
        """Yield the steps in the order of time, in batches, cut where the light switches.

        Args:
            tolerance: How far a chord may be from the smooth way [m].
            samples: Which of the N-1 steps between samples.
        """
        bulges = interpolation.chord_deviation(self.positions, self._tangents)
        if not self.emitters.single:
            bulges = bulges + interpolation.rotation_deviation(self.rotations, self.emitters.reach)
        count = np.where(self.colours.any(axis=1), interpolation.part_counts(bulges, tolerance), 1)
        for rows in self._batches(count, samples):
            yield self._steps(rows, count[rows])

    def _batches(self, count: NDArray[np.int64], samples: slice) -> Iterator[slice]:
        """Slices of samples whose number of cut steps times lamps stays within a fixed budget."""
        work = count + self._most_switches()
        lamps = len(self.emitters.positions)
        budget = BATCH if lamps == 1 else max(1, 4 * BATCH // lamps)
        done = np.cumsum(work)
        first, end, _ = samples.indices(len(work))
        while first < end:
            before = done[first - 1] if first else 0
            last = max(first + 1, int(np.searchsorted(done, before + budget, side="right")))
            last = min(last, end)
            yield slice(first, last)
            first = last

    def _most_switches(self) -> NDArray[np.int64]:
        """The largest number (N-1,) of cuts where light switches, from an instant to the next."""
        most = np.zeros(len(self.colours), np.int64)
        for frequency, _ in self._gates(slice(None)):
            most += gates.most_cuts(self.period, frequency)
        if len(self.emitters.tints) > 1:
            most += np.ceil(np.diff(self.progress) * len(self.emitters.tints)).astype(np.int64)
        return most

    @property
    def most_lamp_steps(self) -> int:
        """Lamps times steps that are worked on together, for a forecast: an instant to the next."""
        most = 1 + int(self._most_switches().max(initial=0))
        return most * len(self.emitters.positions)

    def _gates(self, rows: slice) -> Iterator[tuple[Floats, Floats]]:
        """Frequency and duty (M,) of everything that switches in some steps."""
        if self.strobe is not None:
            lit = self.colours[rows].any(axis=1)
            yield np.where(lit, self.strobe[rows, 0], 0.0), self.strobe[rows, 1]
        if self.pwm > 0.0:
            for colour in self.colours[rows].T:
                yield np.where(colour > 0.0, self.pwm, 0.0), np.minimum(colour, 1.0)

    def _steps(self, rows: slice, count: NDArray[np.int64]) -> Steps:
        begin = self.time[:-1][rows]
        instants = slice(rows.start, rows.start + len(begin) + 1)
        step, part = self._cuts(rows, count)
        place, rotation = self.positions[instants], self.rotations[instants]
        of, enter, leave = _pieces(len(begin), step, part)
        time = self.time[instants]
        if len(step):
            at = step + 1  # an instant is put before the end of its step
            cut = begin[step] + part * self.period
            tangent = self._tangents[0][rows], self._tangents[1][rows]
            inner = interpolation.position_at(place, tangent, step, part)
            turned = interpolation.rotation_at(rotation, step, part)
            place = np.insert(place, at, inner, axis=0)
            rotation = np.insert(rotation, at, turned, axis=0)
            time = np.insert(time, at, cut)
        middle = begin[of] + 0.5 * (enter + leave) * self.period
        energy = self._energy(rows, of, self.period * (leave - enter), middle)
        return Steps(time, place, rotation, energy, self._row(rows, of, enter, leave))

    def _cuts(self, rows: slice, count: NDArray[np.int64]) -> gates.Cuts:
        """Cuts of steps: for smoothness, at switches, and at the ends of rows of tints."""
        even = np.repeat(np.arange(len(count)), count - 1)
        nth = np.arange(len(even)) - np.repeat(np.cumsum(count - 1) - (count - 1), count - 1)
        steps, where = [even], [(nth + 1.0) / count[even]]
        begin, end = self.time[:-1][rows], self.time[1:][rows]
        for frequency, duty in self._gates(rows):
            step, part = gates.switch_cuts(begin, end, frequency, duty)
            steps.append(step)
            where.append(part)
        if len(self.emitters.tints) > 1:
            looks = len(self.emitters.tints)
            low, high = self.progress[:-1][rows] * looks, self.progress[1:][rows] * looks
            step, part = gates.integer_crossings(low, high)
            steps.append(step)
            where.append(part)
        step, part = np.concatenate(steps), np.concatenate(where)
        order = np.lexsort((part, step))
        return step[order], part[order]

    def _energy(
        self, rows: slice, of: NDArray[np.int64], duration: Floats, middle: Floats
    ) -> Floats:
        """Energy (M, 3) of the brush in each piece of a step: colour times its on time."""
        colour = self.colours[rows][of]
        if self.pwm > 0.0:
            on = gates.is_on(middle[:, None], np.full((1, 1), self.pwm), np.minimum(colour, 1.0))
            colour = np.where(on, np.maximum(colour, 1.0) * (colour > 0.0), 0.0)
        if self.strobe is not None:
            frequency, duty = self.strobe[rows][of].T
            colour = colour * gates.is_on(middle, frequency, duty)[:, None]
        return np.asarray(colour * duration[:, None])

    def _row(
        self, rows: slice, of: NDArray[np.int64], enter: Floats, leave: Floats
    ) -> NDArray[np.int64]:
        looks = len(self.emitters.tints)
        if looks == 1:
            return np.zeros(len(of), np.int64)
        low, high = self.progress[:-1][rows][of], self.progress[1:][rows][of]
        middle = low + 0.5 * (enter + leave) * (high - low)
        return np.minimum((middle * looks).astype(np.int64), looks - 1)

    def emission_to(
        self, camera: Camera, falloff: bool = False, samples: slice = ALL_SAMPLES
    ) -> Iterator[Light | Sheet]:
        """See `Emission`; `samples` selects from the N-1 steps between samples."""
        if not self.colours[samples].any():
            return
        for steps in self.steps(self.chord_tolerance(camera), samples):
            if self.emitters.joined < 1.0:
                yield self._lamps(steps, camera, falloff)
            if self.emitters.joined > 0.0:
                yield self._line(steps, camera, falloff)

    def _lamps(self, steps: Steps, camera: Camera, falloff: bool) -> Light:
        """All lamps as one path, one after the other, with dark steps between them."""
        e = self.emitters
        if e.single:
            points, energy = steps.position[:, None, :], steps.energy[:, None, :]
        else:
            points = self.base_positions(steps.position, steps.rotation, e.positions)
            energy = steps.energy[:, None, :] * e.tints[steps.row]
        if e.joined > 0.0:
            energy = energy * (1.0 - e.joined)
        if falloff or e.lobe > 0.0:
            middle = 0.5 * (points[1:] + points[:-1])
            energy = energy * self._sent(middle, steps, camera, falloff)[..., None]
        if self.occlusion is not None:
            energy = self.occlusion.attenuate_lamps(steps.time, energy)
        if len(e.positions) == 1:
            return Light(points[:, 0], energy[:, 0], e.size)
        dark = np.zeros((len(e.positions), 1, 3))
        apart = np.concatenate([energy.transpose(1, 0, 2), dark], axis=1).reshape(-1, 3)[:-1]
        return Light(points.transpose(1, 0, 2).reshape(-1, 3), apart, e.size)

    def _line(self, steps: Steps, camera: Camera, falloff: bool) -> Sheet:
        """The part of the light that a diffuser spreads along the line of lamps."""
        e = self.emitters
        ends = self.base_positions(steps.position, steps.rotation, e.extent)
        energy = steps.energy * e.joined
        if falloff or e.lobe > 0.0:
            middle = 0.25 * (ends[1:] + ends[:-1]).sum(axis=1, keepdims=True)
            energy = energy * self._sent(middle, steps, camera, falloff)
        tints, row = e.tints, steps.row
        if self.occlusion is not None:
            tints, row = self.occlusion.attenuate_line(steps.time, energy, tints, row)
        return Sheet(ends, energy, tints, row)

    def _sent(self, middle: Floats, steps: Steps, camera: Camera, falloff: bool) -> Floats:
        """The share (M, K) of the light at positions (M, K, 3) that goes towards the camera."""
        sent = np.ones(middle.shape[:2])
        if self.emitters.lobe > 0.0:
            normal = dq.rotate(steps.rotation, np.array(self.emitters.normal))
            normal = 0.5 * (normal[1:] + normal[:-1])[:, None, :]
            ray = camera.position - middle
            length = np.sqrt((ray * ray).sum(axis=-1))
            cosine = (ray * normal).sum(axis=-1) / np.maximum(length, NEAREST_DEPTH)
            sent *= np.clip(cosine, 0.0, 1.0) ** self.emitters.lobe
        if falloff:
            sent *= inverse_square(middle, camera)
        return sent


def _pieces(
    count: int, step: NDArray[np.int64], part: Floats
) -> tuple[NDArray[np.int64], Floats, Floats]:
    """The pieces between ordered cuts: the step of each, where it begins and where it ends."""
    of = np.insert(np.arange(count), step, step)
    enter, leave = np.zeros(len(of)), np.ones(len(of))
    ends = step + np.arange(len(step))
    leave[ends], enter[ends + 1] = part, part
    return of, enter, leave

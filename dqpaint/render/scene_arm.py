"""The motion of an arm in a run -> its occlusion of the light and its look in the picture."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass
from functools import cached_property
from os import PathLike
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from dqpaint.diagnostics import SourceLine
from dqpaint.dq import Floats
from dqpaint.light import Image
from dqpaint.light.camera import Camera
from dqpaint.motion import RowLines
from dqpaint.program import Wall
from dqpaint.robots.model import Card
from dqpaint.robots.urdf import prepare, urdf_file
from dqpaint.settings import Settings

if TYPE_CHECKING:
    from dqpaint.render.arm_shapes import Arm
    from dqpaint.render.ray_casting import RayCaster


Scenery = tuple[tuple[Wall, ...], Floats, Floats]
Shine = Callable[[slice], Sequence[tuple[Floats, Floats]]]
MOVIE_SIDE = 480
"""Pixels of the longer side at which the arm is rendered in a movie."""
MOVIE_LAMPS = 32
"""Number of lamps for the painting in a movie."""


@dataclass(frozen=True, eq=False)
class HiddenLight:
    """Light that the arm's own body occluded.

    Attributes:
        energy: (3,) of it, linear RGB [lamp s].
        lines: (line, share of all light) of the lines it comes from, the most first.
    """

    energy: Floats
    lines: tuple[tuple[SourceLine, float], ...]


def hidden_by_line(hidden: Floats, emitted: Floats, source: RowLines) -> HiddenLight:
    """The hidden light of each source line.

    Args:
        hidden: (M, 3) of each step, linear RGB [lamp s].
        emitted: (M, 3) of each step, hidden or not.
        source: the line (M,) of each step.
    """
    lines = source.lines
    amounts = np.bincount(source.index, hidden.sum(axis=1), len(lines))
    share = amounts / max(float(emitted.sum()), 1e-300)
    order = np.argsort(-share, kind="stable")
    found = tuple((lines[i], float(share[i])) for i in order if share[i] > 0.0)
    return HiddenLight(hidden.sum(axis=0), found)


class SceneArm:
    """An arm with the postures of a run. Its shapes are loaded when they are first needed.

    Args:
        urdf: its description.
        posture: (N, n) at instants a period apart, from time 0 on [rad].
        period: [s].
        source: the line (N,) at these instants; None: they are not known.
        whole: whether the description has all shapes that its arm should have.
        walls: of the drawing, its frame (8,) and its middle (3,), to be shown beside the arm.
        instead: what to install for the arm's own shapes, where these are ours.

    Attributes:
        source: as given; line 0 if unknown.
    """

    def __init__(
        self,
        urdf: str | PathLike[str],
        posture: Floats,
        period: float,
        source: RowLines | None = None,
        whole: bool = True,
        walls: Scenery | None = None,
        instead: str = "",
    ) -> None:
        self._urdf = urdf
        self._whole = whole
        self._instead = instead
        self._posture = posture
        unknown = [SourceLine(0, 0)] * len(posture)
        self.source = RowLines.from_lines(unknown) if source is None else source
        self._period = period
        self._walls = walls

    @cached_property
    def arm(self) -> Arm:
        """The arm."""
        from dqpaint.render.arm_shapes import Arm

        arm = Arm(self._urdf)
        if self._walls is not None:
            from dqpaint.render.wall_shapes import wall_surfaces

            arm.beside = list(wall_surfaces(*self._walls))
        return arm

    @cached_property
    def ray_caster(self) -> RayCaster:
        """The arm's shapes for ray casting."""
        from dqpaint.render.ray_casting import RayCaster

        return RayCaster(self.arm)

    @property
    def can_occlude(self) -> bool:
        """Whether the arm has shapes and rays can hit all of them."""
        return self._whole and bool(self.arm.shapes) and not self._unread

    @property
    def _unread(self) -> list[str]:
        return sorted({Path(name).name for name in self.arm.unread + self.ray_caster.unread})

    @property
    def remarks(self) -> list[str]:
        """The parts of the arm that cannot be shown, one sentence each."""
        untraced = "and what it hides is not traced"
        if not self._whole:
            return [f"warning: a mesh of the arm cannot be read and is not shown, {untraced}"]
        if self._unread:
            names = self._unread
            return [
                f"warning: {name} cannot be read: it is not shown, {untraced}" for name in names
            ]
        if not self.arm.shapes:
            return [f"warning: the arm's file has no shapes: the arm cannot be shown, {untraced}"]
        if self._instead:
            return [f"note: the arm has plain shapes of our own; its meshes: {self._instead}"]
        return []

    def visible(self, time: Floats, places: Floats, lit: NDArray[np.bool_], eye: Floats) -> Floats:
        """The share (M, K) of the light of K lamps that reaches the eye, 0 to 1.

        Args:
            time: (M,) of the run's clock, in order [s].
            places: (M, K, 3) of the lamps then, base frame [m].
            lit: (M,) whether any of them burns.
            eye: (3,) of the camera [m].
        """
        from dqpaint.render.occlusion import visible_share

        clock = np.arange(len(self._posture)) * self._period
        posture = np.stack([np.interp(time, clock, joint) for joint in self._posture.T], axis=1)
        return visible_share(self.ray_caster, posture, places, eye, lit)

    def render_still(
        self, camera: Camera, shine: Shine, exposure: float, falloff: bool = False
    ) -> Image:
        """Linear light (H, W, 3) of arm and floor, to be added before development.

        The arm is flashed at the end.

        Args:
            camera: that of the picture.
            shine: of some steps between samples, of each lamp its points (N, 3) [m] and the energy
                (N-1, 3) between them.
            exposure: of the picture: factor from its own unit [lamp s / px^2] to saturation.
            falloff: whether that unit is divided by the distance squared [lamp s / (m px)^2].
        """
        from dqpaint.render.still import gather_glow, render_arm

        self.arm.set_posture(self._posture[-1])
        return render_arm(self.arm, camera, gather_glow(shine(slice(None))), exposure, falloff)

    def render_blurred(
        self, camera: Camera, shine: Shine, exposure: float, falloff: bool = False
    ) -> Image:
        """The same for an arm that is visible during its whole motion, without a flash."""
        from dqpaint.render.motion_blur import blurred_arm

        return blurred_arm(self.arm, self._posture, camera, shine, exposure, falloff)

    def render_frames(
        self, camera: Camera, shine: Shine, exposure: float, falloff: bool, rows: Sequence[int]
    ) -> Iterator[Image]:
        """The same at some instants of the run, each lit by the light painted until then.

        They are coarser, for a moving picture.
        """
        from dqpaint.render.still import gather_glow, render_arm

        whole = gather_glow(shine(slice(None)))
        scale = min(1.0, MOVIE_SIDE / max(camera.width, camera.height))
        for row in rows:
            self.arm.set_posture(self._posture[row])
            light = whole.part(shine(slice(0, row)), MOVIE_LAMPS)
            yield render_arm(self.arm, camera, light, exposure, falloff, scale)


@dataclass(frozen=True, eq=False)
class ArmMotion:
    """The motion of an arm in a run: with its card, all data needed to render it.

    Attributes:
        robot: what `find_card` finds its card by.
        posture: (N, n) at instants a period apart, from time 0 on [rad]; (N, 0) where the run was
            recorded as poses.
        source: the line (N,) at these instants.
        period: [s].
        walls: of the drawing, its frame (8,) and its middle (3,) [m].
    """

    robot: str
    posture: Floats
    source: RowLines
    period: float
    walls: Scenery | None = None

    @property
    def has_joints(self) -> bool:
        """Whether the motion of the joints is known."""
        return len(self.posture.T) > 0


@contextmanager
def scene_arm_of_run(settings: Settings, card: Card, cast: ArmMotion) -> Iterator[SceneArm | None]:
    """The arm of a run, if the settings use it and the run has joint angles.

    Raises:
        DqpaintError: the arm's description is not there, or cannot be read.
    """
    if not (settings.staged and cast.has_joints):
        yield None
        return
    whole = prepare(card).whole
    with urdf_file(card) as path:
        yield SceneArm(
            path, cast.posture, cast.period, cast.source, whole, cast.walls, card.meshes_hint
        )

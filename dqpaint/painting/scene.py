"""Motion and poses -> Scene: the lights of a painting, and what sets camera and exposure.

A scene has light alone, no robot and no text: `--save film` stores it, and it is enough for another
view, size, look or exposure.
"""

from dataclasses import dataclass, field, replace

import numpy as np

from dqpaint import dq
from dqpaint.brushes import Emitters, read_brush, read_lamp
from dqpaint.dq import Floats
from dqpaint.errors import DqpaintError, UsageError
from dqpaint.light.camera import parse_exposure, parse_views
from dqpaint.light.film import BLADE_RANGE, LOOKS
from dqpaint.light.images import Legend
from dqpaint.light.sources import Sweep, even_by_length, sweeps
from dqpaint.metrics import Table, reference_columns
from dqpaint.motion import Motion
from dqpaint.painting.colour_by import colours_by_column, magnified_poses, read_colour_by
from dqpaint.settings import Settings

JUMP_TIME = 0.25  # [s] in which a jump of the set point counts as drawn
OVERLAY_COLOUR = (0.62, 0.8, 1.0)  # the colour of the asked drawing under the reached one


@dataclass(frozen=True, eq=False)
class Scene:
    """The lights of a painting, and what sets camera and exposure.

    Attributes:
        name: Of the drawing.
        light: What shines, one sweep a brush.
        reference: The light of the reference motion: it alone sets camera and exposure, so that
            pictures of two control laws can be laid over each other.
        overlay: The reference drawn as faint lines below the light.
        front: (3, 3) columns: right, up and towards the viewer, base frame.
        legend: What the colours mean, if they show a column.
        corners: (K, 3) of photographs, that must be in the picture, too [m].
        exposure: Of the film that the light was solved for [m^2 / (lamp s)]; None: by the light.
    """

    name: str
    light: tuple[Sweep, ...]
    reference: tuple[Sweep, ...]
    overlay: tuple[Sweep, ...]
    front: Floats
    legend: Legend | None = None
    corners: Floats = field(default_factory=lambda: np.empty((0, 3)))
    exposure: float | None = None

    @property
    def shown_points(self) -> Floats:
        """(K, 3) points that must be in the picture [m]."""
        return np.concatenate([*(sweep.lit_points for sweep in self.reference), self.corners])

    @property
    def seconds(self) -> float:
        """How long the painting takes [s]."""
        return max(float(sweep.time[-1]) for sweep in self.light)


def check_light_settings(settings: Settings) -> None:
    """Check the settings of light before anything is simulated; raises UsageError."""
    shots = parse_views(settings.view)
    LOOKS[settings.look]
    if settings.starburst and not BLADE_RANGE[0] <= settings.starburst <= BLADE_RANGE[1]:
        bounds = f"{BLADE_RANGE[0]} to {BLADE_RANGE[1]} blades; 0 is a round one"
        raise UsageError(f"starburst {settings.starburst}: an aperture has {bounds}")
    read_lamp(settings.lamp)
    if settings.brush is not None:
        read_brush(settings.brush).emitters()
    if settings.exposure is not None:
        exposure = parse_exposure(settings.exposure)
        if exposure and exposure.distance is not None and any(shot.position for shot in shots):
            raise UsageError(
                f"view '{settings.view}' gives the camera's position: leave the distance out of "
                f"exposure '{settings.exposure}'"
            )
    if settings.colour_by is not None:
        read_colour_by(settings.colour_by)


def make_scene(
    motion: Motion, pose: Floats, settings: Settings, table: Table | None = None
) -> Scene:
    """The scene of a motion's light carried through poses (N, 8), base frame.

    Args:
        motion: The reference.
        pose: Of the tool, true or reference.
        settings: Brush, dimming and the column that colours show.
        table: Columns of the run, for `colour_by`; None without an arm.

    Raises:
        DqpaintError: No light is on anywhere.
    """
    if not motion.lit.any():
        raise DqpaintError(
            f"{motion.program.name}: no light is on anywhere, so the picture would be black"
        )
    colours, legend = motion.light, None
    metered = colours
    if settings.colour_by is not None:
        columns = reference_columns(motion) if table is None else table
        colours, legend = colours_by_column(motion, columns, settings.colour_by)
        metered = np.where(motion.lit[:, None], np.ones(3), 0.0)  # as bright as the legend's strip
    even = settings.colour_by is not None
    shown = pose if settings.magnify == 1.0 else magnified_poses(motion, pose, settings.magnify)
    under = _thin_lines(
        sweeps(motion, motion.pose, np.where(motion.lit[:, None], OVERLAY_COLOUR, 0.0), settings)
    )
    return Scene(
        motion.program.name,
        sweeps(motion, shown, colours, settings, even),
        sweeps(motion, motion.pose, _metered(motion, metered), settings, even),
        under if settings.overlay else (),
        dq.matrix_from_quaternion(motion.front),
        legend,
        motion.photo_frames.reshape(-1, 3),
        motion.exposure if legend is None else None,
    )


def with_shutter(scene: Scene, settings: Settings) -> Scene:
    """The scene without the light that shines after the shutter has closed.

    Raises:
        UsageError: The shutter closes before any light is on.
    """
    real = parse_exposure(settings.exposure or "auto")
    if real is None or real.shutter is None or real.shutter >= scene.seconds:
        return scene
    light = tuple(_until(sweep, real.shutter) for sweep in scene.light)
    if not any(sweep.colours.any() for sweep in light):
        raise UsageError(
            f"exposure '{settings.exposure}': the shutter closes after {real.shutter:g} s, before "
            f"any light of {scene.name} is on"
        )
    return replace(scene, light=light)


def _until(sweep: Sweep, seconds: float) -> Sweep:
    """The sweep with no light after some seconds."""
    share = np.clip((seconds - sweep.time[:-1]) / sweep.period, 0.0, 1.0)
    return replace(sweep, colours=sweep.colours * share[:, None])


def _metered(motion: Motion, colours: Floats) -> Floats:
    """The colours (N, 3) the exposure is chosen from.

    A set point that jumps leaves no line, but the arm that follows it does: the jump counts as a
    line drawn in `JUMP_TIME`.
    """
    weight = np.where(motion.jump, JUMP_TIME / motion.period, 1.0)
    return np.asarray(colours * weight[:, None])


def _thin_lines(sweeps: tuple[Sweep, ...]) -> tuple[Sweep, ...]:
    """The same as lines, of the tool's point or the ends of its bar, equally bright all along."""
    thin = []
    for sweep in sweeps:
        places = sweep.emitters.extent
        if len(sweep.emitters.positions) == 1 or not sweep.emitters.straight:
            places = np.zeros((1, 3))
        lines = Emitters(places, np.ones((1, len(places), 3)))
        thin.append(even_by_length(replace(sweep, emitters=lines, strobe=None, pwm=0.0)))
    return tuple(thin)

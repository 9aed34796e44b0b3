"""Program and settings -> Preview: the pictures of the reference, without an arm."""

from collections.abc import Callable
from dataclasses import dataclass, replace

from dqpaint.motion import Motion, plan
from dqpaint.painting.memory import PER_SAMPLE_OF_PREVIEW, check_run_memory
from dqpaint.painting.photos.photo_light import LitPhoto, solve_photos
from dqpaint.painting.picture import Picture, PictureSet, photograph
from dqpaint.painting.scene import Scene, check_light_settings, make_scene
from dqpaint.program import Program
from dqpaint.robots.loading import card_for
from dqpaint.settings import Settings


@dataclass(frozen=True, repr=False)
class Preview(PictureSet):
    """The reference motion and its pictures, one a view."""

    settings: Settings
    motion: Motion
    scene: Scene
    pictures: tuple[Picture, ...]
    photos: tuple[LitPhoto, ...] = ()

    def __repr__(self) -> str:
        motion = self.motion
        return f"<Preview of {motion.program.name}: {motion.length:.3g} m, {motion.t[-1]:.2f} s>"


def make_preview(
    program: Program, settings: Settings, progress: Callable[[float], None] = lambda _done: None
) -> Preview:
    """Make the reference pictures of a program.

    Raises:
        UsageError: an unknown robot, view, brush or look.
        DqpaintError: a fault in the drawing, or no light in it.
    """
    check_light_settings(settings)
    program = replace(program, most_samples=settings.max_samples)
    motion = plan(program, card_for(program, settings.robot, settings.tool).canvas.pose)
    motion, photos = solve_photos(motion, settings, progress)
    scene = make_scene(motion, motion.pose, settings)
    check_run_memory(scene.reference, settings, PER_SAMPLE_OF_PREVIEW)
    return Preview(settings, motion, scene, tuple(photograph(scene, settings)), photos)

"""The arm, the asked and the reached path and the light in space: the 3-D view of the page."""

from collections.abc import Sequence

import numpy as np
from nicegui import ui
from nicegui.elements.scene.scene_object3d import Object3D

from dqpaint import dq
from dqpaint.dq import Floats

BACKGROUND = "#0b0d12"
LIGHT_RADIUS = 0.008  # [m]
FAINT = (0.35, 0.42, 0.55)
FRAMES_PER_SECOND = 30
SMALLEST_MOVE = 1e-6  # [m] and in a quaternion: less is no move


class View3D:
    """The scene of one page."""

    def __init__(self) -> None:
        self.scene = ui.scene(
            grid=(2, 20),
            background_color=BACKGROUND,
            fps=FRAMES_PER_SECOND,
            camera=ui.scene.perspective_camera(fov=50),
        ).classes("scene")
        self._shapes: list[Object3D] = []
        self._robot = ""
        self._paths: list[Object3D] = []
        self._links: Floats | None = None
        self._shown: Floats | None = None
        with self.scene:
            self._light = ui.scene.sphere(LIGHT_RADIUS).material("#ffffff")
            self._light.visible(False)
        self.scene.move_camera(1.3, -1.2, 0.95, 0.3, 0, 0.4, duration=0)

    def show_arm(self, robot: str, urls: Sequence[tuple[str, tuple[float, float, float]]]) -> None:
        """Show the shapes of an arm; each is loaded once."""
        if robot == self._robot:
            return
        for shape in self._shapes:
            shape.delete()
        self._robot, self._shown = robot, None
        with self.scene:
            self._shapes = [ui.scene.stl(url).material(_colour(colour)) for url, colour in urls]

    def show_paths(self, urls: Sequence[str]) -> None:
        """Show other paths: of files made by `line_glb`."""
        for path in self._paths:
            path.delete()
        with self.scene:
            self._paths = [ui.scene.gltf(url) for url in urls]

    def set_motion(self, links: Floats) -> None:
        """The places (F, L, 7) of the shapes at the frames of a run."""
        self._links = links

    def show(self, frame: int, point: Floats, colour: Floats) -> None:
        """Put the arm into the posture of a frame, and the light to its point."""
        level = float(np.max(colour))
        shade = np.ones(3) if level <= 0 else np.sqrt(np.clip(colour / level, 0.0, 1.0))
        self._light.visible(True).move(*point.tolist())
        self._light.material(_colour(tuple(shade.tolist())) if level > 0 else "#39424f")
        if self._links is None or not len(self._links) or len(self._shapes) != self._links.shape[1]:
            return
        places = self._links[min(frame, len(self._links) - 1)]
        turns = np.stack([dq.matrix_from_quaternion(one) for one in places[:, 3:]])
        for i, (shape, place, turn) in enumerate(zip(self._shapes, places, turns, strict=True)):
            if self._shown is not None and np.abs(place - self._shown[i]).max() < SMALLEST_MOVE:
                continue
            shape.move(*place[:3].tolist())
            shape.rotate_R(turn.tolist())
        self._shown = places


def _colour(colour: Sequence[float]) -> str:
    return "#" + "".join(f"{round(255 * min(1.0, max(0.0, one))):02x}" for one in colour)

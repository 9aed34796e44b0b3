"""A painting -> its run in space as one page: arm, path, light and time, without a network."""

import importlib.util
from contextlib import redirect_stdout
from io import StringIO
from itertools import pairwise
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from dqpaint import dq
from dqpaint.dq import Floats
from dqpaint.errors import UsageError
from dqpaint.outputs.registry import Need, writer
from dqpaint.painting import paint

if TYPE_CHECKING:
    import viser

MOST_FRAMES = 300
FRAME_RATE = 20.0  # a second of the run
MOST_PATH_POINTS = 3000
ASKED = (90, 100, 120)  # colour of the reference
LIGHT_RADIUS = 0.006  # [m]


def _check_viser(_painting: object) -> None:
    if importlib.util.find_spec("viser") is None:
        raise UsageError("--save scene needs: pip install 'dqpaint[studio]'")


VISER = Need("viser: pip install 'dqpaint[studio]'", _check_viser, before=True)


@writer("scene", "-scene.html", VISER)
def scene(painting: paint.Painting) -> bytes:
    """The run in space as one HTML page that plays without a network; needs viser."""
    import viser

    with redirect_stdout(StringIO()):  # it tells where it can be seen, and that it stops
        server = viser.ViserServer(host="127.0.0.1", port=0, verbose=False)
        try:
            return _page(server, painting)
        finally:
            server.stop()


def _page(server: "viser.ViserServer", painting: paint.Painting) -> bytes:
    track, motion = painting.track, painting.motion
    count = int(np.clip(motion.t[-1] * FRAME_RATE, 2, MOST_FRAMES))
    frames = np.linspace(0, len(motion.t) - 1, count).round().astype(np.int64)
    server.scene.set_up_direction("+z")
    server.scene.add_grid("/floor", width=2.0, height=2.0, cell_size=0.1)
    _add_line(server, "/asked", motion.points, np.full((len(motion.t), 3), ASKED, np.uint8))
    arm = _Arm(server, painting, frames)
    light = server.scene.add_icosphere("/light", LIGHT_RADIUS, color=(255, 255, 255))
    server.initial_camera.position = (1.5, -1.4, 1.1)
    server.initial_camera.look_at = tuple(motion.points.mean(axis=0).tolist())
    serializer = server.get_scene_serializer()
    for i, (row, later) in enumerate(pairwise([*frames, frames[-1]])):
        arm.show(i)
        light.position = track.points[row]
        serializer.insert_sleep(float(motion.t[later] - motion.t[row]))
        _add_piece(server, painting, i, int(row), int(later))
    return serializer.as_html(dark_mode=True).encode()


class _Arm:
    """The shapes of the arm and their places at the frames."""

    def __init__(self, server: Any, painting: paint.Painting, frames: NDArray[np.int64]) -> None:
        from dqpaint.render import arm_view

        self._handles, self._poses = [], np.zeros((len(frames), 0, 8))
        if not painting.arm_motion.has_joints:
            return
        view = arm_view(painting.arm_motion.robot)
        self._poses = view.places(painting.track.posture[frames])
        for i, mesh in enumerate(view.meshes):
            self._handles.append(
                server.scene.add_mesh_simple(
                    f"/arm/{i}",
                    mesh.corners.reshape(-1, 3).astype(np.float32),
                    np.arange(3 * len(mesh.corners), dtype=np.uint32).reshape(-1, 3),
                    color=tuple(round(255 * one) for one in mesh.colour),
                )
            )

    def show(self, frame: int) -> None:
        """Put the shapes where they are at a frame."""
        for handle, pose in zip(self._handles, self._poses[frame], strict=True):
            handle.position, handle.wxyz = dq.translation(pose), dq.rotation(pose)


def _add_line(server: Any, name: str, points: Floats, colours: Floats) -> None:
    rows = np.unique(np.linspace(0, len(points) - 1, MOST_PATH_POINTS).round().astype(np.int64))
    places, shades = points[rows], colours[rows]
    server.scene.add_line_segments(
        name, np.stack([places[:-1], places[1:]], 1).astype(np.float32),
        np.stack([shades[:-1], shades[:-1]], 1).astype(np.uint8),
        thickness=1.5, thickness_units="screen",
    )  # fmt: skip


def _add_piece(server: Any, painting: paint.Painting, index: int, row: int, end: int) -> None:
    """What shone between two frames."""
    light = painting.motion.light[row:end]
    lit = light.max(axis=1, initial=0.0) > 0
    if not lit.any():
        return
    points = painting.track.points[row : end + 1]
    shades = 255 * np.sqrt(light / np.maximum(light.max(axis=1, keepdims=True), 1e-12))
    segments = np.stack([points[:-1], points[1:]], 1)[lit].astype(np.float32)
    colours = np.repeat(shades[lit][:, None], 2, axis=1).astype(np.uint8)
    server.scene.add_line_segments(
        f"/light-path/{index}", segments, colours, thickness=3.0, thickness_units="screen"
    )

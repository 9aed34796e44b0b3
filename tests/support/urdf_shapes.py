"""Arms of plain shapes, and rays through the pixels of a camera."""

import numpy as np

from dqpaint.light.camera.camera import Camera

HEAVY = (
    '<inertial><origin xyz="0.05 0.02 0.1" rpy="0.3 0 0"/><mass value="1"/>'
    '<inertia ixx="1" iyy="1" izz="1" ixy="0" ixz="0" iyz="0"/></inertial>'
)  # away from the link's frame, as the simulator counts from there


def shape(geometry, at="0 0 0", turn="0 0 0"):
    return f'<visual><origin xyz="{at}" rpy="{turn}"/><geometry>{geometry}</geometry></visual>'


BOX = shape('<box size="0.2 0.1 0.3"/>', "0 0 0.1", "0 0 0.4")
BALL = shape('<sphere radius="0.06"/>', "0 0 0.3")
ROD = shape('<cylinder radius="0.04" length="0.3"/>', "0 0 0.15", "0.2 0.5 0")
CAPSULE = shape('<capsule radius="0.04" length="0.3"/>', "0 0 0.15", "0.2 0 0")


def urdf(folder, base=BOX, first=CAPSULE, second=ROD + BALL):
    """The path of an arm of two joints."""
    limit = '<limit lower="-3" upper="3" effort="1" velocity="1"/>'
    text = (
        f'<robot name="plain"><link name="base">{HEAVY}{base}</link>'
        f'<link name="a">{HEAVY}{first}</link><link name="b">{HEAVY}{second}</link>'
        '<joint name="j1" type="revolute"><parent link="base"/><child link="a"/>'
        f'<origin xyz="0 0 0.2" rpy="0 0.3 0"/><axis xyz="0 1 0"/>{limit}</joint>'
        '<joint name="j2" type="revolute"><parent link="a"/><child link="b"/>'
        f'<origin xyz="0 0 0.3" rpy="0 0.3 0"/><axis xyz="1 0 0"/>{limit}</joint></robot>'
    )
    path = folder / "plain.urdf"
    path.write_text(text)
    return path


def rays(camera: Camera, box):
    """(h w, 3) ways through the middles of the pixels of a box, row by row."""
    x, y = np.meshgrid(np.arange(box.left, box.right), np.arange(box.top, box.bottom))
    x, y = (x - camera.centre[0]) / camera.focal, (y - camera.centre[1]) / camera.focal
    return np.stack([x, -y, -np.ones(x.shape)], axis=-1).reshape(-1, 3) @ camera.rotation

"""Mirrored blocks: every point, and where the tool points, are those of a reflection."""

import numpy as np
import pytest

from dqpaint import dq
from dqpaint.language import ScriptError, parse
from dqpaint.motion import plan
from tests.support.drawn import matrix, only, rotation

IDENTITY = np.array([1.0, 0, 0, 0, 0, 0, 0, 0])
DRAWINGS = {
    "lines": "line to (30, 5, -4) mm by (3, 30) mm tool rpy(20 deg, -10 deg, 65 deg)",
    "arc": "arc centre (10, 5) mm axis (0.2, 0, 1) angle 130 deg rise 20 mm grow 9 mm tool follow",
    "radius": "arc radius 40 mm to (30, 20, 2) mm left",
    "via": "arc via (10, 20, 5) mm to (30, -6, 2) mm",
    "screw": "screw about (5, -9, 3) mm along (1, 2, 3) angle 80 deg pitch 50 mm/turn",
    "look": "line to (30, 5, -4) mm tool look (2, 3, 400) mm up (0.3, 1, 0)",
    "look line": "line to (30, 5) mm tool look line (0, 0, 400) mm along (3, 1, 0.2)",
    "curve": "curve polar(40 mm, t) for t from 0 to 200 deg tool follow",
    "text": 'text "Ra" height 30 mm at (5, -3, 2) mm',
    "circle": "circle radius 30 mm at (5, -3, 2) mm",
}


def poses(text: str) -> tuple[np.ndarray, np.ndarray]:
    """Positions (N, 3) and rotation matrices (N, 3, 3)."""
    pose = plan(parse(text, "a.traj"), IDENTITY).pose
    return dq.translation(pose), np.array([matrix(q) for q in dq.rotation(pose)])


def reflection(normal: tuple[float, ...]) -> np.ndarray:
    n = np.array(normal) / np.linalg.norm(normal)
    return np.eye(3) - 2 * np.outer(n, n)


@pytest.mark.parametrize("name", DRAWINGS)
@pytest.mark.parametrize("normal", [(1, 0, 0), (0, 1, 0), (0.3, -2, 0.7)])
def test_points_are_mirrored_and_the_tool_points_as_its_image(name: str, normal: tuple) -> None:
    """Householder's reflection of the same drawing, which begins at a general pose."""
    block = "{}\n  start at (4, -3, 2) mm tool rpy(10 deg, 20 deg, 30 deg)\n  {}\nend\n"
    turn = "rotate rpy(10 deg, 20 deg, 30 deg) scale 1.5"
    plain = poses(block.format(f"with {turn}", DRAWINGS[name]))
    wall = f"mirror {normal} about (7, 8, 9) mm"
    made = poses(block.format(f"with {wall} {turn}", DRAWINGS[name]))
    s, point = reflection(normal), np.array([7, 8, 9]) * 1e-3
    np.testing.assert_allclose(made[0], (plain[0] - point) @ s.T + point, atol=1e-9)
    image = s @ plain[1] @ np.diag([-1.0, 1.0, 1.0])  # of the tool's axes y and z stay
    np.testing.assert_allclose(made[1], image, atol=1e-8)


def test_twice_mirrored_is_turned() -> None:
    """Two planes 30 degrees apart turn by 60."""
    double = "with mirror x mirror (cos(30 deg), sin(30 deg), 0)\n{}\nend"
    line = "line to (30, 5, -4) mm tool rpy(20 deg, -10 deg, 65 deg)"
    segment, plain = only(double.format(line)), only(line)
    turn = reflection((1, 0, 0)) @ reflection((np.cos(np.pi / 6), 0.5, 0))
    np.testing.assert_allclose(turn, rotation((0, 0, 1), -60), atol=1e-12)
    np.testing.assert_allclose(segment.end.position, turn @ plain.end.position, atol=1e-15)
    inner = matrix(plain.end.orientation)
    np.testing.assert_allclose(matrix(segment.end.orientation), turn @ inner, atol=1e-12)


def test_a_tool_that_faces_the_viewer_still_does() -> None:
    segment = only("with mirror x\nline to (30, 5) mm\nend")
    np.testing.assert_allclose(matrix(segment.end.orientation), np.eye(3), atol=1e-12)


@pytest.mark.parametrize(("parts", "code"), [
    ("mirror 3 mm", "E218"),
    ("mirror (0, 0, 0)", "E215"),
    ("mirror x shift (1, 0) mm about (3, 0) mm", "E248"),
])  # fmt: skip
def test_what_is_no_mirror(parts: str, code: str) -> None:
    with pytest.raises(ScriptError) as caught:
        parse(f"with {parts}\nline to (1, 0) mm\nend", "a.traj")
    assert caught.value.diagnostics[0].code == code

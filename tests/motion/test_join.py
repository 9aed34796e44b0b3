"""Every stroke begins and ends where the language says: two independent calculations."""

import numpy as np
import pytest

from dqpaint import dq
from dqpaint.language import parse
from dqpaint.motion.geometry.batched_shapes import shape

MOVES = {
    "line": "line by (20, -30, 10) mm",
    "circle": "arc centre (40, 5) mm axis (1, -2, 2) angle 100 deg",
    "helix": "arc centre (40, 5, 7) mm axis (1, -2, 2) angle -130 deg rise 30 mm",
    "spiral": "arc centre (40, 5, 7) mm axis (1, -2, 2) angle 1.3 turn rise -10 mm grow 25 mm",
    "via": "arc via (30, 40, 10) mm to (60, 5, 20) mm",
    "curve": "curve (10 + 40*cos(t), 20 + 30*sin(2*t), 10*sin(t)) mm for t from 0.3 rad to 2 rad",
}
TOOLS = [
    "tool keep",
    "tool rpy(30 deg, -40 deg, 80 deg)",
    "tool follow",
    "tool look (150, 90, -130) mm up (0, 3, 4)",
    "tool look line (90, -40, 180) mm along (1, -2, 2)",
]
RIGID = [
    "screw about (5, 6, 7) mm along (1, -2, 2) angle 100 deg pitch 30 mm/turn",
    "screw to (30, 10, 20) mm tool rpy(50 deg, 10 deg, -70 deg)",
]
LINES = [f"{move} {tool}" for move in MOVES.values() for tool in TOOLS] + RIGID


@pytest.mark.parametrize("line", LINES)
def test_strokes_begin_and_end_where_the_language_says(line):
    start = "start at (11, -7, 5) mm tool rpy(20 deg, 30 deg, 40 deg)\n"
    program = parse(f"{start}{line}\n", "join.traj")
    for segment in program.segments:
        flow = shape(segment).flow(np.array([0.0, 1.0]))
        for pose, wanted in zip(flow.pose, (segment.start, segment.end), strict=True):
            np.testing.assert_allclose(dq.translation(pose), wanted.position, atol=1e-12)
            asked = dq.pose_from(wanted.position, wanted.orientation)
            np.testing.assert_allclose(dq.nearest(pose, asked), asked, atol=1e-9)

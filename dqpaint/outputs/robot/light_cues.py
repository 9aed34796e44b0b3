"""Motion -> the light's colour changes with their times, for a controller of the lamp."""

import numpy as np

from dqpaint.motion import Motion
from dqpaint.outputs.robot.trajectory import comment_lines
from dqpaint.outputs.tables import encode_csv

DIGITS = 6  # of a colour: what changes less is one cue
HEADERS = ("t_s", "s_m", "red", "green", "blue", "strobe_Hz", "strobe_duty", "line")


def cue_sheet(motion: Motion, about: tuple[str, ...]) -> str:
    """A CSV with a row wherever the light changes; each holds until the next.

    Args:
        motion: the reference.
        about: lines that describe the file.

    Colours are linear, 1 is full brightness. A gradient is a row a sample. Of a lamp that flashes
    the frequency and the part of the time that it is on are named, from t = 0 on; 0 Hz is steady.
    """
    segments = motion.program.segments
    strobes = [segments[stroke].strobe for stroke in motion.stroke.tolist()]
    file = motion.source.file
    heads = (*HEADERS, "file") if file.any() else HEADERS
    rows = np.column_stack([
        np.round(motion.light, DIGITS),
        [strobe.frequency if strobe else 0.0 for strobe in strobes],
        [strobe.duty if strobe else 1.0 for strobe in strobes],
        motion.source.line,
        *([file] if file.any() else []),
    ])  # fmt: skip
    changes = np.append(True, (np.diff(rows, axis=0) != 0).any(axis=1))
    way = np.linalg.norm(np.diff(motion.points, axis=0), axis=1)
    walked = np.append(0.0, np.cumsum(way))
    values = np.column_stack([motion.t, walked, rows])[changes]
    head = comment_lines((
        *about,
        "Light cues: each holds until the next; linear colours from 0 to 1; t = 0 is the first "
        "point of the trajectory; s_m is the length of the reference's path until there.",
    ))  # fmt: skip
    return head + encode_csv(dict(zip(heads, values.T, strict=True))).decode()

"""Moves -> a program in KRL for KUKA's controllers: LIN and CIRC, light by TRIGGER.

mm and deg; A, B, C turn about z, the new y and the new x. A plain output would stop the advance
run, and with it the arm, so the light's outputs are set by triggers on the path.
"""

import numpy as np

from dqpaint import dq
from dqpaint.dq import Floats
from dqpaint.outputs.robot import (
    GEOMETRIC,
    Move,
    Moves,
    comment_lines,
    for_arm,
    moves_of,
    program_name,
)

LONGEST_NAME = 24
SMALLEST_TURN = 1.0  # [deg/s] to be asked of a tool that is held


@for_arm("krl", ".src", *GEOMETRIC, made_of=moves_of)
def krl(program: Moves) -> str:
    """A program for KUKA's controllers: lines and arcs, light along the path."""
    name = program_name(program.trajectory.name, LONGEST_NAME)
    notes = (
        f"KRL: save it as {name}.src. Red, green and blue are $ANOUT[1] to [3], 0 to 1.",
        f"$TOOL is the light on the link {program.link}; its flange may be turned on your arm.",
    )
    lines = [
        f"DEF {name}()",
        "  BAS(#INITMOV, 0)",
        "  $BASE = $NULLFRAME",
        f"  $TOOL = {frame(program.tool)}",
        "  $ORI_TYPE = #VAR",
        "  $CIRC_TYPE = #BASE",
        "  $APO.CDIS = 0.1",
        *_outputs((0.0, 0.0, 0.0)),
        "  PTP $AXIS_ACT",
        "  $VEL.CP = 0.05",
        f"  LIN {frame(program.start)}",
    ]
    colour: tuple[float, ...] = (0.0, 0.0, 0.0)
    pace = ""
    for move in program.moves:
        triggered = []
        if move.colour != colour:
            triggered = _outputs(move.colour) if move.wait else _triggers(move.colour)
            colour = move.colour
        now = f"  $VEL.CP = {max(move.speed, 1e-3):.6f}\n" + "\n".join(
            f"  $VEL.ORI{i} = {max(float(np.degrees(move.turn)), SMALLEST_TURN):.4f}"
            for i in (1, 2)
        )
        if now != pace and not move.wait:
            lines.append(now)
            pace = now
        lines += [*triggered, _instruction(move)]
    return comment_lines((*program.about, *notes), ";") + "\n".join(
        [*lines, *_outputs((0.0, 0.0, 0.0)), "END", ""]
    )


def _instruction(move: Move) -> str:
    if move.wait:
        return f"  WAIT SEC {move.wait:.6f}"
    end = frame(move.end) + (" C_DIS" if move.passing else "")
    return f"  LIN {end}" if move.via is None else f"  CIRC {{{_point(move.via)}}}, {end}"


def _triggers(colour: tuple[float, ...]) -> list[str]:
    return [
        f"  TRIGGER WHEN DISTANCE=0 DELAY=0 DO $ANOUT[{i}]={value:.5f}"
        for i, value in enumerate(colour, 1)
    ]


def _outputs(colour: tuple[float, ...]) -> list[str]:
    return [f"  $ANOUT[{i}]={value:.5f}" for i, value in enumerate(colour, 1)]


def frame(pose: Floats) -> str:
    """A pose (8,) as KRL writes it: X Y Z [mm], A B C [deg] about z, y' and x''."""
    R = dq.matrix_from_quaternion(dq.rotation(pose))
    flat = np.hypot(R[0, 0], R[1, 0])
    if flat > 1e-9:
        angles = (
            np.arctan2(R[1, 0], R[0, 0]), np.arctan2(-R[2, 0], flat), np.arctan2(R[2, 1], R[2, 2])
        )  # fmt: skip
    else:  # B is a right angle: A and C turn about one axis, and C is given to A
        angles = (np.arctan2(-R[0, 1], R[1, 1]), np.arctan2(-R[2, 0], flat), np.float64(0.0))
    turns = ", ".join(
        f"{axis} {np.degrees(angle) + 0.0:.6f}" for axis, angle in zip("ABC", angles, strict=True)
    )
    return f"{{{_point(dq.translation(pose))}, {turns}}}"


def _point(place: Floats) -> str:
    values = zip("XYZ", (place * 1e3).tolist(), strict=True)
    return ", ".join(f"{axis} {value + 0.0:.5f}" for axis, value in values)

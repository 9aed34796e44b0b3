"""Moves -> a program in RAPID for ABB's controllers: TriggL and TriggC, light by TriggIO.

mm, and quaternions with the scalar first.
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

LONGEST_NAME = 32
OUTPUTS = ("aoRed", "aoGreen", "aoBlue")
TRIGGERS = ("tRed", "tGreen", "tBlue")
NONE = "[0,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]"  # configuration, unchecked; no other axes


@for_arm("rapid", ".mod", *GEOMETRIC, made_of=moves_of)
def rapid(program: Moves) -> str:
    """A program for ABB's controllers: lines and arcs, light along the path."""
    name = program_name(program.trajectory.name, LONGEST_NAME)
    notes = (
        f"RAPID: the light is on the analog outputs {', '.join(OUTPUTS)}, 0 to 1; they must exist.",
        f"lamp is the light on the link {program.link}; its flange may be turned on your arm, and "
        "its mass is a guess.",
    )
    lines = [
        f"MODULE {name}",
        f"  PERS tooldata lamp:=[TRUE,{_frame(program.tool)},[0.5,[0,0,50],[1,0,0,0],0,0,0]];",
        "  CONST zonedata near:=[FALSE,0.1,0.1,0.1,0.1,0.1,0.1];",
        *(f"  VAR triggdata {one};" for one in TRIGGERS),
        "  PROC main()",
        "    ConfL\\Off;",
        *_outputs((0.0, 0.0, 0.0)),
        f"    MoveL [{_frame(program.start)[1:-1]},{NONE}],v50,fine,lamp\\WObj:=wobj0;",
    ]
    colour: tuple[float, ...] = (0.0, 0.0, 0.0)
    for move in program.moves:
        changed = move.colour != colour
        colour = move.colour
        if move.wait:
            lines += [*(_outputs(colour) if changed else []), f"    WaitTime {move.wait:.6f};"]
            continue
        if changed:
            lines += [
                f"    TriggIO {trigger},0\\Start\\AOp:={output},{value:.5f};"
                for trigger, output, value in zip(TRIGGERS, OUTPUTS, colour, strict=True)
            ]
        lines.append(_instruction(move, changed))
    return comment_lines((*program.about, *notes), "!") + "\n".join(
        [*lines, *_outputs((0.0, 0.0, 0.0)), "  ENDPROC", "ENDMODULE", ""]
    )


def _instruction(move: Move, triggered: bool) -> str:
    kind = "L" if move.via is None else "C"
    via = "" if move.via is None else f"[{_frame_at(move.via, move.end)[1:-1]},{NONE}],"
    turn = max(float(np.degrees(move.turn)), 1.0)
    pace = f"[{max(move.speed * 1e3, 1.0):.4f},{turn:.4f},1000,1000]"
    light = f"{TRIGGERS[0]}\\T2:={TRIGGERS[1]}\\T3:={TRIGGERS[2]}," if triggered else ""
    word = ("Trigg" if triggered else "Move") + kind
    zone = "near" if move.passing else "fine"
    end = f"[{_frame(move.end)[1:-1]},{NONE}]"
    return f"    {word} {via}{end},{pace},{light}{zone},lamp\\WObj:=wobj0;"


def _outputs(colour: tuple[float, ...]) -> list[str]:
    return [f"    SetAO {name},{value:.5f};" for name, value in zip(OUTPUTS, colour, strict=True)]


def _frame(pose: Floats) -> str:
    """A pose (8,): the point [mm] and the quaternion."""
    return _frame_at(dq.translation(pose), pose)


def _frame_at(place: Floats, pose: Floats) -> str:
    numbers = [f"{value + 0.0:.5f}" for value in (place * 1e3).tolist()]
    turn = [f"{value + 0.0:.9f}" for value in dq.rotation(pose).tolist()]
    return f"[[{','.join(numbers)}],[{','.join(turn)}]]"

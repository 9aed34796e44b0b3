"""Programs of KUKA's and ABB's controllers -> what an arm does of them, by their manuals.

Written apart from the writers: every line must be one that is known here, turns are scipy's.
"""

import re
from dataclasses import dataclass

import numpy as np
from scipy.spatial.transform import Rotation

NUMBER = r"-?\d+\.?\d*(?:[eE][-+]?\d+)?"


@dataclass
class Step:
    """A line, an arc or a wait: its end [m], its turn, and the light from its beginning on."""

    end: np.ndarray
    turn: Rotation
    via: np.ndarray | None
    speed: float
    passing: bool
    light: tuple[float, ...]
    wait: float = 0.0


@dataclass
class Program:
    tool: tuple[np.ndarray, Rotation]
    start: Step
    steps: list[Step]
    light: tuple[float, ...]  # when it has ended


def _krl_frame(text):
    names, values = zip(*re.findall(rf"([XYZABC]) ({NUMBER})", text), strict=True)
    assert "".join(names) in ("XYZ", "XYZABC"), text
    values = [float(value) for value in values]
    turn = Rotation.from_euler("ZYX", values[3:], degrees=True) if len(values) > 3 else None
    return np.array(values[:3]) / 1e3, turn


def read_krl(text):
    lines = [line.strip() for line in text.splitlines() if not line.startswith(";")]
    name = re.fullmatch(r"DEF ([A-Za-z]\w{0,23})\(\)", lines[0])[1]
    assert name
    assert lines[-1] == "END"
    state = {"light": [None] * 3, "speed": None, "pending": None}
    tool, start, steps, begun = None, None, [], False
    for line in lines[1:-1]:
        output = re.fullmatch(rf"\$ANOUT\[([123])\]=({NUMBER})", line)
        trigger = re.fullmatch(
            rf"TRIGGER WHEN DISTANCE=0 DELAY=0 DO \$ANOUT\[([123])\]=({NUMBER})", line
        )
        if output or trigger:
            index, value = (output or trigger).groups()
            assert 0 <= float(value) <= 1
            assert not (output and steps and steps[-1].passing), "it would stop the advance run"
            state["light"][int(index) - 1] = float(value)
        elif found := re.fullmatch(rf"\$VEL\.CP = ({NUMBER})", line):
            state["speed"] = float(found[1])
            assert 0 < state["speed"] <= 2
        elif found := re.fullmatch(r"\$TOOL = (\{.*\})", line):
            tool = _krl_frame(found[1])
        elif found := re.fullmatch(rf"WAIT SEC ({NUMBER})", line):
            last = steps[-1] if steps else start
            steps.append(Step(last.end, last.turn, None, 0, False, tuple(state["light"]),
                              float(found[1])))  # fmt: skip
        elif found := re.fullmatch(r"(LIN|CIRC) (?:(\{[^}]*\}), )?(\{[^}]*\})( C_DIS)?", line):
            assert begun, "the first motion must be a PTP"
            assert (found[1] == "CIRC") == (found[2] is not None)
            end, turn = _krl_frame(found[3])
            via = _krl_frame(found[2])[0] if found[2] else None
            step = Step(end, turn, via, state["speed"], bool(found[4]), tuple(state["light"]))
            if start is None:
                start = step
            else:
                steps.append(step)
        elif line == "PTP $AXIS_ACT":
            begun = True
        else:
            assert re.fullmatch(
                rf"BAS\(#INITMOV, 0\)|\$BASE = \$NULLFRAME|\$ORI_TYPE = #VAR|\$CIRC_TYPE = #BASE|"
                rf"\$APO\.CDIS = {NUMBER}|\$VEL\.ORI[12] = {NUMBER}", line
            ), line  # fmt: skip
    return Program(tool, start, steps, tuple(state["light"]))


def _rapid_target(text):
    numbers = [float(value) for value in re.findall(NUMBER, text)]
    q = numbers[3:7]
    assert abs(np.linalg.norm(q) - 1) < 1e-6
    return np.array(numbers[:3]) / 1e3, Rotation.from_quat([*q[1:], q[0]])


def read_rapid(text):
    lines = [line.strip() for line in text.splitlines() if not line.startswith("!")]
    assert re.fullmatch(r"MODULE [A-Za-z]\w{0,31}", lines[0])
    assert lines[-2:] == ["ENDPROC", "ENDMODULE"]
    outputs = {"aoRed": 0, "aoGreen": 1, "aoBlue": 2}
    light, pending, tool, start, steps = [None] * 3, {}, None, None, []
    target = r"\[\[[^\]]*\],\[[^\]]*\],\[0,0,0,0\],\[9E9,9E9,9E9,9E9,9E9,9E9\]\]"
    for line in lines[1:-2]:
        if found := re.fullmatch(rf"SetAO (\w+),({NUMBER});", line):
            assert not (steps and steps[-1].passing)
            light[outputs[found[1]]] = float(found[2])
        elif found := re.fullmatch(rf"TriggIO (t\w+),0\\Start\\AOp:=(\w+),({NUMBER});", line):
            pending[found[1]] = (outputs[found[2]], float(found[3]))
        elif found := re.fullmatch(rf"WaitTime ({NUMBER});", line):
            last = steps[-1] if steps else start
            steps.append(Step(last.end, last.turn, None, 0, False, tuple(light), float(found[1])))
        elif found := re.fullmatch(
            rf"(Trigg|Move)([LC]) (?:({target}),)?({target}),(v\d+|\[[^\]]*\]),"
            rf"(?:(tRed)\\T2:=(tGreen)\\T3:=(tBlue),)?(near|fine),lamp\\WObj:=wobj0;", line
        ):  # fmt: skip
            assert (found[2] == "C") == (found[3] is not None)
            assert (found[1] == "Trigg") == (found[6] is not None) == bool(pending)
            for name in found.groups()[5:8] if pending else ():
                index, value = pending.pop(name)
                light[index] = value
            end, turn = _rapid_target(found[4])
            via = _rapid_target(found[3])[0] if found[3] else None
            pace = re.match(rf"\[({NUMBER}),", found[5])
            speed = float(pace[1]) / 1e3 if pace else float(found[5][1:]) / 1e3
            step = Step(end, turn, via, speed, found[9] == "near", tuple(light))
            if start is None:
                start = step
            else:
                steps.append(step)
        elif found := re.match(r"PERS tooldata lamp:=\[TRUE,(\[\[.*?\]\]),", line):
            tool = _rapid_target(found[1])
        else:
            assert re.fullmatch(
                r"CONST zonedata near:=.*;|VAR triggdata t\w+;|PROC main\(\)|ConfL\\Off;", line
            ), line
    return Program(tool, start, steps, tuple(light))


def walk(program, each=40):
    """Points (M, 3), turns and light (M, 3) along a program's geometry."""
    points, turns, light = [program.start.end], [program.start.turn], [program.steps[0].light]
    at = program.start
    for step in program.steps:
        share = np.linspace(0, 1, each + 1)[1:]
        if step.via is None:
            way = at.end + np.outer(share, step.end - at.end)
        else:
            way = _arc(at.end, step.via, step.end, share)
        between = (step.turn * at.turn.inv()).as_rotvec()
        points += list(way)
        turns += [Rotation.from_rotvec(s * between) * at.turn for s in share]
        light += [step.light] * each
        at = step
    return np.array(points), turns, np.array(light)


def _arc(a, via, b, share):
    """The circle through three points, by its perpendicular bisectors."""
    u, v = via - a, b - a
    n = np.cross(u, v)
    centre = a + (np.cross(n, u) * (v @ v) + np.cross(v, n) * (u @ u)) / (2 * n @ n)
    axis = n / np.linalg.norm(n)
    arm = a - centre
    ends = [np.arctan2(np.cross(arm, p - centre) @ axis, arm @ (p - centre)) for p in (via, b)]
    half, full = (end % (2 * np.pi) for end in ends)
    assert 0 < half < full
    return centre + Rotation.from_rotvec(np.outer(share * full, axis)).apply(arm)

"""Names, logos and the repository's drawings on several arms: `python -m tests.tools.exports`.

Each is run on each arm and checked as `dqpaint export` checks it. What is printed: whether a limit
was met, the time beside that of `corner jump`, how even the light is along strokes, and how far the
reference is from the sharp corners. `--part I/N` runs every Nth; the arms are named after that.
"""

import re
import sys
import tempfile
from dataclasses import replace
from pathlib import Path

import numpy as np
from scipy.spatial import cKDTree

from dqpaint import dq
from dqpaint.errors import DqpaintError
from dqpaint.language import ScriptError, parse
from dqpaint.language.imports.lettering import font_names
from dqpaint.motion import plan
from dqpaint.outputs.robot.limit_check import check_limits
from dqpaint.painting import paint
from dqpaint.settings import make_settings

FOLDER = Path(__file__).parents[2] / "trajectories"
ARMS = ("iiwa", "panda", "ur10", "xarm7")
FINE = 1e-3  # [s] a period at which the path is looked at
WINDOW = 1e-3  # [m] over which the light is averaged
LOGOS = {
    "bolt": "M40 0 L10 55 H35 L25 100 L70 38 H44 L60 0 Z",
    "heart": "M50 90 C10 60 0 30 25 12 C40 4 50 20 50 26 C50 20 60 4 75 12 C100 30 90 60 50 90 Z",
    "gear": "M45 5 H55 L58 18 L68 22 L79 15 L86 22 L78 33 L82 42 H95 V52 H82 L78 62 L86 73 L79 80 "
    "L68 73 L58 77 L55 90 H45 L42 77 L32 73 L21 80 L14 73 L22 62 L18 52 H5 V42 H18 L22 33 L14 22 "
    "L21 15 L32 22 L42 18 Z M50 35 A12 12 0 1 0 50.01 35 Z",
    "house": "M10 50 L50 10 L90 50 M20 42 V90 H80 V42 M42 90 V62 H58 V90",
    "leaf": "M15 85 Q10 20 85 15 Q90 80 25 75 M15 85 L70 30",
    "wave": "M0 50 C15 10 30 10 40 50 S70 90 80 50 S100 30 110 45",
    "cup": "M15 25 H75 V60 A20 20 0 0 1 55 80 H35 A20 20 0 0 1 15 60 Z "
    "M75 32 H85 A12 12 0 0 1 85 58 H75",
    "key": "M30 50 A18 18 0 1 0 30 51 Z M30 50 H90 V62 M78 50 V60 M66 50 V57",
    "spark": "M50 0 L58 42 L100 50 L58 58 L50 100 L42 58 L0 50 L42 42 Z",
    "cusp": "M10 90 C10 10 10 10 90 10 C20 20 80 80 90 90 Z",
}


def drawings():
    """Name and text of each; a text that names files is read in their folder."""
    for path in sorted(FOLDER.glob("*.traj")):
        text = path.read_text("utf-8")
        if not re.search(r"^step|profile constant", text, re.MULTILINE):
            yield path.stem, text
    yield "name", 'text "Marie" "Curie" font "scripts" height 25 mm at (-60, 0) mm'
    for font in font_names():
        letters = "ΑΩ" if font == "greeks" else "Ag"
        yield font, f'text "{letters}" font "{font}" height 30 mm at (-30, 0) mm'
    yield from ((name, f'svg "{name}.svg" height 80 mm') for name in LOGOS)


def program_of(name, text, folder):
    for logo, shape in LOGOS.items():
        (folder / f"{logo}.svg").write_text(
            f'<svg xmlns="http://www.w3.org/2000/svg"><path d="{shape}" stroke="orange"/></svg>'
        )
    return parse(text, name, (folder if name in LOGOS else FOLDER) / "a.traj")


def unevenness(motion, points):
    """Differences of the light of each millimetre from that of its stroke, for points (N, 3)."""
    way, found = np.linalg.norm(np.diff(points, axis=0), axis=1), [np.zeros(1)]
    for number in np.unique(motion.stroke[:-1][motion.lit[:-1]]):
        light = motion.program.segments[number].light
        if light.first != light.last or not light.even:
            continue
        rows = motion.stroke[:-1] == number
        far = np.concatenate([[0.0], np.cumsum(way[rows])])
        shone = np.concatenate([[0.0], np.cumsum(motion.light[:-1][rows].max(axis=1))])
        edges = np.linspace(0.0, far[-1], max(2, int(far[-1] / WINDOW) + 1))
        share = np.diff(np.interp(edges, far, shone)) / np.diff(edges)
        found.append(np.abs(share / np.median(share) - 1))
    return np.concatenate(found)


def deviation(name, text, folder, motion):
    """The largest distance of the sharp drawing from the reference [m], and its time [s]."""
    jump = re.sub(r"^(svg|text|path|stroke)\b(.*)$", r"\1\2 corner jump", text, flags=re.MULTILINE)
    sharp = replace(program_of(name, jump, folder), placement=motion.program.placement)
    here, there = (
        plan(replace(one, period=FINE), motion.canvas) for one in (motion.program, sharp)
    )
    near = cKDTree(here.points[here.lit]).query(there.points[there.lit])[0].max()
    return float(near), there.seconds


def painted(program, arm):
    """The run on an arm, placed by it where its canvas is too small."""
    settings = make_settings(robot=arm, size="160x90")
    try:
        return paint.paint(program, settings)
    except ScriptError:
        return paint.paint(program, settings.model_copy(update={"place": "auto"}))


def main(arguments):
    """Runs a share of them."""
    share = "1/1"
    if arguments[:1] == ["--part"]:
        share, arguments = arguments[1], arguments[2:]
    arms = tuple(arguments) or ARMS
    first, every = map(int, share.split("/"))
    with tempfile.TemporaryDirectory() as made:
        folder, refused = Path(made), 0
        for name, text in list(drawings())[first - 1 :: every]:
            for arm in arms:
                try:
                    painting = painted(program_of(name, text, folder), arm)
                    check_limits(painting)
                except DqpaintError as fault:
                    refused += 1
                    print(f"{name:14} {arm:6} REFUSED {' '.join(str(fault).split())[:160]}")
                    continue
                motion = painting.motion
                far, before = deviation(name, text, folder, motion)
                least = f"{painting.corners.least:.2g}" if painting.corners else "2"
                asked = unevenness(motion, motion.points).max()
                run = unevenness(motion, dq.translation(painting.track.pose))
                print(
                    f"{name:14} {arm:6} within limits {motion.seconds:6.2f} s (jumps {before:6.2f})"
                    f" {least:>4} m/s2, light: reference within {100 * asked:4.1f} %, run: 95 % of "
                    f"it within {100 * np.quantile(run, 0.95):4.1f} %, all {100 * run.max():4.1f} %"
                    f", corners within {1e3 * far:.3f} mm", flush=True,
                )  # fmt: skip
        print(f"{refused} refused")


if __name__ == "__main__":
    main(sys.argv[1:])

"""How like their photographs paintings are: `python -m tests.tools.photographs [ROWS] [NAME...]`.

For each photograph that scikit-image installs, in grey and in colour: the likeness of the light
that was solved for, of "power proportional to the grey value" along the same path at the exposure
that suits it best, and of lamps of few powers. It needs minutes.
"""

import sys
import tempfile
from pathlib import Path
from time import process_time

import numpy as np
from PIL import Image

from dqpaint.brushes import read_lamp
from dqpaint.language import parse
from dqpaint.light.film import point_spread
from dqpaint.motion import plan
from dqpaint.painting.photos import photo_light
from dqpaint.robots.loading import card_for
from dqpaint.settings import make_settings

NAMES = ("astronaut", "coffee", "rocket", "hubble_deep_field", "text", "logo")
LAMPS = ("dimmed", "dimmed:gamma=1", "dimmed:bits=5", "switched")
STOPS = 2.0 ** np.arange(-4.0, 3.01, 0.25)


def row(name: str, mode: str, rows: int) -> list[str]:
    """The figures of one photograph."""
    from skimage import data

    picture = getattr(data, name)()
    picture = picture[..., :3] if picture.ndim == 3 else picture
    high, wide = picture.shape[:2]
    longest = max(high, wide)
    size = tuple(round(rows * (0.28 + 0.72 * side / longest)) for side in (wide, high))
    detail = 200.0 * 2.0 * point_spread(size[1]).widths[0] / (0.72 * rows)
    with tempfile.TemporaryDirectory() as folder:
        Image.fromarray(picture).save(Path(folder) / "p.png")
        side = "height" if high >= wide else "width"
        text = f'photo "p.png" {side} 200 mm as hatch detail {detail} mm colours {mode}'
        program = parse(text, "photograph.traj", Path(folder) / "photograph.traj")
    settings = make_settings(size=size)
    motion = plan(program, card_for(program, None).canvas.pose)
    begun = process_time()
    lit, (told,) = photo_light.solve_photos(motion, settings)
    took = process_time() - begun
    (task,), gain = photo_light._tasks(lit, settings, None)
    middle = 0.5 * (task.exposing.start + task.exposing.end) - (task.box.left, task.box.top)
    x, y = np.rint(middle).astype(int).T
    values = task.picture[np.clip(y, 0, task.box.height - 1), np.clip(x, 0, task.box.width - 1)]
    plain = np.zeros_like(lit.light)
    plain[task.rows] = values * task.share[:, None]
    tried = [task.likeness_of(plain, gain * lit.exposure * stop) for stop in STOPS]
    best = max(tried, key=lambda one: one.ssim)
    powers, joined = lit.light[task.rows], np.diff(task.rows, prepend=-2) == 1
    lamps = []
    for lamp in LAMPS:
        made = np.zeros_like(lit.light)
        made[task.rows] = read_lamp(lamp).rounded(powers, np.ones(len(powers)), joined)
        lamps.append(task.likeness_of(made, gain * lit.exposure).ssim)
    ratio = (1.0 - told.likeness.ssim) / (1.0 - best.ssim)
    return [
        name, "grey" if mode == "1" else "colour", f"{best.ssim:.3f}", f"{best.rms:.3f}",
        f"{told.likeness.ssim:.3f}", f"{told.likeness.rms:.3f}", f"{ratio:.2f}",
        *(f"{ssim:.3f}" for ssim in lamps), f"{told.length:.0f} m", f"{took:.0f} s",
    ]  # fmt: skip


if __name__ == "__main__":
    asked = sys.argv[1:]
    rows = int(asked.pop(0)) if asked and asked[0].isdigit() else 1080
    heads = ["photograph", "", "plain SSIM", "rms", "solved SSIM", "rms", "ratio of 1 - SSIM",
             "8 bits", "8 bits, gamma 1", "5 bits", "on/off", "path", "CPU"]  # fmt: skip
    print("| " + " | ".join(heads) + " |\n|" + "---|" * len(heads), flush=True)
    for name in asked or NAMES:
        for mode in ("1", "full"):
            print("| " + " | ".join(row(name, mode, rows)) + " |", flush=True)

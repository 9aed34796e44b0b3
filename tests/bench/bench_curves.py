"""Large drawings: python -m tests.bench.bench_curves. Read the ratios.

`check` of many curves and points with speeds at their corners, against the same without
(`profile constant`), each a process of its own: CPU seconds and peak memory.
"""

from __future__ import annotations

import os
import subprocess
import sys
import tempfile
from pathlib import Path

from tests.support.svg import curves, dots, drawing_of

POINTS = "".join(f"{(i % 97) / 97:.2f},{i % 89 / 890:.2f}\n" for i in range(499_000))
DRAWINGS = {
    "2,000 curves": (drawing_of(curves(2_000)), "svg", "height 200 mm speed 4 m/s"),
    "60,000 curves": (drawing_of(curves(60_000)), "svg", "height 200 mm speed 4 m/s"),
    "20,000 dots": (drawing_of(dots(20_000)), "svg", "height 200 mm"),
    "499,000 points": (POINTS, "path", "unit mm in 100 s"),
    "499,000 smoothly": (POINTS, "path", "unit mm smooth in 100 s"),
}


def cost(path: Path) -> tuple[float, int]:
    """CPU seconds and peak memory [MB] of one process."""
    command = [sys.executable, "-m", "dqpaint", "check", str(path)]
    process = subprocess.Popen(command, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
    _, _, used = os.wait4(process.pid, 0)
    return used.ru_utime + used.ru_stime, used.ru_maxrss // 1024


def main() -> None:
    print(f"{'':18} {'CPU s':>6} {'MB':>5} {'without':>8} {'ratio':>6}")
    with tempfile.TemporaryDirectory() as folder:
        for name, (content, kind, clause) in DRAWINGS.items():
            source = Path(folder, f"a.{'svg' if kind == 'svg' else 'csv'}")
            source.write_text(content)
            found = []
            for more in ("", " profile constant"):
                drawing = Path(folder, "a.traj")
                drawing.write_text(f'{kind} "{source.name}" {clause}{more}\n')
                found.append(cost(drawing))
            (seconds, size), (without, _) = found
            print(f"{name:18} {seconds:6.2f} {size:5} {without:8.2f} {seconds / without:6.2f}")


if __name__ == "__main__":
    main()

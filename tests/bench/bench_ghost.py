"""The arm in the picture at 1920x1080: `python tests/bench/bench_ghost.py [ROUNDS]`.

The target is 2.5 s on two cores, loading the shapes included.
"""

import statistics
import sys
import time

import numpy as np

import dqpaint
from dqpaint.robots.card import read_card
from dqpaint.stage.staging import Staging

SIZE = (1920, 1080)


def main():
    rounds = int(sys.argv[1]) if len(sys.argv) > 1 else 5
    for example, view in (("star", "front"), ("star", "-30,12"), ("spiral", "iso")):
        painting = dqpaint.draw(example, view=view, size=SIZE, ghost=False)
        picture, track = painting.picture, painting.track
        period, points = painting.motion.period, track.points
        energy = painting.motion.light[:-1] * period
        time_of, lit = (0.5 + np.arange(len(energy))) * period, energy.any(axis=1)
        places = 0.5 * (points[1:] + points[:-1])[:, None]
        urdf = read_card(painting.robot).urdf_path
        times = {"ghost": [], "occlusion": []}
        for _ in range(rounds):
            begin = time.perf_counter()
            with Staging(urdf, track.posture, period) as staging:
                staging.photograph(picture.camera, [(points, energy)], picture.exposure)
            middle = time.perf_counter()
            with Staging(urdf, track.posture, period) as staging:
                staging.visible(time_of, places, lit, picture.camera.position)
            times["ghost"].append(middle - begin)
            times["occlusion"].append(time.perf_counter() - middle)
        for name, values in times.items():
            print(f"{example:8} {view:8} {name:10} {statistics.median(values):.3f} s")


if __name__ == "__main__":
    main()

"""The arm in the picture at 1920x1080: `python tests/bench/bench_ghost.py [ROUNDS]`.

The target of the flashed arm is 2.5 s on two cores, loading the shapes included.
"""

import statistics
import sys
import time
from functools import partial

import dqpaint
from dqpaint.painting.picture import lamp_paths
from dqpaint.render.scene_arm import scene_arm_of_run
from dqpaint.robots.model.card import read_card

SIZE = (1920, 1080)


def main():
    rounds = int(sys.argv[1]) if len(sys.argv) > 1 else 5
    for example, view in (("star", "front"), ("star", "-30,12"), ("spiral", "iso")):
        painting = dqpaint.draw(example, view=view, size=SIZE, ghost=True, occlusion=False)
        camera, exposure, scene = painting.picture.camera, painting.picture.exposure, painting.scene
        card = read_card(painting.robot)
        times = {"ghost": [], "motion": [], "occlusion": []}
        shine = partial(lamp_paths, scene)
        for _ in range(rounds):
            begin = time.perf_counter()
            with scene_arm_of_run(painting.settings, card, painting.arm_motion) as staging:
                staging.render_still(camera, shine, exposure)
            flashed = time.perf_counter()
            with scene_arm_of_run(painting.settings, card, painting.arm_motion) as staging:
                staging.render_blurred(camera, shine, exposure)
            middle = time.perf_counter()
            with scene_arm_of_run(painting.settings, card, painting.arm_motion) as staging:
                for sweep in scene.light:
                    sweep.occluded_by(staging, camera.position)
            times["ghost"].append(flashed - begin)
            times["motion"].append(middle - flashed)
            times["occlusion"].append(time.perf_counter() - middle)
        for name, values in times.items():
            print(f"{example:8} {view:8} {name:10} {statistics.median(values):.3f} s")


if __name__ == "__main__":
    main()

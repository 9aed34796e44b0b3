"""Tool poses, colours and brushes -> long-exposure pictures, (H, W, 3) of 8-bit sRGB.

Each step has one noun, and is linear in the light until the last:

    poses, colours, Emitters -> Sweep -emission_to-> Light, Sheet -expose-> Film -spread-> image
           points -frame_points-> Camera ~^                ~^               ^~ automatic_exposure
                                                                    image -LOOKS-> picture

A `Sweep` cuts time where a lamp switches and where a chord would show; `Steps.time` says when each
part was emitted. `Sweep._sent` alone computes which share of it goes to the camera.

Nothing here knows of robots: the light may come from the reference or from an arm's motion.
"""

from dqpaint.light.arrays import Image, Picture

__all__ = ["Image", "Picture"]

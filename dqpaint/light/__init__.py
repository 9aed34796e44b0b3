"""The light at the tool becomes a long-exposure picture.

In comes where the tool was at N instants, what it carried and in which colours it shone; out goes
an (H, W, 3) array of 8-bit sRGB. Between the two there is one noun a step, each linear in the light
until the last:

    poses, colours, Emitters -> Sweep -emission_to-> Light, Sheet -expose-> Film -spread-> image
                  points -frame-> Camera ~^                ~^               ^~ automatic_exposure
                                                                    image -LOOKS-> picture

`brushes` name what a tool carries. A `Sweep` cuts time where a lamp switches and where a chord
would show, and knows by `Steps.time` when each bit was emitted; `Sweep._sent` is the one place that
says which share of it goes to the camera.

Nothing here knows of robots: the light may come from what was asked or from what an arm achieved.
"""

from dqpaint.light.arrays import Image, Picture

__all__ = ["Image", "Picture"]

"""The picture of a motion, without the settings of a whole run."""

from dqpaint.painting.picture import photograph
from dqpaint.painting.scene import make_scene


def take(motion, pose, settings):
    """The first picture of a motion's light carried through poses (N, 8)."""
    return next(photograph(make_scene(motion, pose, settings), settings))

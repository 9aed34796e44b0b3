"""Settings -> the first slip among them, before anything is simulated."""

from dqpaint.controllers import find_controller
from dqpaint.disturbances import make_disturbances
from dqpaint.painting.scene import check_choices
from dqpaint.plants import find_plant
from dqpaint.robots.kinematics import read_null
from dqpaint.robots.loading import find_card
from dqpaint.robots.model import parse_tool
from dqpaint.settings import Settings


def check_each(settings: Settings) -> None:
    """Check every choice as far as it can be understood by itself, whatever the drawing is.

    Raises:
        DqpaintError: an unknown name, or a value outside its range.
    """
    check_choices(settings)
    find_controller(settings.controller).read_gains(settings.gains)
    if settings.robot is not None and "." not in settings.robot:  # files are read in their turn
        find_card(settings.robot)
    if settings.tool is not None:
        parse_tool(settings.tool)
    if settings.plant is not None:
        find_plant(settings.plant)
    read_null(settings.null)
    make_disturbances(settings.disturb)

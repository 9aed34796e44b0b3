"""Settings -> the first slip among them, before anything is simulated."""

from collections.abc import Mapping
from os import PathLike
from typing import Any

from dqpaint.controllers import find_controller
from dqpaint.disturbances import make_disturbances
from dqpaint.painting.scene import check_choices
from dqpaint.plants import find_plant
from dqpaint.robots.kinematics import read_null
from dqpaint.robots.loading import find_card
from dqpaint.robots.model import parse_tool
from dqpaint.settings import Settings, SettingsFile, make_settings, read_choices, read_given


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


def settings_file(given: str | PathLike[str] | SettingsFile | None) -> SettingsFile:
    """A file of settings, read and checked; without one there is nothing in it.

    Raises:
        DqpaintError: it cannot be read, or a key or value is at fault.
    """
    if given is None:
        return SettingsFile()
    return given if isinstance(given, SettingsFile) else read_given(str(given), check_each)


def chosen(choices: Mapping[str, Any], **usual: Any) -> Settings:
    """The settings of choices: what is said wins over the file `settings` names among them.

    Args:
        choices: by the names in Python.
        usual: likewise; what holds where neither says anything.

    Raises:
        DqpaintError: the file cannot be read, or a choice is at fault.
    """
    said = {name: value for name, value in choices.items() if name != "settings"}
    given = settings_file(choices.get("settings")).under(said)
    return make_settings(**{**read_choices(usual), **given})

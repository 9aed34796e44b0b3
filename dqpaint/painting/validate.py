"""Settings -> the first slip among them, before anything is simulated."""

from collections.abc import Mapping
from dataclasses import dataclass
from os import PathLike
from typing import Any

from dqpaint.controllers import Controller, Schedule, find_controller
from dqpaint.disturbances import Disturbance, make_disturbances
from dqpaint.painting.scene import check_light_settings
from dqpaint.plants import ConfiguredPlant, choose_plant, find_plant
from dqpaint.robots.kinematics import read_null
from dqpaint.robots.loading import find_card
from dqpaint.robots.model import parse_tool
from dqpaint.settings import (
    Settings,
    SettingsFile,
    check_recorded,
    make_settings,
    read_choices,
    read_given,
)
from dqpaint.simulation import RECORDED


@dataclass(frozen=True)
class RunChoices:
    """What the settings of a run name, read.

    Attributes:
        controller: the law; that of a recording, where one is painted.
        gains: of the law, over the drawing.
        plant: with its values.
        disturbances: by their names.
    """

    controller: Controller[Any]
    gains: Schedule[Any]
    plant: ConfiguredPlant
    disturbances: dict[str, Disturbance]


def check_run(settings: Settings, controller: Controller[Any] | None = None) -> RunChoices:
    """Check all that can be known of a run's settings, whatever the drawing is.

    Args:
        settings: of the run.
        controller: a law of one's own, instead of the one the settings name.

    Raises:
        DqpaintError: an unknown name, a value outside its range, or choices that exclude one
            another.
    """
    _check_independent(settings)
    check_recorded(settings)
    law = RECORDED if settings.recorded else controller or find_controller(settings.controller)
    gains = law.read_gains(settings.gains)
    plant = choose_plant(settings.plant, "torque" if law.drives_torque else "rates")
    disturbances = make_disturbances(settings.disturb)
    for name, one in disturbances.items():
        plant.require_trait(one.needs, name)
    return RunChoices(law, gains, plant, disturbances)


def check_settings(settings: Settings) -> None:
    """Check every choice as far as it can be understood by itself: others may still follow.

    Raises:
        DqpaintError: an unknown name, or a value outside its range.
    """
    _check_independent(settings)
    find_controller(settings.controller).read_gains(settings.gains)
    if settings.plant is not None:
        find_plant(settings.plant)
    make_disturbances(settings.disturb)


def _check_independent(settings: Settings) -> None:
    """What no other choice matters for."""
    check_light_settings(settings)
    if settings.robot is not None and "." not in settings.robot:  # files are read in their turn
        find_card(settings.robot)
    if settings.tool is not None:
        parse_tool(settings.tool)
    read_null(settings.null)


def settings_file(given: str | PathLike[str] | SettingsFile | None) -> SettingsFile:
    """A file of settings, read and checked; without one there is nothing in it.

    Raises:
        DqpaintError: it cannot be read, or a key or value is at fault.
    """
    if given is None:
        return SettingsFile()
    return given if isinstance(given, SettingsFile) else read_given(str(given), check_settings)


def settings_of_choices(choices: Mapping[str, Any], **usual: Any) -> Settings:
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

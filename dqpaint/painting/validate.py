"""Settings -> the law, plant and disturbances they name, or the first error among them."""

from collections.abc import Mapping
from dataclasses import dataclass, replace
from os import PathLike
from pathlib import Path
from typing import Any

from dqpaint.controllers import Controller, Schedule, find_controller, read_sign
from dqpaint.disturbances import Disturbance, find_files, make_disturbances
from dqpaint.errors import UsageError
from dqpaint.painting.scene import check_light_settings
from dqpaint.plants import ConfiguredPlant, Takes, choose_plant, find_plant
from dqpaint.robots.kinematics import read_null
from dqpaint.robots.loading import find_card
from dqpaint.robots.model import parse_tool
from dqpaint.robots.resolvers import read_resolver
from dqpaint.settings import (
    Code,
    Settings,
    SettingsFile,
    Trusted,
    check_recorded,
    make_settings,
    read_choices,
    read_given,
)
from dqpaint.simulation import RECORDED


@dataclass(frozen=True)
class RunChoices:
    """The law, plant and disturbances that settings name.

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


def check_run(
    settings: Settings, controller: Controller[Any] | None = None, folder: Path | None = None
) -> RunChoices:
    """Check a run's settings as far as they do not depend on the drawing's text.

    Args:
        settings: of the run.
        controller: a law in place of the one that the settings name.
        folder: of the drawing, where files of disturbances may lie; None finds them here alone.

    Raises:
        DqpaintError: an unknown name, a value outside its range, or choices that exclude one
            another.
    """
    _check_independent(settings)
    check_recorded(settings)
    law = RECORDED if settings.recorded else controller or find_controller(settings.controller)
    _check_resolved(settings, law)
    gains = law.read_gains(settings.gains)
    law = _with_sign_rule(law, settings.sign)
    takes: Takes = "torque" if law.drives_torque else "rates"
    plant = choose_plant(settings.plant, takes, settings.engine)
    if not settings.recorded:
        plant.check_installed()
    disturbances = make_disturbances(find_files(settings.disturb, folder or Path()))
    for name, one in disturbances.items():
        plant.require_trait(one.needs, name)
    return RunChoices(law, gains, plant, disturbances)


def _with_sign_rule(law: Controller[Any], sign: str) -> Controller[Any]:
    """The law, on the side of the double cover that a rule chooses."""
    rule = read_sign(sign)
    if rule is not None and law.heeds_sign is False:
        raise UsageError(
            f"sign '{sign}': law '{law.name}' does not ask which of x_d and -x_d is nearer, or has "
            "a rule of its own; leave out --sign"
        )
    return replace(law, sign=rule)


def _check_resolved(settings: Settings, law: Controller[Any]) -> None:
    """Refuse a resolver or a task that a law has no use for.

    Raises:
        UsageError: it has none.
    """
    if law.drives_torque and settings.resolver and read_resolver(settings.resolver)[0].holds_rates:
        raise UsageError(
            f"resolver '{settings.resolver}' holds joint rates, and controller '{law.name}' "
            "commands torques: take a law of twists or rates, or leave out --resolver"
        )
    if settings.task not in (None, "pose") and not law.is_resolved:
        raise UsageError(
            f"task '{settings.task}' is for laws that command the tool: controller '{law.name}' "
            f"commands {law.commands} by itself"
        )


def check_settings(settings: Settings) -> None:
    """Check each setting by itself: others may still be added.

    Raises:
        DqpaintError: an unknown name, or a value outside its range.
    """
    _check_independent(settings)
    find_controller(settings.controller).read_gains(settings.gains)
    if settings.plant is not None:
        find_plant(settings.plant)
    make_disturbances(settings.disturb)


def _check_independent(settings: Settings) -> None:
    """Check the settings that depend on no other."""
    check_light_settings(settings)
    if settings.robot is not None and "." not in settings.robot:  # files are read in their turn
        find_card(settings.robot)
    if settings.tool is not None:
        parse_tool(settings.tool)
    read_null(settings.null)
    if settings.resolver is not None:
        read_resolver(settings.resolver)
    read_sign(settings.sign)


def settings_file(
    given: str | PathLike[str] | SettingsFile | None, code: Code = "run"
) -> SettingsFile:
    """A file of settings, read and checked; empty if none is given.

    Args:
        given: the file; a path that is `Trusted` may name code anywhere.
        code: what becomes of code that it names, as `read_given` has it.

    Raises:
        DqpaintError: it cannot be read, or a key or value is at fault.
    """
    if given is None:
        return SettingsFile()
    if isinstance(given, SettingsFile):
        return given
    path = given if isinstance(given, Trusted) else str(given)
    return read_given(path, check_settings, code)


def settings_of_choices(choices: Mapping[str, Any], **defaults: Any) -> Settings:
    """The settings of choices, which have precedence over the file that `settings` names.

    Args:
        choices: by the names in Python.
        defaults: likewise, for what neither gives.

    Raises:
        DqpaintError: the file cannot be read, or a choice is at fault.
    """
    direct = {name: value for name, value in choices.items() if name != "settings"}
    given = settings_file(choices.get("settings")).under(direct)
    return make_settings(**{**read_choices(defaults), **given})

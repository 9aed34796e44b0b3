"""Settings and a program -> the other packages that take part, with their versions."""

from typing import Any

from dqpaint.brushes import BRUSHES
from dqpaint.controllers import CONTROLLERS
from dqpaint.core import Registry, choice_name, split_spec
from dqpaint.disturbances import DISTURBANCES, kind_of
from dqpaint.metrics import METRICS
from dqpaint.plants import PLANTS
from dqpaint.program import Program
from dqpaint.robots.loading import plugin_cards
from dqpaint.robots.model import card_names
from dqpaint.settings import Settings


def plugins_of(settings: Settings, program: Program) -> dict[str, str]:
    """The packages behind a run: `controller pi` -> `name version`; empty where all is built in."""
    chosen: list[tuple[Registry[Any], str | None]] = [
        (CONTROLLERS, settings.controller),
        (PLANTS, choice_name(settings.plant or "")),
        *((BRUSHES, name) for name in _brushes(settings, program)),
        *((DISTURBANCES, kind_of(name)) for name in settings.disturb),
    ]
    found = {}
    for registry, name in chosen:
        if name and split_spec(name) is None and (package := registry.origin(name)):
            found[f"{registry.kind} {name}"] = package
    for name in METRICS:
        if package := METRICS.origin(name):
            found[f"metric {name}"] = package
    robot = settings.robot or program.robot
    if robot and robot not in card_names() and robot in (brought := plugin_cards()):
        found[f"robot {robot}"] = brought[robot][1]
    return found


def _brushes(settings: Settings, program: Program) -> list[str]:
    """The brush of the settings, else those of the drawing."""
    if settings.brush:
        return [choice_name(settings.brush)]
    return list(dict.fromkeys(segment.brush.name for segment in program.segments))

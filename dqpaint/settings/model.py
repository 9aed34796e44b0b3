"""Options by name -> checked settings of one painting: the groups as one flat model."""

from collections.abc import Mapping
from typing import Any, TypeVar

from pydantic import BaseModel, ValidationError

from dqpaint.core import pydantic_reason
from dqpaint.errors import UnknownNameError, UsageError
from dqpaint.settings.declaration import Setting, settings_of
from dqpaint.settings.groups import (
    ArmSettings,
    CameraSettings,
    ColourSettings,
    DeviationSettings,
    DisturbanceSettings,
    DrawingSettings,
    FilmSettings,
    GhostSettings,
    Group,
    LawSettings,
    LightSettings,
    MemorySettings,
    MotionSettings,
    OcclusionSettings,
    TimeSettings,
)

M = TypeVar("M", bound=BaseModel)


class Settings(
    OcclusionSettings, GhostSettings, FilmSettings, CameraSettings, DeviationSettings,
    ColourSettings, LightSettings, MemorySettings, DrawingSettings,
    TimeSettings, MotionSettings, ArmSettings, DisturbanceSettings, LawSettings,
):  # fmt: skip
    """The choices of one painting: the groups above, one after the other, as one flat model."""

    @property
    def traced(self) -> bool:
        """Whether what the arm hides is traced."""
        return bool(self.ghost) if self.occlusion is None else self.occlusion

    @property
    def staged(self) -> bool:
        """Whether the arm's shapes are needed at all."""
        return bool(self.ghost) or self.traced


GROUPS: tuple[type[Group], ...] = Settings.__bases__[::-1]
SETTINGS: dict[str, Setting] = {setting.keyword: setting for setting in settings_of(*GROUPS)}
"""All settings by their names in Python."""


def make_settings(**choices: object) -> Settings:
    """Settings with the given choices, by their names in Python; None stands for the default.

    Raises:
        UsageError: an unknown choice or a value outside its range.
    """
    return checked(read_choices(choices))


def read_choices(choices: Mapping[str, object]) -> dict[str, Any]:
    """The fields of `Settings` that choices give, each read; None is no choice.

    Raises:
        UsageError: a value that does not have the form of its setting.
    """
    found: dict[str, Any] = {}
    for keyword, value in choices.items():
        if value is None:
            continue
        option = SETTINGS[keyword].option if keyword in SETTINGS else None
        read: Any = option.read(value) if option and option.read else value
        if option and option.parts:
            found |= dict(zip(option.parts, read, strict=True))
        else:
            found[keyword] = read
    return found


def checked(fields: Mapping[str, object], strict: bool = False) -> Settings:
    """Settings with some fields; arguments and errors as those of `validated`."""
    return validated(Settings, fields, strict)


def validated(model: type[M], fields: Mapping[str, object], strict: bool = False) -> M:
    """A model of what a caller chooses with some fields.

    Args:
        model: such as `Settings`.
        fields: as the model has them.
        strict: whether `true` is no number, and "yes" is not `true`.

    Raises:
        UsageError: an unknown field or a value outside its range.
    """
    try:
        return model.model_validate(fields, strict=strict)
    except ValidationError as problem:
        first = problem.errors()[0]
        name = ".".join(str(part) for part in first["loc"])
        if first["type"] == "extra_forbidden":
            raise UnknownNameError("setting", name, SETTINGS) from None
        raise UsageError(f"{name} {first['input']!r} {pydantic_reason(first)}") from None


SIMULATED = ("controller", "gains", "sign", "learned", "plant", "engine", "disturb", "spread",
             "start", "null", "resolver", "task", "kinematics", "on_limit")  # fmt: skip


def check_recorded(settings: Settings) -> None:
    """Refuse settings of a simulated run for a recorded one.

    Raises:
        UsageError: what belongs to a simulation alone was chosen: a law, gain, plant and so on.
    """
    if settings.recorded is None:
        return
    for keyword in SIMULATED:
        if getattr(settings, keyword) != getattr(Settings(), keyword):
            option = SETTINGS[keyword].name
            raise UsageError(f"a recorded run is not simulated: leave out --{option}")

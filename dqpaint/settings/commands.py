"""Command -> the groups of settings that it takes, on the command line and in Python alike."""

from dqpaint.settings.groups import (
    ArmSettings,
    CameraSettings,
    ColourSettings,
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
from dqpaint.settings.model import GROUPS

OF_RUN: tuple[type[Group], ...] = (
    LawSettings, DisturbanceSettings, ArmSettings, MotionSettings, TimeSettings, DrawingSettings,
    MemorySettings,
)  # fmt: skip

COMMANDS: dict[str, tuple[type[Group], ...]] = {
    "draw": GROUPS,
    "preview": (
        ArmSettings, DrawingSettings, MemorySettings, LightSettings, ColourSettings, CameraSettings,
        FilmSettings, GhostSettings,
    ),
    "develop": (MemorySettings, CameraSettings, FilmSettings, GhostSettings, OcclusionSettings),
    "check": (
        ArmSettings, MotionSettings, DrawingSettings, LightSettings, CameraSettings, GhostSettings,
        OcclusionSettings,
    ),
    "export": OF_RUN,
    "plot": OF_RUN,
    "compare": GROUPS,
    "sweep": GROUPS,
    "tune": OF_RUN,
    "replay": (
        DisturbanceSettings, ArmSettings, MotionSettings, TimeSettings, DrawingSettings,
        MemorySettings,
    ),
}  # fmt: skip

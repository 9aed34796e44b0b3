"""Groups of `model` -> keywords in Python, as type checkers and editors see them.

`python -m tests.tools.generated` writes it again.
"""

from collections.abc import Callable, Mapping, Sequence
from os import PathLike
from typing import Any, Literal, TypedDict


class LawOptions(TypedDict, total=False):
    """What drives the arm."""

    controller: str | PathLike[str] | Callable[..., Any] | None
    gains: (
        Mapping[str, float | Sequence[float] | Sequence[Sequence[float]] | str]
        | Sequence[str]
        | str
        | None
    )
    sign: str | None
    learned: str | None
    recorded: str | PathLike[str] | None


class DisturbanceOptions(TypedDict, total=False):
    """What disturbs the run."""

    disturb: Mapping[str, Mapping[str, float | str] | float | str] | Sequence[str] | str | None
    spread: str | None
    seed: int | None


class ArmOptions(TypedDict, total=False):
    """Which arm holds the light, and where."""

    robot: str | PathLike[str] | None
    tool: str | None


class MotionOptions(TypedDict, total=False):
    """How an arm follows a drawing, whatever its law."""

    place: Literal["auto"] | None
    plant: str | None
    engine: Literal["pybullet", "mujoco"] | None
    start: Literal["first", "home"] | None
    null: str | None
    resolver: str | None
    task: Literal["pose", "beam", "point", "place-first"] | None
    kinematics: Literal["pinocchio", "screws"] | None
    on_limit: Literal["clip", "slow", "stop"] | None


class TimeOptions(TypedDict, total=False):
    """How long a run may take."""

    timeout: float | None


class DrawingOptions(TypedDict, total=False):
    """How large a drawing may be."""

    max_samples: int | None


class MemoryOptions(TypedDict, total=False):
    """How much memory a painting may take."""

    max_memory: float | None


class LightOptions(TypedDict, total=False):
    """What shines."""

    brush: str | None
    pwm: float | None
    lamp: str | None


class ColourOptions(TypedDict, total=False):
    """What the colours mean."""

    colour_by: str | None


class DeviationOptions(TypedDict, total=False):
    """How far the run is from the reference: to be seen, or to be made up for."""

    overlay: bool | None
    magnify: float | None
    relight: bool | None


class CameraOptions(TypedDict, total=False):
    """From where, how large and how long a picture is taken."""

    size: tuple[int, int] | str | None
    view: str | None
    exposure: str | None


class FilmOptions(TypedDict, total=False):
    """How the film is developed."""

    ev: float | None
    look: str | None
    starburst: int | None
    noise: int | None


class GhostOptions(TypedDict, total=False):
    """The arm in the picture."""

    ghost: bool | Literal["motion"] | None


class OcclusionOptions(TypedDict, total=False):
    """The arm before the light."""

    occlusion: bool | None


class DrawOptions(
    LawOptions,
    DisturbanceOptions,
    ArmOptions,
    MotionOptions,
    TimeOptions,
    DrawingOptions,
    MemoryOptions,
    LightOptions,
    ColourOptions,
    DeviationOptions,
    CameraOptions,
    FilmOptions,
    GhostOptions,
    OcclusionOptions,
):
    """Of `draw`."""


class PreviewOptions(
    ArmOptions,
    DrawingOptions,
    MemoryOptions,
    LightOptions,
    ColourOptions,
    CameraOptions,
    FilmOptions,
    GhostOptions,
):
    """Of `preview`."""


class DevelopOptions(MemoryOptions, CameraOptions, FilmOptions, GhostOptions, OcclusionOptions):
    """Of `develop`."""


class ReplayOptions(
    DisturbanceOptions, ArmOptions, MotionOptions, TimeOptions, DrawingOptions, MemoryOptions
):
    """Of `replay`."""


class RunOptions(
    LawOptions,
    DisturbanceOptions,
    ArmOptions,
    MotionOptions,
    TimeOptions,
    DrawingOptions,
    MemoryOptions,
):
    """Of a run without pictures."""

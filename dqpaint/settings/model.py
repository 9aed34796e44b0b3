"""How a drawing is painted: everything besides its text, checked."""

import re
from collections.abc import Mapping, Sequence
from typing import Annotated, Literal

from pydantic import BaseModel, ConfigDict, Field, ValidationError, field_validator

from dqpaint.core import number_or_text, read_choice, reason
from dqpaint.errors import UsageError
from dqpaint.program import MOST_ALLOWED, MOST_SAMPLES

DEFAULT_CONTROLLER = "hinf"
LARGEST = 8192  # columns or rows of a picture
SMALLEST = 16
DISTURBANCE = "twist=sine,x=0.02,frequency=2"


class Settings(BaseModel):
    """The choices of one painting, as the command line's options name them."""

    model_config = ConfigDict(extra="forbid", frozen=True)

    controller: str = DEFAULT_CONTROLLER
    gains: dict[str, float | tuple[float, ...] | str] = Field(default_factory=dict)
    robot: str | None = None  # None: the file's own robot line, else the iiwa
    tool: str | None = None  # where the light sits on the flange; None: where the card says
    place: Literal["auto"] | None = None  # None: what the file says, else the robot's canvas
    recorded: str | None = None  # a CSV of a real arm's run, instead of a simulated one
    plant: str | None = None  # None: the usual one for what the law commands
    disturb: dict[str, dict[str, float | str]] = Field(default_factory=dict)
    null: str = "start"  # what a redundant arm does with its freedom
    on_limit: Literal["clip", "slow", "stop"] = "clip"
    seed: Annotated[int, Field(ge=0, le=2**63 - 1)] = 0
    start: Literal["first", "home"] = "first"
    width: Annotated[int, Field(ge=SMALLEST, le=LARGEST)] = 1280
    height: Annotated[int, Field(ge=SMALLEST, le=LARGEST)] = 720
    view: str = "front"
    ev: Annotated[float, Field(ge=-20, le=20, allow_inf_nan=False)] = 0.0
    brush: str | None = None  # None: the file's own
    pwm: Annotated[float, Field(ge=0, le=1e5, allow_inf_nan=False)] = 0.0  # [Hz]; 0: even light
    exposure: str | None = None  # None: automatic
    look: str = "film"
    starburst: Annotated[int, Field(ge=0)] = 0  # blades of the aperture; 0: a round one
    noise: Annotated[int, Field(ge=0)] | None = None  # its seed; None: there is none
    colour_by: str | None = None
    overlay: bool = False
    magnify: Annotated[float, Field(gt=0, le=1e6, allow_inf_nan=False)] = 1.0
    ghost: Literal[False, True, "motion"] = False  # the arm is seen: flashed, or as it moved
    occlusion: bool | None = None  # its body hides light from the camera; None: as ghost
    max_samples: Annotated[int, Field(ge=1, le=MOST_ALLOWED)] = MOST_SAMPLES  # of a drawing

    @field_validator("place", mode="before")
    @classmethod
    def _place(cls, value: object) -> object:
        if value in (None, "auto"):
            return value
        raise ValueError(
            "is not auto; a place of your own is a line of the drawing: place at POINT"
        )

    @property
    def traced(self) -> bool:
        """Whether what the arm hides is traced."""
        return bool(self.ghost) if self.occlusion is None else self.occlusion

    @property
    def staged(self) -> bool:
        """Whether the arm's shapes are needed at all."""
        return bool(self.ghost) or self.traced


def make_settings(**choices: object) -> Settings:
    """Settings with the given choices; None stands for the default.

    Raises:
        UsageError: an unknown choice or a value outside its range.
    """
    return _made(choices, strict=False)


def settings_in_kind(choices: Mapping[str, object]) -> Settings:
    """The same, where `true` is no number, and "yes" is not `true`."""
    return _made(choices, strict=True)


def _made(choices: Mapping[str, object], strict: bool) -> Settings:
    given = {name: value for name, value in choices.items() if value is not None}
    try:
        return Settings.model_validate(given, strict=strict)
    except ValidationError as problem:
        first = problem.errors()[0]
        name = ".".join(str(part) for part in first["loc"])
        if first["type"] == "extra_forbidden":
            known = ", ".join(Settings.model_fields)
            raise UsageError(f"no setting named '{name}'; known: {known}") from None
        raise UsageError(f"{name} {first['input']!r} {reason(first)}") from None


def check_recorded(settings: Settings) -> None:
    """Look that nothing is asked of a recorded run that only a simulated one has.

    Raises:
        UsageError: a law, gain, plant, disturbance, start, null or on_limit was chosen.
    """
    if settings.recorded is None:
        return
    plain = Settings(recorded=settings.recorded)
    for name, option in (
        ("controller", "--controller"), ("gains", "--gain"), ("plant", "--plant"),
        ("disturb", "--disturb"), ("start", "--from"), ("null", "--null"),
        ("on_limit", "--on-limit"),
    ):  # fmt: skip
        if getattr(settings, name) != getattr(plain, name):
            raise UsageError(f"a recorded run is not simulated: leave out {option}")


def parse_size(text: str) -> tuple[int, int]:
    """Width and height [px] from `1280x720`.

    Raises:
        UsageError: anything else.
    """
    found = re.fullmatch(r"(\d{1,6})x(\d{1,6})", text)
    if found is None:
        raise UsageError(f"size '{text[:40]}' is not WIDTHxHEIGHT in pixels, for example 1280x720")
    return int(found[1]), int(found[2])


def parse_gains(texts: Sequence[str]) -> dict[str, float | str]:
    """Gains by their names from texts like `k=20`; other forms than a number the law reads.

    Raises:
        UsageError: anything else, or a gain given twice.
    """
    gains: dict[str, float | str] = {}
    for text in texts:
        name, sign, value = (part.strip() for part in text.partition("="))
        if not (name and sign and value):
            raise UsageError(
                f"gain '{text}' is not NAME=VALUE, for example k=20, or k=5..20@10% for a ramp"
            )
        if name in gains:
            raise UsageError(f"gain '{name}' is given twice")
        gains[name] = number_or_text(value)
    return gains


def parse_disturbances(texts: Sequence[str]) -> dict[str, dict[str, float | str]]:
    """Disturbances by their names from texts like `twist=sine,x=0.02` or `twist:form=sine,x=0.02`.

    A value without a name has the name "".

    Raises:
        UsageError: anything else, or a disturbance or value given twice.
    """
    found: dict[str, dict[str, float | str]] = {}
    for text in texts:
        name, values = read_choice("disturbance", text, DISTURBANCE)
        if not values:
            raise UsageError(f"disturbance '{text}' is not NAME=VALUE, for example {DISTURBANCE}")
        if name in found:
            raise UsageError(f"disturbance '{name}' is given twice")
        found[name] = values
    return found

"""Groups of settings that commands share, each a class; a command names the groups it takes.

A new setting is a field of a group, declared with its bounds, its `Option` and its default, and
nothing else: command line, Python, settings files and documents read it from there.
"""

from typing import Annotated, ClassVar, Literal

from pydantic import BaseModel, ConfigDict, Field, field_validator

from dqpaint.core import DEFAULT_MAX_SAMPLES, LARGEST_MAX_SAMPLES
from dqpaint.settings.declaration import Option, Variant
from dqpaint.settings.readers import (
    DISTURBANCE,
    Gain,
    check_spread,
    read_disturbances,
    read_gains,
    read_path,
    read_size,
)

DEFAULT_CONTROLLER = "hinf"
LARGEST = 8192  # columns or rows of a picture
SMALLEST = 16
DEFAULT_MEMORY, LARGEST_MEMORY = 1.5, 1000.0  # [GB]
DEFAULT_TIMEOUT = 3600.0  # [s]
LONGEST_TIMEOUT = 1e7  # [s], four months


class Group(BaseModel):
    """Settings that some commands take and others do not."""

    model_config = ConfigDict(extra="forbid", frozen=True, defer_build=True)

    panel: ClassVar[str]
    """The heading of these options in help and documents."""


class LawSettings(Group):
    """What drives the arm."""

    panel = "Control"

    controller: Annotated[
        str,
        Option(
            "control law: see dqpaint list controllers; or a function or class of your own",
            "NAME|FILE.py[:NAME]",
            read=read_path,
            python="str | PathLike[str] | Callable[..., Any]",
        ),
    ] = DEFAULT_CONTROLLER
    gains: Annotated[
        dict[str, Gain],
        Option(
            "a gain of that law in SI units; repeatable; 5..20@10% is a ramp in the first 10 %, "
            "1,2,3 a diagonal, '2,1;1,2' a matrix; paper: its paper's own gains",
            "NAME=VALUE|paper",
            name="gain",
            many=True,
            read=read_gains,
            python="Mapping[str, float | Sequence[float] | Sequence[Sequence[float]] | str] | "
            "Sequence[str] | str",
        ),
    ] = Field(default_factory=dict)
    sign: Annotated[
        str,
        Option(
            "which of x_d and -x_d the law goes to: the nearest; hysteresis[,delta=0.3]: the one "
            "before, until it is clearly the farther; none: the signs as they come",
            "nearest|hysteresis|none",
        ),
    ] = "nearest"
    learned: Annotated[
        str | None,
        Option("follow what dqpaint rehearse learned", "LEARNED.csv", read=read_path),
    ] = None
    recorded: Annotated[
        str | None,
        Option(
            "paint a real arm's run: a CSV of t_s and joints or poses, or a bag, see README",
            "RUN.csv|RUN.mcap",
            read=read_path,
            python="str | PathLike[str]",
        ),
    ] = None


class DisturbanceSettings(Group):
    """What disturbs the run."""

    panel = "Control"

    disturb: Annotated[
        dict[str, dict[str, float | str]],
        Option(
            f"a disturbance, repeatable, such as {DISTURBANCE}",
            "NAME=VALUE,...",
            many=True,
            read=read_disturbances,
            python="Mapping[str, Mapping[str, float | str] | float | str] | Sequence[str] | str",
        ),
    ] = Field(default_factory=dict)
    spread: Annotated[
        str | None,
        Option(
            "set-up that differs by seed: posture[=DEG] to begin in, place[=MM] of the drawing "
            "(standard deviations; 5 and 20)",
            "posture,place",
            unsaid="none",
            read=check_spread,
        ),
    ] = None
    seed: Annotated[int, Field(ge=0, le=2**63 - 1), Option("seed of everything random")] = 0


class ArmSettings(Group):
    """Which arm holds the light, and where."""

    panel = "Arm"

    robot: Annotated[
        str | None,
        Option(
            "the arm, or its .urdf or .toml",
            "NAME|FILE",
            unsaid="the drawing's, else iiwa",
            read=read_path,
            python="str | PathLike[str]",
        ),
    ] = None
    tool: Annotated[
        str | None,
        Option(
            "where the light sits on the flange, m and deg, or with units: 0,0,80mm",
            "X,Y,Z[,R,P,Y]",
            unsaid="the arm's card's",
        ),
    ] = None


class MotionSettings(Group):
    """How an arm follows a drawing, whatever its law."""

    panel = "Arm"

    place: Annotated[
        Literal["auto"] | None,
        Option(
            "put the drawing where it fits the arm best",
            "auto",
            unsaid="the drawing's, else the arm's canvas",
        ),
    ] = None
    plant: Annotated[
        str | None,
        Option(
            "how the arm answers, such as compliant:frequency=60",
            "NAME[:KEY=VALUE,...]",
            unsaid="stiff, or torque for its laws",
        ),
    ] = None
    engine: Annotated[
        Literal["pybullet", "mujoco"] | None,
        Option(
            "the physics engine that moves the arm's masses",
            "pybullet|mujoco",
            unsaid="pybullet if it is installed, else mujoco",
        ),
    ] = None
    start: Annotated[
        Literal["first", "home"],
        Option(
            "start posture: at the first pose of the drawing, or home", "first|home", name="from"
        ),
    ] = "first"
    null: Annotated[
        str,
        Option(
            "secondary task of a redundant arm: see dqpaint list null",
            "NAME[,gain=VALUE]",
        ),
    ] = "start"
    resolver: Annotated[
        str | None,
        Option(
            "what turns the law's twist into joint rates: see dqpaint list resolvers",
            "NAME[,KEY=VALUE...]",
            unsaid="filter; qp where a drawing has walls",
        ),
    ] = None
    task: Annotated[
        Literal["pose", "beam", "point", "place-first"] | None,
        Option(
            "what of the tool is controlled: all of its pose, all but the turn about its beam, "
            "its position alone, or the position before the orientation",
            "pose|beam|point|place-first",
            unsaid="the drawing's, else pose",
        ),
    ] = None
    kinematics: Annotated[
        Literal["pinocchio", "screws"],
        Option(
            "what poses and Jacobians are computed by: pinocchio, or screws: products of "
            "exponentials of dual quaternions (Ozgur 2016); the same to 1e-9, and slower",
            "pinocchio|screws",
        ),
    ] = "pinocchio"
    on_limit: Annotated[
        Literal["clip", "slow", "stop"],
        Option(
            "where a joint would pass a limit: clip the command, slow the drawing down, or stop",
            "clip|slow|stop",
        ),
    ] = "clip"

    @field_validator("place", mode="before")
    @classmethod
    def _place(cls, value: object) -> object:
        if value in (None, "auto"):
            return value
        raise ValueError("is not auto; another placement is a line of the drawing: place at POINT")


class DrawingSettings(Group):
    """How large a drawing may be."""

    panel = "Limits"

    max_samples: Annotated[
        int,
        Field(ge=1, le=LARGEST_MAX_SAMPLES),
        Option("samples that the drawing may have; in a run each takes about 4 kB", "N"),
    ] = DEFAULT_MAX_SAMPLES


class TimeSettings(Group):
    """How long a run may take."""

    panel = "Limits"

    timeout: Annotated[
        float,
        Field(gt=0, le=LONGEST_TIMEOUT, allow_inf_nan=False),
        Option("what a run may take; one of a study that takes longer is left out", "SECONDS"),
    ] = DEFAULT_TIMEOUT


class MemorySettings(Group):
    """How much memory a painting may take."""

    panel = "Limits"

    max_memory: Annotated[
        float,
        Field(gt=0, le=LARGEST_MEMORY, allow_inf_nan=False),
        Option("memory that a painting may take; it is forecast before the run", "GB"),
    ] = DEFAULT_MEMORY


class LightSettings(Group):
    """What shines."""

    panel = "Light"

    brush: Annotated[
        str | None,
        Option(
            "what shines; see: dqpaint list brushes",
            "NAME[:KEY=VALUE,...]",
            unsaid="the drawing's, else a point",
        ),
    ] = None
    pwm: Annotated[
        float,
        Field(ge=0, le=1e5, allow_inf_nan=False),
        Option("frequency [Hz] at which the lamps are dimmed by pulses; 0: evenly", "HZ"),
    ] = 0.0
    lamp: Annotated[
        str,
        Option(
            "powers of a photo's lamp: ideal, dimmed (8 bits, gamma 2.2), switched (on and off); "
            "bits=N, gamma=G, least=SHARE",
            "NAME[:KEY=VALUE,...]",
        ),
    ] = "ideal"


class ColourSettings(Group):
    """What the colours mean."""

    panel = "Light"

    colour_by: Annotated[
        str | None,
        Option(
            "what the colours show of the run: see dqpaint list columns; END of the scale, such "
            "as position-error:20",
            "FIGURE[:END]",
        ),
    ] = None


class DeviationSettings(Group):
    """How far the run is from the reference: to be seen, or to be made up for."""

    panel = "Light"

    overlay: Annotated[bool, Option("the reference beneath, in faint lines")] = False
    magnify: Annotated[
        float,
        Field(gt=0, le=1e6, allow_inf_nan=False),
        Option("deviations from the reference, N times as large", "N"),
    ] = 1.0
    relight: Annotated[
        bool,
        Option("after the run the light of photos is solved again, on the path that was reached"),
    ] = False


class CameraSettings(Group):
    """From where, how large and how long a picture is taken."""

    panel = "Picture"

    width: Annotated[
        int,
        Field(ge=SMALLEST, le=LARGEST),
        Option(
            "width and height of the picture, in pixels; or square, portrait, a3@300dpi",
            "WxH",
            name="size",
            parts=("width", "height"),
            read=read_size,
            python="tuple[int, int] | str",
        ),
    ] = 1280
    height: Annotated[int, Field(ge=SMALLEST, le=LARGEST)] = 720
    view: Annotated[
        str,
        Option(
            "from where: front, iso, side, top, or AZ,EL: degrees to its right and above; "
            "stereo[:VIEW], orbit[:N[:EL]], at:X:Y:Z[:X:Y:Z] m; several with commas",
            "VIEW",
        ),
    ] = "front"
    exposure: Annotated[
        str | None,
        Option(
            "settings of a camera, in any order: f/8,iso100,35mm,nd3,0.1cd,2.2m,30s",
            "SETTINGS",
            unsaid="automatic",
        ),
    ] = None


class FilmSettings(Group):
    """How the film is developed."""

    panel = "Picture"

    ev: Annotated[
        float,
        Field(ge=-20, le=20, allow_inf_nan=False),
        Option("exposure in stops, on top of the automatic one"),
    ] = 0.0
    look: Annotated[str, Option("how the film is developed; see: dqpaint list looks", "NAME")] = (
        "film"
    )
    starburst: Annotated[
        int, Field(ge=0), Option("blades of an aperture that draws rays; 0: a round one", "BLADES")
    ] = 0
    noise: Annotated[
        int | None, Field(ge=0), Option("seed of the sensor's noise", "SEED", unsaid="no noise")
    ] = None


class GhostSettings(Group):
    """The arm in the picture."""

    panel = "Picture"

    ghost: Annotated[
        Literal[False, True, "motion"],
        Option(
            "the arm in the picture, and room for it",
            variant=Variant("motion-ghost", "motion", "the moving arm as a blurred veil"),
            python='bool | Literal["motion"]',
        ),
    ] = False


class OcclusionSettings(Group):
    """The arm before the light."""

    panel = "Picture"

    occlusion: Annotated[
        bool | None,
        Option("the arm's body hides light from the camera", unsaid="as --ghost"),
    ] = None

"""What the page asks of the workers, and what they answer: plain data, as it crosses processes."""

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any, Literal

import numpy as np
from numpy.typing import NDArray

from dqpaint.dq import Floats

Tier = Literal["ideal", "physics"]
Want = Literal["picture", "run", "page", "verdict"]


@dataclass(frozen=True)
class Request:
    """A text and choices to show.

    Attributes:
        text: of the drawing.
        path: of its file, for messages and the files it includes.
        choices: of a run, by their names in Python, as `dqpaint.draw` takes them.
        width: of the picture [px].
        height: of the picture [px].
        want: the picture, the run, the run as a page in 3-D, or a verdict on two runs.
        other: of a verdict, text and choices of the other run.
    """

    text: str
    path: str
    choices: Mapping[str, Any]
    width: int
    height: int
    want: Want = "run"
    other: "tuple[str, Mapping[str, Any]] | None" = None


@dataclass(frozen=True)
class Finding:
    """A diagnostic at its place in the text; offsets are code points, of the main file alone."""

    code: str
    is_error: bool
    line: int
    start: int
    end: int
    message: str
    help: str
    fix: tuple[str, int, int, str] | None  # title, start, end, new text
    here: bool = True  # whether it is in the text and not in an included file


@dataclass(frozen=True)
class Reading:
    """The result of reading a text.

    Attributes:
        findings: its diagnostics.
        lines: length and time of each line that moves the tool.
        fault: why it could not be read or shown at all.
    """

    findings: tuple[Finding, ...]
    lines: Mapping[int, str] = field(default_factory=dict)
    fault: str = ""


@dataclass(frozen=True)
class Shown:
    """A picture, and where its light is.

    Attributes:
        image: PNG or JPEG.
        time: (K,) of points along the reference [s].
        line: (K,) their lines in the text; 0 in an included file.
        pixels: (K, 2) column and row of the picture.
        points: (K, 3) base frame [m].
        colours: (K, 3) linear, 0 where the light is off.
        about: length, time and size in a line.
    """

    image: bytes
    time: Floats
    line: NDArray[np.int64]
    pixels: Floats
    points: Floats
    colours: Floats
    about: str


@dataclass(frozen=True)
class Figure:
    """One figure of a run as it is shown."""

    name: str
    title: str
    value: float
    unit: str


@dataclass(frozen=True)
class Curve:
    """Curves of one quantity over time: values (K, n), limits (n,) where an arm has them."""

    title: str
    unit: str
    names: tuple[str, ...]
    values: Floats
    limits: Floats | None = None


@dataclass(frozen=True)
class Run:
    """A finished run.

    Attributes:
        tier: ideal or physics.
        title: law and plant.
        image: of its picture, PNG.
        figures: what it is worth.
        faults: why it is no result, a sentence each.
        notes: what was assumed, and what limits clipped, a sentence each.
        robot: whose shapes `links` places.
        time: (K,) of the curves [s].
        line: (K,) of the text.
        points: (K, 3) that the light reached, base frame [m].
        curves: over `time`.
        frame_time: (F,) of the frames to come [s].
        links: (F, L, 7) position and quaternion (w first) of each shape of the arm at the frames.
        seconds: wall time of the run.
    """

    tier: Tier
    title: str
    image: bytes
    figures: tuple[Figure, ...]
    faults: tuple[str, ...]
    notes: tuple[str, ...]
    robot: str
    time: Floats
    line: NDArray[np.int64]
    points: Floats
    curves: tuple[Curve, ...]
    frame_time: Floats
    links: Floats
    seconds: float


@dataclass(frozen=True)
class ArmShapes:
    """The shapes of an arm: a name, and an STL and colour of each."""

    robot: str
    shapes: tuple[tuple[bytes, tuple[float, float, float]], ...]


@dataclass(frozen=True)
class Frame:
    """The picture at one of the frame times, JPEG."""

    index: int
    image: bytes


@dataclass(frozen=True)
class Progress:
    """How far a run is."""

    tier: Tier
    share: float


@dataclass(frozen=True)
class Forecast:
    """What the arm will meet: warnings at their lines, and a summary."""

    findings: tuple[Finding, ...]
    about: str


@dataclass(frozen=True)
class RunPage:
    """A run as a page of its own, HTML."""

    html: bytes


@dataclass(frozen=True)
class Verdict:
    """Whether two runs differ by more than their spread, in a sentence."""

    says: str


@dataclass(frozen=True)
class Failure:
    """Why a run could not be made, a sentence."""

    tier: Tier
    reason: str


Answer = (
    Reading | Shown | Run | ArmShapes | Frame | Progress | Forecast | RunPage | Verdict | Failure
)

"""The parts of a run's JSON summary, declared once -> its JSON Schema."""

from typing import Annotated, Any, Literal, NotRequired

from pydantic import Field, TypeAdapter
from typing_extensions import TypedDict

from dqpaint.metrics import all_figures
from dqpaint.robots.kinematics import ModelNumbers
from dqpaint.settings import RUN_SCHEMA, Settings

TABLE_SCHEMA = "dqpaint-table-2"
Line = int | str
Colour = Annotated[list[float], Field(min_length=3, max_length=3)]


class Law(TypedDict):
    """Where the law is from: a paper, or a file with its hash; and what it commands."""

    source: str
    sha256: str | None
    commands: Literal["twist", "rates", "acceleration", "torque"]


class NullSpace(TypedDict):
    """The secondary task of a redundant arm, and its gain."""

    objective: str
    gain: float


class Drawing(TypedDict):
    """The reference motion, the size of its box; `place` is where `place auto` put it."""

    samples: int
    period_s: float
    duration_s: float
    length_m: float
    box_m: list[float]
    place: dict[str, Any] | None


class Through(TypedDict):
    """How much of a disturbance came through, beside the bound of the gains; norms in time.

    `bound_in_steps_s` is the bound with the period and the turns of this run; `of_gammas` the error
    as a part of gamma_1 ||v_w|| + gamma_2 ||v_c|| of Pereira 2016, (3.26), below 1 as promised.
    """

    ratio_s: float
    bound_s: float | None
    kept: bool | None
    bound_in_steps_s: float | None
    of_gammas: float | None


class SetPoint(TypedDict):
    """The response to one jump of the reference."""

    time_s: float
    line: Line
    translation: dict[str, float | None]
    rotation: dict[str, float | None]


class RunFault(TypedDict):
    """Why a run is no result: its kind, a sentence, the line where it is worst."""

    kind: str
    says: str
    line: Line


class RunStatus(TypedDict):
    """Whether a run is a result: `done`, or the kind of its first fault."""

    status: str
    faults: list[RunFault]


class Limit(TypedDict):
    """A limit that clipped a joint for some time."""

    kind: str
    joint: int
    start: float
    seconds: float
    line: Line
    limit: float
    wanted: float
    unit: str


class Light(TypedDict):
    """The energy of the light: emitted = on film + lost + occluded."""

    unit: str
    emitted: Colour
    on_film: Colour
    lost: Colour
    occluded: Colour | None
    exposure: float


class WallShape(TypedDict):
    """A wall of the drawing: the least distance of the true arm, and how long it held the arm."""

    line: int | str
    says: str
    least: float
    unit: str
    time_s: float
    held_s: float


class TableColumn(TypedDict):
    """Columns of the CSV that belong together."""

    names: list[str]
    unit: str
    meaning: str


class TableShape(TypedDict):
    """The CSV of this run."""

    schema: str
    rows: int
    columns: list[TableColumn]


class Summary(TypedDict):
    """The summary of a run: what was run, by what, and what came of it; SI units.

    The figures of `dqpaint list figures` that the run has stand beside these, each a number.
    """

    schema: str
    file: str
    included: list[str]
    sha256: str
    versions: dict[str, str]
    plugins: NotRequired[dict[str, str]]
    robot: str
    plant: str
    engine: str | None
    recording: dict[str, Any] | None
    plant_values: dict[str, Any]
    controller: str
    law: Law
    gains: dict[str, Any]
    disturbances: dict[str, dict[str, Any]]
    without_effect: dict[str, str]
    null_space: NullSpace
    seed: int
    settings: dict[str, Any]
    model: ModelNumbers
    drawing: Drawing
    pace: dict[str, Any] | None
    corners: dict[str, float] | None
    result: RunStatus
    attenuation: dict[str, Through]
    set_points: list[SetPoint]
    limits: list[Limit]
    resolver: str
    task: str
    walls: list[WallShape]
    light: Light
    table: TableShape
    wall_s: NotRequired[dict[str, float]]


def json_schema() -> dict[str, Any]:
    """The JSON Schema (2020-12) of a summary, made of the declarations above and the figures."""
    shape = TypeAdapter(Summary).json_schema()
    properties = shape["properties"]
    for name, figure in all_figures().items():
        unit = f" [{figure.unit}]" if figure.unit else ""
        properties[name] = {
            "type": "number",
            "description": f"{figure.title}{unit}: {figure.meaning}",
        }
    properties["schema"]["const"] = RUN_SCHEMA
    properties["settings"] = Settings.model_json_schema(mode="serialization")
    shape["$defs"]["TableShape"]["properties"]["schema"]["const"] = TABLE_SCHEMA
    shape["additionalProperties"] = {"type": "number", "description": "a figure of a package"}
    return {"$schema": "https://json-schema.org/draft/2020-12/schema", **shape}

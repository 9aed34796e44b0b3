"""A URDF, or a card in TOML -> the checked card of an arm.

Missing data is derived where possible, with a note in the card; otherwise an error names it.
"""

import math
import tomllib
from pathlib import Path
from typing import Any, get_args

import numpy as np
from pydantic import BaseModel, ValidationError

from dqpaint.core import pydantic_reason, read_regular
from dqpaint.errors import DqpaintError, UsageError
from dqpaint.robots.model.card import LEAST_JOINTS, Canvas, Card
from dqpaint.robots.model.chain import Axes, Rows
from dqpaint.robots.model.screws import Screws
from dqpaint.robots.urdf.capsules import default_body
from dqpaint.robots.urdf.tree import LEAST_LIMIT, REVOLUTE_KINDS, Joint, Tree, shortened_list

PLACEHOLDER_CANVAS = Canvas(
    at_m=(0, 0, 0), right=(0, 1, 0), up=(0, 0, 1)
)  # until a better one is found
LARGEST_CARD = 1_000_000  # bytes of a .toml file
UNLIMITED_RANGE = 360.0  # [deg] to either side, of a joint without ends


def read_file(robot: str) -> Card:
    """The card of the arm that a file describes.

    Args:
        robot: the path of a .toml or .urdf; a .urdf may be followed by a colon and the link that
            carries the light.

    Raises:
        UsageError: the file cannot be read, or the link is ambiguous.
        DqpaintError: it is not an arm; the message has the position and the requirement.
    """
    file, link = robot, ""
    if not robot.endswith((".toml", ".urdf")):
        head, _, link = robot.rpartition(".urdf:")
        file = f"{head}.urdf"
    path = Path(file)
    if path.suffix == ".urdf":
        raw: dict[str, Any] = {"urdf": {"file": str(path)}}
        if link:
            raw["urdf"]["link"] = link
    else:
        raw = _read_toml(path)
    return _complete(raw, path)


def _read_toml(path: Path) -> dict[str, Any]:
    try:
        raw = tomllib.loads(read_regular(path, LARGEST_CARD).decode("utf-8"))
    except OSError as problem:
        raise DqpaintError(f"robot '{path}' cannot be read: {problem.strerror}") from None
    except (tomllib.TOMLDecodeError, UnicodeDecodeError, RecursionError) as problem:
        reason = "it is nested too deep" if isinstance(problem, RecursionError) else problem
        raise DqpaintError(f"{path.name} is not valid TOML: {reason}") from None
    urdf = raw.get("urdf")
    if isinstance(urdf, dict) and isinstance(urdf.get("file"), str) and not urdf.get("package"):
        urdf["file"] = str(path.parent / urdf["file"])
    return raw


def _complete(raw: dict[str, Any], path: Path) -> Card:
    """Add missing parts step by step, with a note for each."""
    notes: list[str] = []
    raw = {"name": path.stem, "title": path.stem, "source": path.name, "licence": "", **raw}
    urdf = raw.get("urdf")
    if isinstance(urdf, dict) and isinstance(urdf.get("file"), str) and not urdf.get("package"):
        tree = Tree(Path(urdf["file"]))
        if "link" not in urdf:
            urdf["link"] = _only_tip(tree)
            notes.append(f"the light is on link '{urdf['link']}', the last one")
        if "limits" not in raw:
            raw["limits"] = _limits(tree, urdf["link"])
    if "tool" not in raw:
        raw["tool"] = {}
        notes.append(
            f"{_missing_note(path, '[tool]')}the light is on the last frame, whose z axis is the "
            f"lamp's{_fix_note(path, '--tool puts it elsewhere')}"
        )
    _derive_body(raw, path, notes)
    limits = raw.get("limits")
    home, canvas = "home_deg" in raw, "canvas" in raw
    if not home:
        raw["home_deg"] = _middles(limits)
    if not canvas:
        raw["canvas"] = PLACEHOLDER_CANVAS
    card = _validate(raw, path)
    if not (home and canvas):
        card = _find_home_and_canvas(card, home, canvas, path, notes)
    return card.model_copy(update={"notes": (*card.notes, *notes)})


def _missing_note(path: Path, what: str) -> str:
    """The beginning of a note about a missing part of a card; empty for a URDF."""
    return "" if path.suffix == ".urdf" else f"no {what}: "


def _fix_note(path: Path, fix: str) -> str:
    """The end of a note for an arm that has only a URDF."""
    return f"; {fix}" if path.suffix == ".urdf" else ""


def _find_home_and_canvas(
    card: Card, home: bool, canvas: bool, path: Path, notes: list[str]
) -> Card:
    """Find the home posture, the canvas, or both."""
    from dqpaint.robots.loading import defaults

    if home:
        found = defaults.canvas_at(card)
        notes.append("no [canvas]: it is where the home posture holds the light")
        return card.model_copy(update={"canvas": found})
    if canvas:
        posture = defaults.find_home(card, card.canvas)
    else:
        found, posture = defaults.find_canvas(card)
        card = card.model_copy(update={"canvas": found})
        x, y, z = found.at_m
        notes.append(
            f"{_missing_note(path, '[canvas]')}drawings go to ({x:g}, {y:g}, {z:g}) m, facing "
            f"along x{_fix_note(path, 'place puts them elsewhere')}"
        )
    degrees = np.degrees(posture).round(9).tolist()
    taken = ", ".join(f"{angle:.4g}" for angle in np.round(degrees, 9) + 0.0)
    help = "a card can say all this, see README"
    notes.append(
        f"no home_deg: {taken} is taken"
        if path.suffix != ".urdf"
        else f"the home posture is {taken} deg; {help}"
    )
    return card.model_copy(update={"home_deg": tuple(degrees)})


def _middles(limits: Any) -> list[float]:
    """The middle of every joint's range, as a placeholder."""
    try:
        pairs = zip(limits["lower_deg"], limits["upper_deg"], strict=True)
        return [0.5 * (low + high) for low, high in pairs]
    except (TypeError, KeyError, ValueError):
        return []  # the limits themselves have an error, which is reported later


def _derive_body(raw: dict[str, Any], path: Path, notes: list[str]) -> None:
    for table, model in (("denavit_hartenberg", Rows), ("screws", Axes)):
        if table in raw and "body" not in raw:
            try:
                chain = model.model_validate(raw[table]).chain
            except ValidationError as problem:
                raise _first_error(problem, path, table) from None
            raw["body"] = default_body(chain if isinstance(chain, Screws) else chain.screws())
            notes.append(
                "no [body]: the arm is taken to be as thick and heavy as arms of its reach"
            )


def _validate(raw: dict[str, Any], path: Path) -> Card:
    try:
        return Card.model_validate(raw)
    except ValidationError as problem:
        raise _first_error(problem, path) from None


def _first_error(problem: ValidationError, path: Path, *above: str) -> DqpaintError:
    """The first error of a card, with the name of its field; list items count from 1."""
    first = problem.errors()[0]
    steps = (*above, *first["loc"])
    name = "".join(f"[{s + 1}]" if isinstance(s, int) else f".{s}" for s in steps).lstrip(".")
    fault = pydantic_reason(first)
    if first["type"] == "missing":
        fault = "is missing"
        if name == "limits":
            fault += f": it has {', '.join(_fields(steps))}, one number per joint"
    elif first["type"] == "model_type":
        fault = f"is not a table with {', '.join(_fields(steps))}"
    elif first["type"] == "extra_forbidden":
        fault = f"is not known; known: {', '.join(_fields(steps[:-1]))}"
    return DqpaintError(f"{path.name}: {name} {fault}".replace(":  ", ": "))


def _fields(steps: tuple[str | int, ...]) -> list[str]:
    """The names that a table of a card may have."""
    model: Any = Card
    for step in steps:
        if isinstance(step, str):
            model = _nested_model(model.model_fields[step].annotation)
    return [name for name in model.model_fields if name != "notes"]


def _nested_model(annotation: Any) -> Any:
    """The model of a nested table in a field's type."""
    if isinstance(annotation, type) and issubclass(annotation, BaseModel):
        return annotation
    return next((m for m in map(_nested_model, get_args(annotation)) if m is not None), None)


def _only_tip(tree: Tree) -> str:
    """The link at the end of the only arm in a description."""
    ends = {tip: [j for j in tree.chain(tip) if j.kind != "fixed"] for tip in tree.tips}
    arms = [
        tip
        for tip, joints in ends.items()
        if len(joints) >= LEAST_JOINTS and all(j.kind in REVOLUTE_KINDS for j in joints)
    ]
    if len(arms) == 1:
        return arms[0]
    name = tree.path.name
    if not arms:
        for joints in ends.values():
            other = next((j for j in joints if j.kind not in REVOLUTE_KINDS), None)
            if (
                other is not None
                and len([j for j in joints if j.kind in REVOLUTE_KINDS]) >= LEAST_JOINTS
            ):
                raise DqpaintError(
                    f"{name}: joint '{other.name}' is {other.kind or 'without a type'}: only arms "
                    "whose joints all turn are known"
                )
        longest = max(
            len([j for j in joints if j.kind in REVOLUTE_KINDS]) for joints in ends.values()
        )
        raise DqpaintError(
            f"{name} has no arm with {LEAST_JOINTS} or more revolute joints; "
            f"its longest chain has {longest}"
        )
    raise UsageError(
        f"{name} ends in several links: {shortened_list(arms)}; name the one that carries the "
        f"light, for example {name}:{arms[0]}"
    )


def _limits(tree: Tree, link: str) -> dict[str, list[float]]:
    """The limits of the joints up to a link, in the form of a card."""
    joints = tree.arm(link)
    return {
        "lower_deg": [_end(tree, j, "lower", -UNLIMITED_RANGE) for j in joints],
        "upper_deg": [_end(tree, j, "upper", UNLIMITED_RANGE) for j in joints],
        "speed_deg_s": [math.degrees(_strength(tree, j, "velocity", "rad/s")) for j in joints],
        "effort_Nm": [_strength(tree, j, "effort", "Nm") for j in joints],
    }


def _end(tree: Tree, joint: Joint, what: str, without: float) -> float:
    value = joint.limit(what)
    if joint.kind == "continuous":
        return without
    lower, upper = joint.limit("lower"), joint.limit("upper")
    if value is None or lower is None or upper is None or upper - lower < LEAST_LIMIT:
        raise DqpaintError(
            f"{tree.path.name}: joint '{joint.name}' needs a <limit> with lower below upper, in rad"
        )
    return math.degrees(value)


def _strength(tree: Tree, joint: Joint, what: str, unit: str) -> float:
    value = joint.limit(what)
    if value is None or value < LEAST_LIMIT:
        article = "an" if what == "effort" else "a"
        said = "has no"
        if value is not None:
            said = f"cannot move with its {what} of {value:g}: it needs {article}"
        raise DqpaintError(
            f"{tree.path.name}: joint '{joint.name}' {said} {what} limit above 0, in {unit}; "
            "write it there, or all [limits] in a .toml file"
        )
    return value

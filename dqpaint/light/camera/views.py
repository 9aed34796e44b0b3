"""A text such as `front,orbit:12` -> shots, and each shot -> its camera."""

from __future__ import annotations

import math
from dataclasses import dataclass
from itertools import count

import numpy as np

from dqpaint.errors import UnknownNameError, UsageError
from dqpaint.light.arrays import Floats, checked_array
from dqpaint.light.camera.camera import (
    DEFAULT_LENS,
    FRAME_FILL,
    NEAREST_DEPTH,
    VIEWS,
    Camera,
    View,
    frame_points,
    view_axes,
)

EYE_DISTANCE_RATIO = 1.0 / 30.0
"""Distance between the eyes of a stereo pair over the distance to the drawing: the photographers'
rule."""
DEFAULT_ORBIT_VIEWS = 12
"""Default number of views in an orbit."""
MOST_ORBIT_VIEWS = 360
CLOSEST_TARGET = 0.01
"""Least distance from a camera to its target [m]."""
FARTHEST_COORDINATE = 100.0
"""Largest coordinate of a camera or its target [m]."""
DEFAULT_ORBIT_ELEVATION = 15.0
"""Default elevation of an orbit [deg]."""


@dataclass(frozen=True)
class Shot:
    """One picture to take: the name and the placement of its camera.

    Attributes:
        name: Of the view, as it goes into the name of its file.
        view: From where.
        eye: Half the distance of the eyes, with its sign, over that to the drawing.
        orbit: Whether all of it must be seen from the same distance as from all round.
        series: Shots of one series have one exposure; 0 is by itself.
        position: Of the camera, base frame [m]; None: where the drawing fills the picture.
        target: What is in the middle of the picture then, likewise; None: the drawing's middle.
    """

    name: str
    view: View
    eye: float = 0.0
    orbit: bool = False
    series: int = 0
    position: tuple[float, float, float] | None = None
    target: tuple[float, float, float] | None = None


def parse_views(text: str) -> tuple[Shot, ...]:
    """Parse the shots of a text: names with commas, such as `front,iso,20,30,stereo:side`.

    Two numbers that follow each other are azimuth and elevation in degrees; `at:X:Y:Z[:X:Y:Z]` are
    the positions of the camera and of its target, in metres from the robot's base.

    Raises:
        UsageError: an unknown view, an elevation beyond a pole, or one view twice.
    """
    words = [word.strip() for word in text.split(",")]
    shots: list[Shot] = []
    series = count(1)
    while words:
        word = words.pop(0)
        kind, *choices = word.split(":")
        if kind == "stereo":
            shots += _stereo(text, word, choices, next(series))
        elif kind == "orbit":
            shots += _orbit(text, word, choices, next(series))
        elif kind == "at":
            shots.append(_at_position(word, choices))
        elif word in VIEWS:
            shots.append(Shot(word, VIEWS[word]))
        else:
            view = _angles(text, word, words.pop(0) if words else "")
            shots.append(Shot(_name(view), view))
    names = [shot.name for shot in shots]
    for name in names:
        if names.count(name) > 1:
            raise UsageError(f"view '{text}': {name} is given twice")
    return tuple(shots)


def _name(view: View) -> str:
    return f"az{view.azimuth:g}-el{view.elevation:g}"


def _number(word: str) -> float | None:
    try:
        value = float(word)
    except ValueError:
        return None
    return value if math.isfinite(value) else None


def _angles(text: str, first: str, second: str) -> View:
    azimuth, elevation = _number(first), _number(second)
    if azimuth is None or elevation is None:
        shown = first if azimuth is None else text
        forms = ("AZ,EL in degrees", "stereo[:VIEW]", "orbit[:N[:EL]]", "at:X:Y:Z")
        raise UnknownNameError("view", shown, [*VIEWS, *forms])
    return View(azimuth, _elevation(elevation))


def _at_position(word: str, choices: list[str]) -> Shot:
    numbers = [_number(choice) for choice in choices]
    known = [
        number for number in numbers if number is not None and abs(number) <= FARTHEST_COORDINATE
    ]
    if len(numbers) not in (3, 6) or len(known) != len(numbers):
        raise UsageError(
            f"view '{word[:60]}' is not at:X:Y:Z or at:X:Y:Z:X:Y:Z, the positions of the "
            f"camera and of its target, in metres from the robot's base, at "
            f"most {FARTHEST_COORDINATE:g}"
        )
    place, target = (known[0], known[1], known[2]), None
    if len(known) == 6:
        target = (known[3], known[4], known[5])
        if math.dist(place, target) < CLOSEST_TARGET:
            raise UsageError(f"view '{word}': the camera is at its target")
    name = "_".join(["at", *(f"{number:g}" for number in known)])
    return Shot(name, VIEWS["front"], position=place, target=target)


def _elevation(value: float) -> float:
    if not -90.0 <= value <= 90.0:
        raise UsageError(f"view elevation {value:g} deg must be from -90 to 90")
    return value


def _stereo(text: str, word: str, choices: list[str], series: int) -> list[Shot]:
    name = choices[0] if choices else "front"
    if len(choices) == 2:
        view = _angles(text, *choices)
    elif len(choices) < 2 and name in VIEWS:
        view = VIEWS[name]
    else:
        raise UsageError(f"view '{word}' is not stereo, stereo:NAME or stereo:AZ:EL")
    eyes = (("left", -0.5 * EYE_DISTANCE_RATIO), ("right", 0.5 * EYE_DISTANCE_RATIO))
    return [Shot(f"stereo-{side}", view, eye, series=series) for side, eye in eyes]


def _orbit(text: str, word: str, choices: list[str], series: int) -> list[Shot]:
    numbers = [_number(choice) for choice in choices]
    around, raised = (
        *numbers,
        *((float(DEFAULT_ORBIT_VIEWS), DEFAULT_ORBIT_ELEVATION)[len(numbers) :]),
    )[:2]
    if len(choices) > 2 or around is None or raised is None or around != int(around):
        raise UsageError(f"view '{word}' is not orbit, orbit:N or orbit:N:EL")
    if not 2 <= around <= MOST_ORBIT_VIEWS:
        raise UsageError(f"view '{word}': an orbit has 2 to {MOST_ORBIT_VIEWS} views")
    n, elevation = int(around), _elevation(raised)
    digits = len(str(n - 1))
    return [
        Shot(f"orbit-{i:0{digits}}", View(360.0 * i / n, elevation), 0.0, True, series)
        for i in range(n)
    ]


def camera_for_shot(
    shot: Shot,
    points: Floats,
    canvas_rotation: Floats,
    size: tuple[int, int],
    lens: float = DEFAULT_LENS,
    distance: float | None = None,
    fill: float = FRAME_FILL,
) -> Camera:
    """The camera of a shot that shows all points; arguments as in `frame_points`."""
    if shot.position is not None:
        return _fixed_camera(shot, points, canvas_rotation, size, lens)
    if shot.orbit and distance is None:
        return _orbit_camera(shot, points, canvas_rotation, size, lens, fill)
    camera = frame_points(points, canvas_rotation, shot.view, size, lens, distance, fill)
    if shot.eye == 0.0:
        return camera
    away = distance_to(camera, points)
    shift = shot.eye * away
    position = camera.position + shift * camera.rotation[0]
    # shifted lenses instead of turned ones: the middle of the drawing is where it was, and
    # nothing is higher in one eye than in the other
    centre = camera.centre + np.array([camera.focal * shift / away, 0.0])
    return Camera(position, camera.rotation, camera.focal, centre, camera.width, camera.height)


def _fixed_camera(
    shot: Shot, points: Floats, canvas_rotation: Floats, size: tuple[int, int], lens: float
) -> Camera:
    """A camera at a given position, upright with respect to the canvas."""
    axes = checked_array("canvas rotation", canvas_rotation, (3, 3))
    place = np.array(shot.position)
    if shot.target is None:
        local = points @ axes
        target = axes @ (0.5 * (local.min(axis=0) + local.max(axis=0)))
    else:
        target = np.array(shot.target)
    away = float(np.linalg.norm(place - target))
    if away < CLOSEST_TARGET:
        raise UsageError(f"view '{shot.name}': the camera is at its target")
    right, up, back = axes.T @ (place - target) / away
    azimuth = math.degrees(math.atan2(right, back)) if math.hypot(right, back) > 1e-9 else 0.0
    view = View(azimuth, math.degrees(math.asin(np.clip(up, -1.0, 1.0))))
    centre = 0.5 * np.array([size[0] - 1.0, size[1] - 1.0])
    camera = Camera(place, view_axes(view) @ axes.T, lens * max(size), centre, *size)
    if camera.project(points)[1].max() <= NEAREST_DEPTH:
        raise UsageError(f"view '{shot.name}': the camera looks away from the drawing")
    return camera


def _orbit_camera(
    shot: Shot,
    points: Floats,
    canvas_rotation: Floats,
    size: tuple[int, int],
    lens: float,
    fill: float,
) -> Camera:
    """A camera on a circle around the centre, far enough to show a sphere around all points."""
    axes = checked_array("canvas rotation", canvas_rotation, (3, 3))
    local = points @ axes
    middle = 0.5 * (local.min(axis=0) + local.max(axis=0))
    radius = max(float(np.sqrt(((local - middle) ** 2).sum(axis=1)).max()), 1e-3)
    focal = lens * max(size)
    away = radius / math.sin(math.atan(fill * 0.5 * min(size) / focal))
    rotation = view_axes(shot.view)
    position = axes @ (middle + away * rotation[2])
    centre = 0.5 * np.array([size[0] - 1.0, size[1] - 1.0])
    return Camera(position, rotation @ axes.T, focal, centre, *size)


def distance_to(camera: Camera, points: Floats) -> float:
    """Distance in front of the camera of the middle of some points [m]."""
    _, depth = camera.project(points)
    return float(0.5 * (depth.min() + depth.max()))

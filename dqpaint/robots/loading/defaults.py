"""An arm without a canvas or home posture -> defaults for both."""

import numpy as np

from dqpaint import dq
from dqpaint.dq import Floats
from dqpaint.errors import DqpaintError
from dqpaint.robots.kinematics.differential_ik import tool_jacobian_map
from dqpaint.robots.kinematics.kinematics import Kinematics
from dqpaint.robots.kinematics.start_posture import NoPosture, find_start, solve_posture
from dqpaint.robots.model.card import Canvas, Card

SAMPLES = 20000  # random postures
RANK_SAMPLES, LEAST_SINGULAR_VALUE = 256, 1e-6  # of these, at one of which it moves all ways
LEAST_REACH = 0.01  # [m] of a light about the middle of its places
SEEDS = 8  # of them, the nearest to each place
AHEAD_SHARES = (0.65, 0.5, 0.8, 0.35)  # where a canvas may be, in parts of the arm's reach
AZIMUTHS = (0.0, 90.0, -90.0, 180.0)  # [deg] of the canvas, tried in this order
HEIGHT_SHARES = (0.0, 0.2, -0.2, 0.4, -0.4)
MOST_TRIED = 6  # positions whose surroundings are checked
RANGE_SHARE = 0.8  # of each joint's range
AMPLE_MARGIN = np.radians(30)  # margin that is as good as any
AMPLE_SINGULAR_VALUE = 0.15  # and singular value
CANVAS_HALF_SIZE = 0.1  # [m] to be reached around the canvas, or a sixth of the arm's reach
GOOD_CLEARANCE = 0.6  # room, of 1, that a canvas should leave all around
ORDER_PENALTY = 0.02  # for each place further down in AHEAD and ABOVE
SEED = 1873


def find_canvas(card: Card) -> tuple[Canvas, Floats]:
    """A canvas that faces along x, and the posture (n,) [rad] with the tool on it.

    Of a few positions in front of the arm, else beside or behind it, the one farthest from its
    joint limits and to its singularities; the same arm always gets the same one.

    Raises:
        DqpaintError: it reaches none of them.
    """
    arm = Kinematics(card)
    rng = np.random.default_rng(SEED)
    low, high = _one_turn(card)
    middle, half = 0.5 * (low + high), 0.5 * RANGE_SHARE * (high - low)
    q = rng.uniform(middle - half, middle + half, (SAMPLES, card.joints))
    poses = arm.screws().pose(q)
    least = np.linalg.svd(arm.poses_and_jacobians(q[:RANK_SAMPLES])[1], compute_uv=False)[..., -1]
    if least.max() < LEAST_SINGULAR_VALUE:
        raise DqpaintError(
            f"{card.name} cannot place and turn a light as it is asked to: in no posture do its "
            "axes move it in all six ways"
        )
    points = dq.translation(poses)
    centre = points.mean(axis=0)
    reach = float(np.linalg.norm(points - centre, axis=1).max())
    if reach < LEAST_REACH:
        raise DqpaintError(
            f"{card.name} moves a light by no more than {reach * 1e3:.2g} mm: see its joint limits"
        )
    facing = dq.rotation(_canvas(np.zeros(3)).pose)
    turned = 2 * np.arccos(np.minimum(1.0, np.abs((dq.rotation(poses) * facing).sum(-1))))
    for azimuth in np.radians(AZIMUTHS):
        way = np.array([np.cos(azimuth), np.sin(azimuth), 0])
        found = []
        for i, ahead in enumerate(AHEAD_SHARES):
            for j, above in enumerate(HEIGHT_SHARES):
                place = np.round(centre + reach * (ahead * way + [0, 0, above]), 2)
                far = np.linalg.norm(points - place, axis=1) / reach + turned / np.pi
                seeds = q[np.argsort(far)[:SEEDS]]
                room = _clearance_at(arm, dq.pose_from(place, facing), seeds) - ORDER_PENALTY * (
                    i + j
                )
                found.append((room, _canvas(place)))
        found.sort(key=lambda pair: -pair[0])
        canvas = _first_with_clearance(
            arm, [canvas for _, canvas in found[:MOST_TRIED]], min(CANVAS_HALF_SIZE, reach / 6)
        )
        if canvas is not None:
            return canvas, find_home(card, canvas)
    raise DqpaintError(
        f"no place for a canvas was found around {card.name}: define [canvas] in a .toml file"
    )


def _first_with_clearance(
    arm: Kinematics, canvases: list[Canvas], half_size: float
) -> Canvas | None:
    """The first canvas with good clearance around it, else the one with the most."""
    best, most = None, 0.0
    for canvas in canvases:
        room = _clearance_around(arm, canvas, half_size)
        if room > most:
            best, most = canvas, room
        if room > GOOD_CLEARANCE:
            break
    return best


def find_home(card: Card, canvas: Canvas) -> Floats:
    """The posture (n,) [rad] with the tool on a canvas and the largest margin to the joint limits.

    Raises:
        DqpaintError: the arm does not reach it.
    """
    found = find_start(Kinematics(card), canvas.pose[None], np.zeros(1))
    if isinstance(found, NoPosture):
        raise DqpaintError(
            f"{card.name} cannot reach its canvas: it stays {found.shortfall * 1e3:.0f} mm away"
        )
    return np.clip(np.radians(np.round(np.degrees(found.posture), 1)), card.lower, card.upper)


def canvas_at(card: Card) -> Canvas:
    """The canvas at the tool of the home posture, with the tool's orientation."""
    T = dq.matrix_from_pose(Kinematics(card).pose(card.home))
    at, right, up = (tuple(T[:3, i].tolist()) for i in (3, 0, 1))
    return Canvas(at_m=at, right=right, up=up)


def _canvas(place: Floats) -> Canvas:
    x, y, z = place.tolist()
    return Canvas(at_m=(x, y, z), right=(0, 1, 0), up=(0, 0, 1))


def _one_turn(card: Card) -> tuple[Floats, Floats]:
    """A range of at most one turn (n,) per joint [rad], around zero if possible."""
    low, high = np.maximum(card.lower, -np.pi), np.minimum(card.upper, np.pi)
    middle = 0.5 * (card.lower + card.upper)
    half = np.minimum(0.5 * (card.upper - card.lower), np.pi)
    far = high - low < half
    return np.where(far, middle - half, low), np.where(far, middle + half, high)


def _clearance(arm: Kinematics, postures: Floats) -> Floats:
    """Distance of postures (M, n) from limits and singularities: 1 is ample, negative is beyond."""
    card = arm.card
    margin = np.minimum(postures - card.lower, card.upper - postures).min(axis=-1)
    poses, jacobians = arm.poses_and_jacobians(postures)
    shifted = tool_jacobian_map(dq.translation(poses)) @ jacobians
    least = np.linalg.svd(shifted, compute_uv=False).min(axis=-1)
    return np.asarray(
        np.minimum(1.0, np.minimum(margin / AMPLE_MARGIN, least / AMPLE_SINGULAR_VALUE))
    )


def _clearance_at(arm: Kinematics, pose: Floats, seeds: Floats) -> float:
    """The best clearance for a pose (8,), from seeds (M, n); negative if it is not reached."""
    within = (arm.card.lower, arm.card.upper)
    postures, errors = solve_posture(arm, pose, seeds, np.zeros_like(seeds), 1e-9, within)
    return float(np.where(errors < 1e-6, _clearance(arm, postures), -1.0).max())


def _clearance_around(arm: Kinematics, canvas: Canvas, half_size: float) -> float:
    """The least clearance on a path around a canvas; negative if it is not reachable."""
    corners = half_size * np.array(
        [[0, 0, 0], [1, 1, 0], [-1, 1, 0.5], [-1, -1, -0.5], [1, -1, 0], [1, 1, 0]], dtype=float
    )
    local = dq.pose_from(corners, np.array([1.0, 0, 0, 0]))
    seconds = np.arange(len(corners), dtype=np.float64)
    found = find_start(arm, dq.mul(canvas.pose, local), 3.0 * seconds)
    if isinstance(found, NoPosture):
        return -1.0
    return min(found.margin / float(AMPLE_MARGIN), float(_clearance(arm, found.posture[None])[0]))

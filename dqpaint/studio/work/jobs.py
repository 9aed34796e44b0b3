"""A request -> its answers, in a worker: a reading with its sketch, or a forecast and runs."""

import signal
import time
from collections.abc import Callable, Iterator, Sequence
from dataclasses import replace
from multiprocessing.connection import Connection
from pathlib import Path

import cv2
import numpy as np
from numpy.typing import NDArray

from dqpaint import dq
from dqpaint.diagnostics import Severity, Span, locate
from dqpaint.dq import Floats
from dqpaint.editors import analysis
from dqpaint.errors import DqpaintError
from dqpaint.language import Diagnostic, Program, ScriptError, parse
from dqpaint.light.camera import Camera
from dqpaint.metrics import all_figures
from dqpaint.motion import Motion, summary_line
from dqpaint.painting import paint, preview, video
from dqpaint.robots.kinematics import Clamp
from dqpaint.settings import Settings, make_settings
from dqpaint.studio.work.confinement import confine
from dqpaint.studio.work.mesh_files import stl
from dqpaint.studio.work.messages import (
    Answer,
    ArmShapes,
    Curve,
    Failure,
    Figure,
    Finding,
    Forecast,
    Frame,
    Progress,
    Reading,
    Request,
    Run,
    RunPage,
    Shown,
    Tier,
    Verdict,
    Want,
)

MOST_PATH_POINTS = 1500  # of a path on the page
MOST_CURVE_POINTS = 800
MOST_FRAMES = 150
FRAME_RATE = 25  # frames a second of the drawing's time, where that is fewer
JPEG = [cv2.IMWRITE_JPEG_QUALITY, 88]
PROGRESS_INTERVAL = 0.1  # [s]
SEEDS = 5
SPREAD = "posture,place"
DEGREES = float(np.degrees(1.0))
CURVES: tuple[tuple[str, str, float, dict[str, str]], ...] = (
    ("position error", "mm", 1e3, {"position_error_m": "distance"}),
    ("orientation error", "deg", DEGREES, {"orientation_error_rad": "angle"}),
    ("twist error", "rad/s, m/s", 1.0, {
        **{f"twist_error_w{axis}_rad_s": f"w{axis}" for axis in "xyz"},
        **{f"twist_error_v{axis}_m_s": f"v{axis}" for axis in "xyz"},
    }),
    ("position", "mm", 1e3, {
        **{f"{axis}_m": axis for axis in "xyz"},
        **{f"desired_{axis}_m": f"{axis} asked" for axis in "xyz"},
    }),
    ("what the law sees", "mm", 1e3, {
        **{f"believed_{axis}_m": f"{axis} measured" for axis in "xyz"},
    }),
    ("joint angles", "deg", DEGREES, {"q{}_rad": "joint {}"}),
    ("joint rates", "deg/s", DEGREES, {"command{}_rad_s": "joint {}"}),
    ("torques", "Nm", 1.0, {"torque{}_Nm": "joint {}"}),
    ("motor torques", "Nm", 1.0, {"motor{}_Nm": "joint {}"}),
)  # fmt: skip
SHOWN_FIGURES = (
    "position_error_rms_m", "position_error_max_m", "orientation_error_rms_rad",
    "orientation_error_max_rad", "error_integral", "command_integral_rad", "torque_integral_Nm_s",
    "effort_integral", "speed_integral_m", "clipped_share",
)  # fmt: skip


class _StoppedError(Exception):
    """A newer request has come."""


class _Job:
    """One request at work: sends answers, and ends where it was told to stop."""

    def __init__(self, number: int, pipe: Connection) -> None:
        self.number = number
        self._pipe = pipe
        self._last = 0.0

    def send(self, answer: Answer | None) -> None:
        """Send an answer; raises _StoppedError where nobody waits for it."""
        self.check()
        self._pipe.send((self.number, answer))

    def check(self) -> None:
        """Raise _StoppedError where the page asks for something else."""
        while self._pipe.poll():
            number, request = self._pipe.recv()
            if request is None and number == self.number:
                raise _StoppedError

    def progress(self, tier: Tier) -> Callable[[float], None]:
        """A function for how far a run is."""

        def show(share: float) -> None:
            now = time.monotonic()
            if now - self._last > PROGRESS_INTERVAL:
                self._last = now
                self.send(Progress(tier, share))
            else:
                self.check()

        return show


def serve(kind: str, pipe: Connection, folders: Sequence[Path]) -> None:
    """Answer requests until the other end closes."""
    signal.signal(signal.SIGINT, signal.SIG_IGN)  # Ctrl-C is the server's
    cv2.setNumThreads(1)
    _warm(kind)
    confine(folders)
    while True:
        try:
            number, request = pipe.recv()
        except (EOFError, OSError):
            return
        if request is None:  # of a job that is over
            continue
        job = _Job(number, pipe)
        try:
            WORK[request.want](job, request)
        except _StoppedError:
            pass
        except MemoryError:
            job.send(Failure("physics", "there is not enough memory for that"))
        pipe.send((number, None))


def _warm(kind: str) -> None:
    """Do once what is slow the first time."""
    from dqpaint.core import find_drawing
    from dqpaint.language import read

    settings = make_settings(size=(64, 36))
    preview.make_preview(read(find_drawing("star")), settings)
    if kind == "run":
        from dqpaint.robots.kinematics import make_kinematics
        from dqpaint.robots.loading import find_card

        make_kinematics(find_card("iiwa"), "pinocchio")


def _read(job: _Job, request: Request) -> None:
    """The diagnostics of a text, then its reference picture."""
    try:
        program = parse(request.text, request.path, Path(request.path))
        shown = preview.make_preview(program, _settings(request))
    except ScriptError as problem:
        job.send(Reading(_findings(problem.diagnostics, problem.text, request.text)))
        return
    except DqpaintError as problem:
        job.send(Reading((), fault=str(problem)))
        return
    motion = shown.motion
    figures = analysis.line_figures(motion)
    lines = {line: str(one) for line, one in figures.items()}
    job.send(Reading(_findings(motion.notes, program.text, request.text), lines))
    job.send(_shown(shown))


def _settings(request: Request, **more: object) -> Settings:
    from dqpaint.painting import validate

    size = (request.width, request.height)
    chosen = make_settings(**{**request.choices, "size": size, **more})
    validate.check_settings(chosen)
    return chosen


def _findings(found: Sequence[Diagnostic], source: str, text: str) -> tuple[Finding, ...]:
    return tuple(_finding(one, source, len(text)) for one in found)


def _finding(found: Diagnostic, source: str, size: int) -> Finding:
    here = found.span is None or found.span.start <= size
    span = found.span if found.span is not None and here else Span(0, 0)
    fix = found.fix
    return Finding(
        found.code,
        found.severity is Severity.ERROR,
        locate(source, span.start).line,
        span.start,
        min(span.end, size),
        found.message + (f" ({found.label})" if found.label else ""),
        found.help,
        None
        if fix is None or fix.span.end > size
        else (fix.title, fix.span.start, fix.span.end, fix.text),
        here,
    )


def _rows(count: int, most: int) -> NDArray[np.int64]:
    """At most so many of a number of rows, evenly, with the first and last."""
    return np.unique(np.linspace(0, count - 1, min(count, most)).round().astype(np.int64))


def _lines(motion: Motion, rows: NDArray[np.int64]) -> NDArray[np.int64]:
    """The lines of some rows; 0 where they are of an included file."""
    source = motion.source
    return np.where(source.file[rows] == 0, source.line[rows], 0)


def _shown(shown: preview.Preview) -> Shown:
    motion, picture = shown.motion, shown.picture
    rows = _rows(len(motion.t), MOST_PATH_POINTS)
    points = motion.points[rows]
    return Shown(
        _jpeg(picture.image), motion.t[rows], _lines(motion, rows),
        _pixels(picture.camera, points), points, motion.light[rows], summary_line(motion),
    )  # fmt: skip


def _pixels(camera: Camera, points: Floats) -> Floats:
    return np.asarray(camera.project(points)[0])


def _jpeg(image: NDArray[np.uint8]) -> bytes:
    return _encoded(".jpg", image, JPEG)


def _png(image: NDArray[np.uint8]) -> bytes:
    return _encoded(".png", image, [cv2.IMWRITE_PNG_COMPRESSION, 1])


def _encoded(ending: str, image: NDArray[np.uint8], how: Sequence[int]) -> bytes:
    done, data = cv2.imencode(ending, np.ascontiguousarray(image[..., ::-1]), how)
    if not done:
        raise DqpaintError(f"a picture could not be encoded as {ending}")
    return data.tobytes()


def _run(job: _Job, request: Request) -> None:
    """A forecast, the run on the ideal arm, the one with physics, and the growing picture."""
    tier: Tier = "ideal"
    try:
        program = parse(request.text, request.path, Path(request.path))
        settings = _settings(request)
        job.send(_forecast(program, request, settings))
        last: paint.Painting | None = None
        for tier, chosen in _tiers(request, settings):
            last = _paint(job, program, tier, chosen)
        if last is not None:
            _send_frames(job, last)
    except ScriptError as problem:
        found = _findings(problem.diagnostics, problem.text, request.text)
        if found:
            job.send(Forecast(found, ""))
        job.send(Failure(tier, problem.diagnostics[0].message if found else str(problem)))
    except DqpaintError as problem:
        job.send(Failure(tier, str(problem)))


def _tiers(request: Request, settings: Settings) -> Iterator[tuple[Tier, Settings]]:
    """The settings of each run; a law of torques has no ideal arm."""
    from dqpaint.controllers import find_controller

    ideal = settings.plant is not None and settings.plant.partition(":")[0] == "ideal"
    if not ideal and not find_controller(settings.controller).drives_torque:
        yield "ideal", _settings(request, plant="ideal", disturb={})
    yield "ideal" if ideal else "physics", settings


def _forecast(program: Program, request: Request, settings: Settings) -> Forecast:
    from dqpaint.planning import forecast_report
    from dqpaint.robots.kinematics import make_kinematics
    from dqpaint.robots.loading import card_for

    card = card_for(program, settings.robot, settings.tool)
    kinematics = make_kinematics(card, settings.kinematics)
    report = forecast_report.make_report(program, kinematics, settings)
    return Forecast(_findings(report.warnings, program.text, request.text), report.text.strip())


def _paint(job: _Job, program: Program, tier: Tier, settings: Settings) -> paint.Painting:
    begin = time.perf_counter()
    painting = paint.paint(program, settings, job.progress(tier))
    seconds = time.perf_counter() - begin
    motion = painting.motion
    frames = _frame_rows(painting)
    shapes, links = _arm(painting, frames)
    if shapes is not None:
        job.send(shapes)
    rows = _rows(len(motion.t), MOST_CURVE_POINTS)
    job.send(
        Run(
            tier,
            f"{painting.controller.name} on {painting.robot}, {painting.plant}",
            _png(painting.picture.image),
            _figures(painting),
            tuple(fault.says for fault in painting.judgement.faults),
            _notes(painting),
            painting.arm_motion.robot,
            motion.t[rows],
            _lines(motion, rows),
            painting.track.points[rows],
            _curves(painting, rows),
            motion.t[frames],
            links,
            seconds,
        )
    )
    return painting


def _figures(painting: paint.Painting) -> tuple[Figure, ...]:
    known, measured = all_figures(), painting.metrics.figures
    return tuple(
        Figure(name, known[name].title, measured[name] * known[name].scale,
               known[name].display_unit)
        for name in SHOWN_FIGURES
        if measured.get(name) is not None
    )  # fmt: skip


def _notes(painting: paint.Painting) -> tuple[str, ...]:
    limits = [f"limit: {one}" for one in dict.fromkeys(map(_limit, painting.limits))]
    idle = [f"{name} was without effect: {why}" for name, why in painting.without_effect.items()]
    remarks = [text for picture in painting.pictures for text in picture.remarks]
    return (*limits, *idle, *remarks, *painting.notes)


def _limit(clamp: Clamp) -> str:
    return f"{clamp.kind} of joint {clamp.joint} from {clamp.start:.2f} s on"


def _curves(painting: paint.Painting, rows: NDArray[np.int64]) -> tuple[Curve, ...]:
    """What a run shows over time, with the arm's limits."""
    card = painting.law_model.card
    known = {
        "joint angles": np.degrees(np.maximum(card.upper, -card.lower)),
        "joint rates": np.degrees(card.speed),
        "torques": card.effort,
        "motor torques": card.effort,
    }
    found = []
    for title, unit, scale, names in CURVES:
        columns = {
            name.format(joint): label.format(joint)
            for name, label in names.items()
            for joint in (range(1, card.joints + 1) if "{}" in name else (0,))
            if name.format(joint) in painting.table
        }
        if columns:
            values = [scale * np.asarray(painting.table[one], float)[rows] for one in columns]
            labels = tuple(columns.values())
            found.append(Curve(title, unit, labels, np.stack(values, 1), known.get(title)))
    return tuple(found)


def _frame_rows(painting: paint.Painting) -> NDArray[np.int64]:
    """The rows of the growing picture's frames; the last is the last of the run."""
    motion = painting.motion
    count = int(min(MOST_FRAMES, max(2, round(motion.t[-1] * FRAME_RATE))))
    steps = len(motion.t) - 1
    return np.array([steps * i // (count - 1) for i in range(count)], np.int64)


def _send_frames(job: _Job, painting: paint.Painting) -> None:
    """Each frame adds the light since the one before."""
    count = len(_frame_rows(painting))
    frames = video.frames(
        painting.scene, painting.picture, painting.settings, count, lambda _done: None
    )
    for index, image in enumerate(frames, 1):
        job.send(Frame(index, _jpeg(image)))


_sent: set[str] = set()  # arms whose shapes the server has


def _arm(painting: paint.Painting, frames: NDArray[np.int64]) -> tuple[ArmShapes | None, Floats]:
    """The shapes of the arm, once, and their places at the frames."""
    from dqpaint.render import arm_view

    name = painting.arm_motion.robot
    shown = arm_view(name)
    poses = shown.places(painting.track.posture[frames])
    found = np.concatenate([dq.translation(poses), dq.rotation(poses)], axis=-1)
    if name in _sent:
        return None, found
    _sent.add(name)
    return ArmShapes(name, tuple((stl(one.corners), one.colour) for one in shown.meshes)), found


def _make_page(job: _Job, request: Request) -> None:
    """The run as a page in 3-D."""
    from dqpaint.outputs import registry

    try:
        writers = registry.choose_writers("scene")
        program = parse(request.text, request.path, Path(request.path))
        painting = paint.paint(
            program, _settings(request), job.progress("physics"), None,
            lambda ready: registry.check_before_run(writers, ready),
        )  # fmt: skip
        (html,) = registry.make_files(writers, painting).values()
        job.send(RunPage(html))
    except DqpaintError as problem:
        job.send(Failure("physics", str(problem)))


def _judge(job: _Job, request: Request) -> None:
    """Both runs with several seeds: is their difference more than their spread?"""
    from dqpaint.studies.experiment import paired_verdict

    assert request.other is not None
    text, choices = request.other
    both = (request, replace(request, text=text, choices=choices))
    found: list[list[float]] = [[], []]
    try:
        for seed in range(SEEDS):
            for values, one in zip(found, both, strict=True):
                job.send(Progress("physics", (seed + (one is not request) / 2) / SEEDS))
                values.append(_measured(job, one, seed))
    except DqpaintError as problem:
        job.send(Failure("physics", str(problem)))
        return
    job.send(Verdict(paired_verdict(found[0], found[1], "mm")))


def _measured(job: _Job, request: Request, seed: int) -> float:
    """The position error of a run with a seed, start posture and place by chance [mm]."""
    spread = request.choices.get("spread") or SPREAD
    settings = _settings(request, seed=seed, spread=spread)
    program = parse(request.text, request.path, Path(request.path))
    ready = paint.prepare(program, settings)
    run = paint.finish(ready, ready.run(lambda _share: job.check()), photographed=False)
    if not run.judgement.is_result:
        raise DqpaintError(
            f"with seed {seed} {run.controller.name} is no result: {run.judgement.faults[0].says}"
        )
    return run.metrics.figures["position_error_rms_m"] * 1e3


WORK: dict[Want, Callable[[_Job, Request], None]] = {
    "picture": _read,
    "run": _run,
    "page": _make_page,
    "verdict": _judge,
}

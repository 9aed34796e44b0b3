"""Program and settings -> Painting: prepare, simulate, measure, expose, develop."""

import hashlib
from collections.abc import Callable, Iterator, Mapping
from contextlib import AbstractContextManager, contextmanager
from dataclasses import dataclass, field, replace
from functools import cached_property, partial
from pathlib import Path
from time import perf_counter
from typing import Any

from dqpaint import dq
from dqpaint.controllers import Controller
from dqpaint.core import Library, log
from dqpaint.disturbances import Disturbance
from dqpaint.dq import Floats
from dqpaint.light.film import Film
from dqpaint.light.inverse import Likeness
from dqpaint.light.sources import sweeps
from dqpaint.metrics import (
    METRICS,
    Attenuation,
    Judgement,
    Metrics,
    StepResponse,
    Table,
    attenuation,
    judge,
    measure,
    step_responses,
)
from dqpaint.motion import Motion
from dqpaint.painting.memory import check_run_memory
from dqpaint.painting.photos.photo_light import LitPhoto, likeness_reached, solve_photos
from dqpaint.painting.picture import Picture, PictureSet, photograph
from dqpaint.painting.scene import Scene, make_scene
from dqpaint.painting.time_limit import limit_time
from dqpaint.painting.validate import RunChoices, check_run
from dqpaint.planning import corner_limits, prepared_motion, reachability
from dqpaint.planning import placement as place
from dqpaint.planning import retiming as retime
from dqpaint.plants import Engine
from dqpaint.program import Program
from dqpaint.render import ArmMotion, SceneArm, scene_arm_of_run
from dqpaint.robots.kinematics import Clamp, Kinematics, make_kinematics
from dqpaint.robots.loading import card_for, find_card
from dqpaint.robots.model import DEFAULT_ROBOT
from dqpaint.robots.resolvers import resolver_of, task_of
from dqpaint.settings import Settings
from dqpaint.simulation import (
    Recording,
    Track,
    corrected,
    has_effect,
    law_model,
    read_learned,
    read_recording,
    replay,
    track,
)

SOLVING = 0.3  # share of the progress that the light of photographs takes
NO_JOINTS_NOTE = "a recording of poses has no joints: the arm and its occlusion are left out"


@dataclass(frozen=True, repr=False)
class Painting(PictureSet):
    """A finished painting: reference, run, pictures and metrics."""

    settings: Settings
    controller: Controller[Any]
    robot: str
    plant: str
    plant_values: dict[str, Any]  # with values derived from them for this arm
    disturbances: dict[str, Disturbance]
    gains: dict[str, Any]  # all of the law's, and values derived from them
    law_model: Kinematics  # the law's model of the arm, with its errors
    motion: Motion
    track: Track
    metrics: Metrics
    judgement: Judgement  # whether the run is a result
    attenuation: dict[str, Attenuation]  # of an unmodelled twist, in rotation and translation
    step_responses: tuple[StepResponse, ...]
    scene: Scene
    arm_motion: ArmMotion
    pictures: tuple[Picture, ...]  # one a view
    retiming: retime.Retiming | None = None  # where the drawing's clock may slow down
    corners: corner_limits.CornerPace | None = None  # where the arm can do less than is allowed
    seconds: dict[str, float] = field(default_factory=dict)  # wall time of each stage [s]
    notes: tuple[str, ...] = ()  # assumptions about the arm
    placement: place.Placement | None = None  # where `place auto` put the drawing
    recording: Recording | None = None  # the recorded run, if none was simulated
    without_effect: dict[str, str] = field(default_factory=dict)  # disturbances, and why
    engine: Engine | None = None  # of physics, if one moved the arm
    photos: tuple[LitPhoto, ...] = ()  # what is expected of photographs, before the run
    reached: tuple[Likeness, ...] = ()  # how like they are on the path that was reached
    relit: tuple[LitPhoto, ...] = ()  # and with light that was solved again for that path

    @property
    def resolver(self) -> str:
        """What turned the law's twist into joint rates, as text."""
        return resolver_of(self.settings, self.motion.program)

    @property
    def film(self) -> Film:
        """The linear film the picture was developed from."""
        return self.picture.film

    @property
    def table(self) -> Table:
        """The columns of the CSV, each (N,)."""
        return self.metrics.table

    def to_frame(self) -> Any:
        """The table as a pandas DataFrame, a row a sample; `table` has the same without pandas.

        Raises:
            UsageError: pandas is not installed.
        """
        return Library("pandas", "pandas").DataFrame(self.table)

    @property
    def sha256(self) -> str:
        """Of the drawing's text."""
        return hashlib.sha256(self.motion.program.text.encode()).hexdigest()

    @property
    def limits(self) -> tuple[Clamp, ...]:
        """Every limit that clipped a joint."""
        return self.track.clamps

    def scene_arm(self) -> AbstractContextManager[SceneArm | None]:
        """The arm as it moved, if the settings show it or let it hide light."""
        return scene_arm_of_run(self.settings, find_card(self.arm_motion.robot), self.arm_motion)

    def __repr__(self) -> str:
        name, rms = self.motion.program.name, self.metrics.figures["position_error_rms_m"]
        return (
            f"<Painting of {name} by {self.controller.name} on {self.robot}: "
            f"{self.motion.t[-1]:.2f} s, rms {rms * 1e3:.3g} mm>"
        )


def paint(
    program: Program,
    settings: Settings,
    progress: Callable[[float], None] = lambda _done: None,
    controller: Controller[Any] | None = None,
    check: Callable[["PreparedRun"], None] = lambda _ready: None,
) -> Painting:
    """Paint a drawing with a simulated arm.

    Args:
        program: from `dqpaint.language`.
        settings: everything besides the text.
        progress: called while the arm moves, with the part done, 0 to 1.
        controller: a law in place of the one that the settings name.
        check: called before the run, to refuse it.

    Raises:
        UsageError: an unknown robot, plant, controller, gain or view.
        ScriptError: the drawing has no schedule or leaves the arm's reach.
        DqpaintError: the simulation diverged, or the picture would be black.
        TimeLimitError: it takes longer than the settings allow.
    """
    with limit_time(settings.timeout) as check_time:

        def show(done: float) -> None:
            check_time()
            progress(done)

        part = SOLVING if program.photos else 0.0
        ready = prepare(program, settings, controller, lambda done: show(part * done))
        check(ready)
        with ready.stopwatch("arm"):
            run = ready.run(lambda done: show(part + (1.0 - part) * done))
        return finish(ready, run)


@dataclass(frozen=True)
class PreparedRun:
    """A drawing and everything that its run needs, checked."""

    settings: Settings
    stopwatch: "Stopwatch"
    choices: RunChoices
    kinematics: Kinematics
    prepared: prepared_motion.PreparedMotion
    recording: Recording | None
    photos: tuple[LitPhoto, ...] = ()

    @property
    def motion(self) -> Motion:
        """The motion that the arm follows."""
        return self.prepared.motion

    @cached_property
    def followed(self) -> Motion:
        """The reference that the law is given: the motion, along a learned path if there is one."""
        if self.settings.learned is None:
            return self.motion
        return corrected(self.motion, read_learned(self.settings.learned, self.motion.t))

    def beside_drawing(self, run: Track) -> Track:
        """A run along what was followed, beside what the drawing asks."""
        return run if run.motion is self.motion else replace(run, motion=self.motion)

    @property
    def resolver(self) -> str:
        """What turns twists into joint rates, as text."""
        return resolver_of(self.settings, self.motion.program)

    @property
    def swinging(self) -> tuple[str, ...]:
        """The disturbances that may go to and fro in time."""
        return tuple(name for name, one in self.choices.disturbances.items() if one.may_swing)

    def run(self, progress: Callable[[float], None] = lambda _done: None) -> Track:
        """The run."""
        if self.recording is not None:
            return replay(self.recording, self.motion, self.kinematics)
        run = self._track(self.choices.disturbances, progress)
        reachability.check_largest_error(run, self.kinematics, self.settings.null)
        return run

    def without_effect(self, run: Track) -> dict[str, str]:
        """The disturbances that did not move the tool in a run, and why, each left out in turn."""
        if self.recording is not None:
            return {}
        given = self.choices.disturbances
        found = {}
        for name in given:
            others = {other: one for other, one in given.items() if other != name}
            if not has_effect(run, partial(self._track, others, lambda _done: None)):
                found[name] = self.choices.plant.why_without_effect(given[name].needs)
        return found

    def _track(
        self,
        disturbances: Mapping[str, Disturbance],
        progress: Callable[[float], None],
        watch: Callable[[int, Floats], None] = lambda _row, _pose: None,
    ) -> Track:
        settings, chosen = self.settings, self.choices
        run = track(
            self.followed, self.kinematics, self.prepared.start, chosen.plant,
            chosen.controller, chosen.gains, progress, disturbances, settings.seed,
            settings.null, settings.on_limit == "stop", self.resolver, watch,
        )  # fmt: skip
        return self.beside_drawing(run)


def prepare(
    program: Program,
    settings: Settings,
    controller: Controller[Any] | None = None,
    solving: Callable[[float], None] = lambda _done: None,
) -> PreparedRun:
    """The preparation of a run; arguments and errors as those of `paint`.

    `solving` is called while the light of photographs is solved for, with the part done.
    """
    clock = Stopwatch()
    program = replace(program, most_samples=settings.max_samples)
    # faults are reported before anything is simulated
    choices = check_run(settings, controller, Path(program.name).parent)
    card = card_for(program, settings.robot, settings.tool)
    with clock("place"):
        kinematics = make_kinematics(card, settings.kinematics, task_of(settings, program))
    recorded, names = settings.recorded, tuple(kinematics.model.names)[1:]
    recording = None if recorded is None else read_recording(recorded, names)
    motor_torque_use = choices.plant.motor_torque_use
    ready = prepared_motion.prepare_motion(program, kinematics, settings, motor_torque_use, clock)
    motion = ready.motion
    check_run_memory(sweeps(motion, motion.pose, motion.light, settings), settings)
    with clock("photos"):
        motion, photos = solve_photos(ready.motion, settings, solving)
    ready = replace(ready, motion=motion)
    return PreparedRun(settings, clock, choices, kinematics, ready, recording, photos)


def finish(ready: PreparedRun, run: Track, photographed: bool = True) -> Painting:
    """The metrics and, if it is photographed, the pictures of a run."""
    settings, motion, clock = ready.settings, ready.motion, ready.stopwatch
    chosen = ready.choices
    card, recording = ready.kinematics.card, ready.recording
    notes = ready.kinematics.notes
    notes += recording.notes(motion) if recording else chosen.plant.notes(card)
    with clock("effects"):
        idle = ready.without_effect(run)
    with clock("metrics"):
        metrics = measure(run)
        notes += tuple(METRICS.faults)
        gains = chosen.gains
        came_through = attenuation(
            run, gains.disturbance_bounds(), gains.bounded_in_steps,
            chosen.plant.motor_torque_use == "smooth", gains.first.error_point,
            None if gains.knots else gains.first.gammas,
        )  # fmt: skip
        steps = step_responses(run)
        judgement = judge(run, ready.swinging)
    robot = settings.robot or motion.program.robot or DEFAULT_ROBOT
    middle = 0.5 * (motion.points.max(axis=0) + motion.points.min(axis=0))
    given = motion.program.walls
    scenery = (given, motion.canvas, middle) if given else None
    cast = ArmMotion(robot, run.posture, motion.source, motion.period, scenery)
    if settings.staged and not cast.has_joints:
        notes += (NO_JOINTS_NOTE,)
    with clock("light"), scene_arm_of_run(settings, card, cast) as staging:
        reached = likeness_reached(motion, settings, dq.translation(run.pose))
        relit: tuple[LitPhoto, ...] = ()
        if settings.relight:
            lit, relit = solve_photos(motion, settings, reached=dq.translation(run.pose))
            motion = lit
        scene = make_scene(motion, run.pose, settings, metrics.table)
        pictures = tuple(photograph(scene, settings, staging)) if photographed else ()
    return Painting(
        settings, chosen.controller, card.name,
        "recorded" if recording else chosen.plant.name,
        {} if recording else chosen.plant.summary(card),
        chosen.disturbances, chosen.gains.as_dict(),
        law_model(ready.kinematics, chosen.disturbances, settings.seed),
        motion, run, metrics, judgement, came_through, steps,
        scene, cast, pictures, ready.prepared.retiming, ready.prepared.corners,
        clock.seconds, notes,
        ready.prepared.placement, recording, idle,
        None if recording else chosen.plant.engine_used, ready.photos, reached, relit,
    )  # fmt: skip


class Stopwatch:
    """Wall time of named stages [s]."""

    def __init__(self) -> None:
        self.seconds: dict[str, float] = {}

    @contextmanager
    def __call__(self, stage: str) -> Iterator[None]:
        """Time what happens inside."""
        begin = perf_counter()
        yield
        took = perf_counter() - begin
        self.seconds[stage] = self.seconds.get(stage, 0.0) + took
        log("painting", "%s took %.3f s", stage, took)

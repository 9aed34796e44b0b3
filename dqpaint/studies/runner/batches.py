"""Runs that differ in their seeds alone -> their results, computed as one batch in numpy.

Only runs on ideal arms go this way; fifty cost about as much as four by themselves. Which runs can
go together follows from the runs alone, and each result from its run alone, whatever else is in the
batch: so results are the same for any number of workers, and in a study that was stopped and goes
on.
"""

import json
import time
from collections.abc import Callable, Sequence
from dataclasses import replace
from pathlib import Path

from dqpaint.controllers import find_controller
from dqpaint.errors import DqpaintError
from dqpaint.metrics import judge, limits_text, measure
from dqpaint.painting import paint
from dqpaint.planning import reachability
from dqpaint.simulation import ModelsDifferError, Track, track_many
from dqpaint.studies.runner.run import OF_ALL, Result, Run, is_of_the_machine
from dqpaint.studies.runner.run_arrays import write_arrays

MOST = 64  # runs of a batch: what more would gain, memory takes

Task = tuple[str, Run]
"""The key of a run, and the run."""


def groups(tasks: Sequence[Task]) -> list[list[Task]]:
    """Tasks in the order in which the first of each group stands; most are by themselves."""
    found: dict[str, list[list[Task]]] = {}
    for key, run in tasks:
        same = _likeness(run) if goes_in_batches(run) else key
        mine = found.setdefault(same, [[]])
        if len(mine[-1]) == MOST:
            mine.append([])
        mine[-1].append((key, run))
    return [group for mine in found.values() for group in mine]


def goes_in_batches(run: Run) -> bool:
    """Whether a run is on an ideal arm, random, and by a law that can lead many arms at once."""
    settings = run.settings
    return bool(
        settings.plant == "ideal"
        and settings.disturb
        and settings.spread is None
        and settings.recorded is None
        and settings.on_limit != "stop"
        and _is_batched(settings.controller)
    )


def _is_batched(controller: str) -> bool:
    """Whether a law says so; what is wrong with one its run says by itself."""
    try:
        return find_controller(controller).batched
    except DqpaintError:
        return False


def _likeness(run: Run) -> str:
    """What all runs of a batch have in common."""
    alike = replace(run, settings=run.settings.model_copy(update={"seed": 0}), keep=())
    return json.dumps(alike.data, sort_keys=True)


def carry_out_batch(
    tasks: Sequence[Task], folder: Path, progress: Callable[[float], None] = lambda _done: None
) -> list[Result] | None:
    """The results of runs that differ in their seeds; None if they must go by themselves.

    Args:
        tasks: with their keys.
        folder: the study's, for arrays that are kept.
        progress: called while the arms move, with the part done, 0 to 1.
    """
    begin = time.perf_counter()
    first = tasks[0][1]
    ready = paint.prepare(first.program(), first.settings)
    chosen = ready.choices
    seeds = [run.settings.seed for _, run in tasks]
    try:
        tracks = track_many(
            ready.followed, ready.kinematics, ready.prepared.start, chosen.plant, chosen.controller,
            chosen.gains, chosen.disturbances, seeds, ready.settings.null, progress,
            ready.resolver,
        )  # fmt: skip
    except ModelsDifferError:
        return None
    if any(track is None for track in tracks):  # by itself each can say when it was lost
        return None
    results = []
    seen: set[int | None] = {None}  # rows of the motion that are known to be within reach
    for (key, run), track in zip(tasks, tracks, strict=True):
        assert track is not None
        mine = replace(ready, settings=run.settings)
        results.append(_result(key, run, mine, ready.beside_drawing(track), folder, seen))
    each = (time.perf_counter() - begin) / len(tasks)
    return [replace(result, wall=each) for result in results]


def _result(
    key: str, run: Run, ready: paint.PreparedRun, track: Track, folder: Path, seen: set[int | None]
) -> Result:
    """Figures of one track, and what is kept of it; pictures only where they are kept."""
    try:
        row = reachability.largest_error_row(track)
        if row is not None and row not in seen:
            reachability.check_row_reached(ready.motion, ready.kinematics, row, ready.settings.null)
            seen.add(row)
        if run.keep:
            painting = paint.finish(ready, track, photographed=not OF_ALL.issuperset(run.keep))
            write_arrays(painting, run.keep, folder, key)
            figures, idle = painting.metrics.figures, painting.without_effect
        else:
            figures, idle = measure(track).figures, ready.without_effect(track)
    except DqpaintError as problem:
        if is_of_the_machine(problem):
            raise  # each goes by itself then
        return Result(key, "failed", str(problem))
    found = judge(track, ready.swinging)
    return Result(key, found.status, found.why, figures, limits_text(track), idle)

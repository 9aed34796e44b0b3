"""A bag of ROS 2 messages -> the joints it records, in the arm's order, with their times."""

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from dqpaint.core import bags
from dqpaint.dq import Floats
from dqpaint.errors import DqpaintError

TOPIC = "/joint_states"
COMMANDS = "/dqpaint/command"
LARGEST_ANGLE = 1e4  # [rad]; more is a slip
LATEST = 1e8  # [s] after the first message
SHORTEST = 1000  # [ns] between two messages
MOST_NAMED = 8


class RecordedJoints(NamedTuple):
    """Times (M,) [s], angles (M, n) [rad], commands (M, n) or None, and what was assumed."""

    t: Floats
    postures: Floats
    commands: Floats | None
    torques: bool
    remarks: tuple[str, ...]


def read_bag(name: str, data: bytes, joints: Sequence[str]) -> RecordedJoints:
    """The joints of an arm in an MCAP file, from `/joint_states`, or the one topic of that type.

    Messages without all of the arm's joints, such as those of a gripper, are left out, and so are
    further joints. Times are those of the messages' headers, from the first on; of the log where
    the headers have none.

    Args:
        name: of the file.
        data: its bytes.
        joints: the arm's, by their names.

    Raises:
        UsageError: the library that reads bags is not installed.
        DqpaintError: the file is unsound, has no such topic, or not the joints of this arm.
    """
    topics, every = bags.read_topics(name, data, bags.JOINT_STATE)
    topics = {topic: one for topic, one in topics.items() if one.messages}
    others = [topic for topic in topics if topic != COMMANDS]
    topic = TOPIC if TOPIC in topics else others[0] if len(others) == 1 else None
    if topic is None:
        kind = "several topics" if others else "no message"
        raise DqpaintError(
            f"{name} has {kind} of type {bags.JOINT_STATE}, none on {TOPIC}; it has: "
            + (", ".join(every[:MOST_NAMED]) or "no topics")
        )
    times, angles, left_out = _column(name, topic, topics[topic], joints, "position")
    remarks = [f"{name}: {len(times)} messages of {topic}; t = 0 is the first"]
    if left_out:
        remarks.append(f"{name}: {left_out} messages lack joints of this arm and are left out")
    commands, torques = None, False
    if COMMANDS in topics:
        torques = bool(bags.joint_states(topics[COMMANDS].messages[0][1]).effort)
        field = "effort" if torques else "velocity"
        asked = _column(name, COMMANDS, topics[COMMANDS], joints, field)
        if np.array_equal(asked[0], times):
            commands = asked[1]
    return RecordedJoints((times - times[0]) * 1e-9, angles, commands, torques, tuple(remarks))


def _column(
    name: str, topic: str, messages: bags.Topic, joints: Sequence[str], field: str
) -> tuple[Floats, Floats, int]:
    """Times (M,) [ns] and one field (M, n) of the messages that have it, and how many have not."""
    stamps, logs, rows, left_out = [], [], [], 0
    for number, (log, body) in enumerate(messages.messages, 1):
        try:
            one = bags.joint_states(body)
        except bags.BagError as problem:
            raise DqpaintError(f"{name}, message {number} of {topic}: {problem}") from None
        values = dict(zip(one.names, getattr(one, field), strict=False))
        if not all(joint in values for joint in joints):
            left_out += 1
            continue
        rows.append([values[joint] for joint in joints])
        stamps.append(one.stamp)
        logs.append(log)
    if not rows:
        has = bags.joint_states(messages.messages[0][1]).names
        raise DqpaintError(
            f"{name}: no message of {topic} has the joints of this arm, {joints[0]} ... "
            f"{joints[-1]}; the first has: {', '.join(has[:MOST_NAMED]) or 'none'}; choose "
            "another arm with --robot"
        )
    angles = np.array(rows)
    wrong = ~(np.abs(angles) <= LARGEST_ANGLE).all(axis=1)
    if wrong.any():
        raise DqpaintError(
            f"{name}, {topic}: message {int(wrong.argmax()) + 1} with this arm's joints has a "
            f"{field} that is no number up to {LARGEST_ANGLE:g}"
        )
    times = _increasing(name, topic, stamps if any(stamps) else logs)
    return times, angles, left_out


def _increasing(name: str, topic: str, times: Sequence[int]) -> Floats:
    """Times (M,) [ns] since the first, of which each comes after the one before.

    Differences are those of whole numbers: a double holds a time since 1970 to 200 ns only.
    """
    since = np.array([time - times[0] for time in times], dtype=float)
    back = np.flatnonzero(np.diff(since) < SHORTEST)
    if len(back):
        first = int(back[0])
        raise DqpaintError(
            f"{name}, {topic}: message {first + 2} with this arm's joints, at "
            f"{since[first + 1] * 1e-9:.9g} s, does not come after the one before, at "
            f"{since[first] * 1e-9:.9g} s; are there two recorders or two arms in it?"
        )
    if since[-1] > LATEST * 1e9:
        raise DqpaintError(f"{name}, {topic}: goes on for {since[-1] * 1e-9:.3g} s")
    return since

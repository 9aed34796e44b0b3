"""A painting -> a bag: its run as ROS 2 messages in an MCAP file; `draw --recorded` reads it back.

Times count from the drawing's beginning, in headers and in the log. Poses and errors are in the
arm's base frame.
"""

from typing import TYPE_CHECKING

import numpy as np

from dqpaint import dq
from dqpaint.core import bags
from dqpaint.dq import Floats
from dqpaint.outputs.registry import Need, writer

if TYPE_CHECKING:
    from dqpaint.painting import paint

LIBRARY = Need("the extra dqpaint[bags]", lambda _run: bags.check_installed(), before=True)
POSE, TWIST = "geometry_msgs/msg/PoseStamped", "geometry_msgs/msg/TwistStamped"
COLOUR, IMAGE = "std_msgs/msg/ColorRGBA", "sensor_msgs/msg/CompressedImage"


@writer("bag", ".mcap", LIBRARY)
def bag(painting: "paint.Painting") -> bytes:
    """A bag (MCAP, ROS 2): joints, poses, command, error, light, picture."""
    from dqpaint.outputs.robot import kinematics_of

    run, motion = painting.track, painting.motion
    model = kinematics_of(painting).model
    joints, base = tuple(model.names)[1:], model.frames[1].name
    times = [round(t * bags.SECOND) for t in motion.t.tolist()]
    made = bags.BagWriter()
    tool, reference = _placements(run.pose), _placements(motion.pose)
    error = _errors(run.pose, motion.pose)
    light = np.column_stack([motion.light, np.ones(len(times))])
    known = run.posture.shape[1] == len(joints)  # a recording of poses has none
    rates = np.gradient(run.posture, motion.period, axis=0) if len(times) > 1 else 0 * run.posture
    for row, time in enumerate(times):
        if known:
            state = bags.Encoder(time).texts(joints).sequence(run.posture[row].tolist())
            state.sequence(rates[row].tolist()).sequence(run.effort[row].tolist())
            made.add("/joint_states", bags.JOINT_STATE, time, state)
            asked: list[float] = run.command[row].tolist()
            command = bags.Encoder(time).texts(joints).sequence([])
            parts = ([], asked) if run.torques else (asked, [])
            made.add(
                "/dqpaint/command",
                bags.JOINT_STATE,
                time,
                command.sequence(parts[0]).sequence(parts[1]),
            )
        for topic, kind, values in (
            ("/dqpaint/tool", POSE, tool),
            ("/dqpaint/reference", POSE, reference),
            ("/dqpaint/error", TWIST, error),
        ):
            made.add(topic, kind, time, bags.Encoder(time, base).floats(values[row].tolist()))
        colour = bags.Encoder(None).floats(light[row].tolist(), "f")
        made.add("/dqpaint/light", COLOUR, time, colour)
    picture = bags.Encoder(times[-1], "picture").text("png").data(painting.pictures[0].png)
    made.add("/dqpaint/picture", IMAGE, times[-1], picture)
    return made.finish()


def _placements(poses: Floats) -> Floats:
    """Points [m] and quaternions (N, 7) of poses, the scalar last, as ROS has them."""
    return np.column_stack([dq.translation(poses), np.roll(dq.rotation(poses), -1, axis=1)])


def _errors(poses: Floats, wanted: Floats) -> Floats:
    """What the tool is off (N, 6), from the reference on: way [m] and rotation vector [rad].

    Both along the base's axes: p - p_d, and 2 log(r r_d^*), the short way.
    """
    way = dq.translation(poses) - dq.translation(wanted)
    return np.column_stack([way, 2 * dq.log(dq.mul(poses, dq.conj(wanted)))[:, :3]])

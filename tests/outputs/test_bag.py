"""Bags: written here and read by two libraries of others, and the other way round."""

import io

import numpy as np
import pytest

import dqpaint
from dqpaint import dq
from dqpaint.core import bags
from dqpaint.errors import DqpaintError
from dqpaint.outputs.registry import choose_writers, make_files
from dqpaint.robots.kinematics import Kinematics
from dqpaint.robots.model.card import read_card
from dqpaint.simulation.recorded_run import read_recording
from tests.support.installed import JOINTS

pytest.importorskip("mcap")
rosbag2 = pytest.importorskip("rosbags.rosbag2")
typesys = pytest.importorskip("rosbags.typesys")

TEXT = (
    "period 20 ms\nprofile quintic\nstart at (-40, 0) mm\n"
    "line to (40, 10) mm tool rot(y, 20 deg) in 0.6 s light red to blue\n"
)
TYPES = typesys.get_typestore(typesys.Stores.ROS2_HUMBLE)
STATE = "sensor_msgs/msg/JointState"


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    made = tmp_path_factory.mktemp("bags")
    (made / "hook.traj").write_text(TEXT)
    return made


@pytest.fixture(scope="module")
def painting(folder):
    return dqpaint.draw(folder / "hook.traj", plant="ideal", controller="p", size=(64, 36))


@pytest.fixture(scope="module")
def data(painting):
    return make_files(choose_writers("bag"), painting)[".mcap"]


def by_rosbags(path):
    """Every message of a bag as rosbags decodes it, by the definitions that stand in the file."""
    found = {}
    with rosbag2.Reader(path) as reader:
        for one in reader.connections:
            own = typesys.get_typestore(typesys.Stores.EMPTY)
            own.register(typesys.get_types_from_msg(one.msgdef.data, one.msgtype))
            found[one.topic] = [
                (time, own.deserialize_cdr(raw, one.msgtype))
                for _, time, raw in reader.messages([one])
            ]
    return found


def test_rosbags_and_mcap_read_what_was_run(painting, data, folder):
    from mcap.reader import make_reader

    path = folder / "own.mcap"
    path.write_bytes(data)
    found, run = by_rosbags(path), painting.track
    names = set(found)
    assert names == {"/joint_states"} | {
        f"/dqpaint/{one}" for one in ("tool", "reference", "command", "error", "light", "picture")
    }
    counts = make_reader(io.BytesIO(data)).get_summary().statistics.channel_message_counts
    assert sorted(counts.values()) == sorted(len(one) for one in found.values())
    states = found["/joint_states"]
    np.testing.assert_array_equal([one.position for _, one in states], run.posture)
    np.testing.assert_array_equal([one.effort for _, one in states], run.effort)
    assert tuple(states[0][1].name) == JOINTS
    stamps = [one.header.stamp.sec * 10**9 + one.header.stamp.nanosec for _, one in states]
    assert stamps == [time for time, _ in states]
    np.testing.assert_allclose(np.array(stamps) * 1e-9, painting.motion.t, atol=1e-9)
    np.testing.assert_array_equal([one.velocity for _, one in found["/dqpaint/command"]],
                                  run.command)  # fmt: skip
    light = np.array([[one.r, one.g, one.b] for _, one in found["/dqpaint/light"]])
    np.testing.assert_allclose(light, painting.motion.light, atol=1e-7)
    [(_, picture)] = found["/dqpaint/picture"]
    assert bytes(picture.data) == painting.pictures[0].png
    assert picture.format == "png"


def test_poses_and_errors_are_those_of_the_run(painting, data, folder):
    from scipy.spatial.transform import Rotation

    path = folder / "poses.mcap"
    path.write_bytes(data)
    found = by_rosbags(path)

    def placed(topic):
        poses = [one.pose for _, one in found[topic]]
        at = [(p.position.x, p.position.y, p.position.z) for p in poses]
        turned = [
            (p.orientation.x, p.orientation.y, p.orientation.z, p.orientation.w) for p in poses
        ]
        return np.array(at), Rotation.from_quat(turned)

    at, turned = placed("/dqpaint/tool")
    wanted, asked = placed("/dqpaint/reference")
    T = Kinematics(read_card("iiwa")).poses(painting.track.posture)
    np.testing.assert_allclose(at, dq.translation(T), atol=1e-12)
    twists = [one.twist for _, one in found["/dqpaint/error"]]
    way = np.array([(t.linear.x, t.linear.y, t.linear.z) for t in twists])
    turn = np.array([(t.angular.x, t.angular.y, t.angular.z) for t in twists])
    assert np.abs(way).max() > 1e-4
    assert np.abs(turn).max() > 1e-4
    np.testing.assert_allclose(way, at - wanted, atol=1e-12)
    np.testing.assert_allclose(turn, (turned * asked.inv()).as_rotvec(), atol=1e-9)


def test_it_is_painted_again(painting, data, folder):
    path = folder / "again.mcap"
    path.write_bytes(data)
    again = dqpaint.draw(folder / "hook.traj", recorded=path, size=(64, 36))
    assert again.pictures[0].png == painting.pictures[0].png
    np.testing.assert_allclose(again.track.command, painting.track.command, atol=1e-12)
    assert any("t = 0 is the first" in note for note in again.notes)


def elsewhere(path, q, names, start=1_800_000_000_123_456_789, period=4_000_000, store=TYPES):
    """A bag made without dqpaint: joints in another order, a gripper's messages among them."""
    Header, Time = (store.types[f"{k}/msg/{n}"] for k, n in (
        ("std_msgs", "Header"), ("builtin_interfaces", "Time")))  # fmt: skip
    State = store.types[STATE]
    with rosbag2.Writer(path, version=9, storage_plugin=rosbag2.StoragePlugin.MCAP) as bag:
        topic = bag.add_connection("/joint_states", STATE, typestore=store)
        for k, row in enumerate(q):
            stamp = start + k * period
            for joints, values in ((names, row), (["finger"], [0.01])):
                head = Header(Time(stamp // 10**9, stamp % 10**9), "")
                none = np.zeros(0)
                one = State(head, list(joints), np.array(values, float), none, none)
                bag.write(topic, stamp + 77, store.serialize_cdr(one, STATE))
    return next(path.glob("*.mcap"))


def test_a_bag_from_elsewhere_gives_the_same_picture(painting, folder):
    order = [3, 0, 6, 2, 1, 5, 4]
    q = painting.track.posture
    names = [JOINTS[i] for i in order]
    path = elsewhere(folder / "lab", q[:, order], names, period=20_000_000)
    found = read_recording(str(path), JOINTS)
    np.testing.assert_array_equal(found.postures, q)
    np.testing.assert_allclose(found.t, painting.motion.t, atol=1e-9)
    assert any(f"{len(q)} messages lack joints" in remark for remark in found.remarks)
    again = dqpaint.draw(folder / "hook.traj", recorded=path, size=(64, 36))
    assert again.pictures[0].png == painting.pictures[0].png


def refused(path, names=JOINTS):
    with pytest.raises(DqpaintError) as caught:
        read_recording(str(path), names)
    assert "\n" not in str(caught.value)
    return str(caught.value)


def test_a_bag_that_is_cut_off_is_a_sentence_wherever_it_is_cut(data, folder):
    path = folder / "cut.mcap"
    for size in np.unique(np.linspace(0, len(data) - 1, 60).astype(int)).tolist():
        path.write_bytes(data[:size])
        said = refused(path)
        assert "cut.mcap" in said
    path.write_bytes(data[: len(data) // 2])
    assert "mcap recover" in refused(path)


@pytest.mark.parametrize("packed", ["zstd", "lz4"])
def test_it_unpacks_no_further_than_it_says(folder, packed):
    """A few hundred bytes that say they are small and would fill a gigabyte."""
    import lz4.frame
    import zstandard
    from mcap.records import Chunk

    zeros = bytes(50_000_000)
    small = lz4.frame.compress(zeros) if packed == "lz4" else zstandard.compress(zeros)
    chunk = Chunk(packed, small, 0, 0, 0, 100)
    with pytest.raises(bags.BagError, match="another size"):
        bags._unpacked("a.mcap", chunk, 100)
    with pytest.raises(bags.BagError, match="unpack to more"):
        bags._unpacked("a.mcap", chunk, 2 * bags.LARGEST_UNPACKED)


def test_what_is_not_this_arms_run_is_refused(painting, folder):
    q = painting.track.posture
    path = elsewhere(folder / "other", q[:3], [f"panda_{i}" for i in range(7)])
    assert "no message of /joint_states has the joints of this arm" in refused(path)
    still = elsewhere(folder / "still", q[:3], JOINTS, period=0)
    assert "does not come after" in refused(still)
    wrong = q[:3].copy()
    wrong[1, 2] = np.nan
    assert "message 2 with this arm's joints" in refused(elsewhere(folder / "nan", wrong, JOINTS))
    none = bags.BagWriter()
    none.add("/light", "std_msgs/msg/ColorRGBA", 5, bags.Encoder(None).floats([0, 0, 1, 1], "f"))
    (folder / "none.mcap").write_bytes(none.finish())
    assert "/light (std_msgs/msg/ColorRGBA)" in refused(folder / "none.mcap")
    short = bags.BagWriter()
    short.add("/joint_states", STATE, 5, bags.Encoder(5).texts(JOINTS))
    (folder / "short.mcap").write_bytes(short.finish())
    assert "message 1 of /joint_states: it is shorter" in refused(folder / "short.mcap")


def test_a_stamp_since_1970_keeps_its_nanoseconds(folder):
    q = np.linspace(0, 1, 21).reshape(3, 7)
    found = read_recording(str(elsewhere(folder / "late", q, JOINTS, period=1_000_003)), JOINTS)
    np.testing.assert_allclose(found.t, [0, 0.001000003, 0.002000006], rtol=0, atol=1e-15)

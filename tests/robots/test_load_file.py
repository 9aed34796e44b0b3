"""Arms from files of one's own: what they leave out, and what is wrong with them."""

import tomllib
from pathlib import Path

import numpy as np
import pytest

from dqpaint import dq
from dqpaint.errors import DqpaintError, UnknownNameError, UsageError
from dqpaint.robots.kinematics.kinematics import Kinematics
from dqpaint.robots.kinematics.start_posture import StartPosture, find_start
from dqpaint.robots.loading.load_file import read_file
from dqpaint.robots.loading.lookup import find_card
from dqpaint.robots.model.card import read_card
from tests.support.arm_files import arm_urdf

VIPER = """
[denavit_hartenberg]
rows = [
    { d_m = 0.335, a_m = 0.075, alpha_deg = -90 },
    { a_m = 0.365 },
    { a_m = -0.090, alpha_deg = 90 },
    { d_m = 0.405, alpha_deg = -90 },
    { alpha_deg = 90 },
    { d_m = 0.080 },
]
"""
LIMITS = """
[limits]
lower_deg = [-170, -190, -29, -190, -120, -360]
upper_deg = [170, 45, 256, 190, 120, 360]
speed_deg_s = [250, 250, 250, 375, 375, 600]
effort_Nm = [160, 160, 90, 25, 25, 12]
"""
HOME = "home_deg = [0, -57, 187, 0, -40, 90]\n"
XACRO = "<xacro:if xmlns:xacro='http://www.ros.org/wiki/xacro'/>"
CANVAS = "[canvas]\nat_m = [0.7, 0, 0.5]\nright = [0, 1, 0]\nup = [0, 0, 1]\n"


@pytest.fixture
def write(tmp_path):
    def make(name, text):
        (tmp_path / name).write_text(text)
        return str(tmp_path / name)

    return make


def test_a_card_of_one_s_own_is_read_like_ours(write):
    """The text of a card of ours, from another place."""
    from importlib import resources

    text = (resources.files("dqpaint.robots") / "cards" / "meka-a2.toml").read_text("utf-8")
    card, ours = find_card(write("mine.toml", text)), read_card("meka-a2")
    assert card.notes == ()
    assert card.model_copy(update={"name": "meka-a2"}) == ours


@pytest.mark.slow
def test_rows_and_limits_are_enough(write):
    card = read_file(write("viper.toml", VIPER + LIMITS))
    assert card.name == "viper"
    assert [note.partition(":")[0] for note in card.notes] == [
        "no [tool]", "no [body]", "no [canvas]", "no home_deg",
    ]  # fmt: skip
    arm = Kinematics(card)
    posture = np.radians([20, -110, 190, 25, 45, 20])
    T = dq.matrix_from_pose(arm.pose(posture))
    np.testing.assert_allclose(T[:3, 3], [0.3658, 0.1586, 0.7963], atol=5.1e-5)
    on_it = dq.matrix_from_pose(arm.pose(card.home))
    np.testing.assert_allclose(on_it, dq.matrix_from_pose(card.canvas.pose), atol=5e-3)
    assert read_file(write("viper.toml", VIPER + LIMITS)) == card  # every time the same


@pytest.mark.slow
@pytest.mark.parametrize("name", ["viper850", "meka-a2", "xarm6", "iiwa"])
def test_a_derived_canvas_lies_well_inside_the_reach(name, monkeypatch):
    """A hand's breadth around it is reached, with room to the limits."""
    from dqpaint.robots.loading.defaults import find_canvas

    card = read_card(name)
    canvas, home = find_canvas(card)
    arm = Kinematics(card)
    corners = 0.08 * np.array([[0, 0, 0], [1, 1, 0], [-1, 1, 0], [-1, -1, 0], [1, -1, 0]])
    poses = dq.mul(canvas.pose, dq.pose_from(corners, np.tile([1.0, 0, 0, 0], (5, 1))))
    found = find_start(arm, poses, 3.0 * np.arange(5))
    assert isinstance(found, StartPosture)
    assert found.margin > np.radians(8)
    assert ((card.lower <= home) & (home <= card.upper)).all()


def test_a_canvas_is_taken_from_the_home_posture(write):
    card = read_file(write("viper.toml", HOME + VIPER + LIMITS))
    arm = Kinematics(card)
    np.testing.assert_allclose(
        dq.matrix_from_pose(arm.pose(card.home)), dq.matrix_from_pose(card.canvas.pose), atol=1e-9
    )
    assert card.notes[-1].startswith("no [canvas]: it is where the home posture")


def test_a_home_posture_is_found_for_a_canvas(write):
    card = read_file(write("viper.toml", VIPER + LIMITS + CANVAS))
    there = dq.matrix_from_pose(Kinematics(card).pose(card.home))
    np.testing.assert_allclose(there, dq.matrix_from_pose(card.canvas.pose), atol=5e-3)
    far = CANVAS.replace("0.7, 0, 0.5", "2.7, 0, 0.5")
    with pytest.raises(DqpaintError, match=r"viper .*canvas: .*1\d{3} mm"):
        read_file(write("viper.toml", VIPER + LIMITS + far))


def test_screw_axes_are_an_arm(write):
    """The axes of the rows, typed as points and directions, with a direction of any length."""
    ours = read_card("viper850")
    screws = ours.axes
    points = dq.cross(screws.axes[:, :3], screws.axes[:, 3:])
    place = dq.translation(screws.home)
    text = HOME + LIMITS + CANVAS
    directions = 3 * screws.axes[:, :3]
    text += f"[screws]\npoints_m = {points.tolist()}\ndirections = {directions.tolist()}\n"
    text += f"flange = {{ at_m = {place.tolist()}, rpy_deg = [0, 0, 0] }}\n"
    card = read_file(write("axes.toml", text))
    q = np.radians([20, -110, 190, 25, 45, 20])
    want = dq.translation(Kinematics(ours.model_copy(update={"tool": card.tool})).pose(q))
    np.testing.assert_allclose(dq.translation(Kinematics(card).pose(q)), want, atol=1e-12)


def test_a_urdf_brings_its_limits(write):
    card = read_file(write("arm.urdf", arm_urdf()) + ":l6")
    np.testing.assert_allclose(card.lower, -2.5)
    np.testing.assert_allclose(card.upper, [2.1, 2.2, 2.3, 2.4, 2.5, 2.6])
    np.testing.assert_allclose(card.speed, 2)
    np.testing.assert_allclose(card.effort, 400)
    assert Kinematics(card).model.nv == 6
    assert len(card.notes) == 3  # tool, canvas, home; in words that a URDF's owner can act upon
    assert not any("no [" in note or "home_deg" in note for note in card.notes)
    assert card.notes[0].endswith("--tool puts it elsewhere")


def test_a_card_may_lean_on_a_urdf_beside_it(write):
    write("arm.urdf", arm_urdf())
    text = '[urdf]\nfile = "arm.urdf"\nlink = "l6"\n[tool]\nat_m = [0, 0, 0.1]\n' + CANVAS
    card = read_file(write("mine.toml", text))
    assert card.tool.at_m == (0, 0, 0.1)
    np.testing.assert_allclose(card.effort, 400)
    assert len(card.notes) == 1  # home


def test_the_only_end_of_a_urdf_is_found_and_several_are_listed(write):
    text = arm_urdf()
    alone = text[: text.index('<joint name="grip"')] + "</robot>"
    alone = alone.replace('<link name="finger">', '<link name="tip2">')
    joint = '<joint name="f" type="fixed"><parent link="{}"/><child link="tip2"/></joint></robot>'
    card = read_file(write("arm.urdf", alone.replace("</robot>", joint.format("tip"))))
    assert card.link == "tip2"
    assert card.notes[0] == "the light is on link 'tip2', the last one"
    two = alone.replace("</robot>", joint.format("l6"))
    with pytest.raises(UsageError, match=r"tip, tip2; .*arm.urdf:tip"):
        read_file(write("arm.urdf", two))


def test_a_round_joint_turns_either_way(write):
    text = arm_urdf().replace(
        '<joint name="j4" type="revolute">', '<joint name="j4" type="continuous">'
    )
    card = read_file(write("arm.urdf", text) + ":l6")
    assert (card.limits.lower_deg[3], card.limits.upper_deg[3]) == (-360, 360)
    assert Kinematics(card).model.nq == 6


@pytest.mark.parametrize(("text", "message"), [
    (VIPER, "mine.toml: limits .*lower_deg"),
    (LIMITS, r"mine.toml: .*\[urdf\]"),
    (VIPER.replace("d_m = 0.080", "d = 0.080") + LIMITS,
     r"denavit_hartenberg.rows\[6\].d .*d_m"),
    (VIPER.replace("0.365", "'long'") + LIMITS,
     r"denavit_hartenberg.rows\[2\].a_m"),
    (VIPER + LIMITS.replace("25, 25, 12]", "25, 25, 0]"),
     r"limits.effort_Nm\[6\]"),
    (VIPER + LIMITS.replace("25, 25, 12]", "25]"), "each joint"),
    (VIPER + LIMITS.replace("-170, ", "-170, 3, "), "limit .*one number"),
    (VIPER.replace("    { d_m = 0.080 },\n", "") + LIMITS, "limits .*5 joints"),
    ("home_deg = [0, 0]\n" + VIPER + LIMITS, "home_deg .*6 joints"),
    ("colour = 'red'\n" + VIPER + LIMITS, "colour is not known"),
    (VIPER + LIMITS + "[canvas]\nat_m = [1, 2]\n", r"canvas.at_m\[3\]"),
    ("home_deg = [0, 90, 0, 0, 0, 0]\n" + VIPER + LIMITS, "home_deg .*inside"),
    ("[denavit_hartenberg\n", "mine.toml is not valid TOML: "),
    ('[urdf]\nfile = "not-there.urdf"\n', "not-there.urdf' cannot be read"),
    ("[urdf]\nlink = 'l6'\n", "urdf.file is missing"),
    ("urdf = 3\n", "mine.toml: urdf is not a table"),
    (VIPER.replace("    { d_m = 0.080 },\n", "    [0.080],\n") + LIMITS,
     r"rows\[6\] is not a table"),
])  # fmt: skip
def test_faults_of_a_card_are_told_by_their_field(write, text, message):
    tomllib.loads(text) if "not valid TOML" not in message else None
    with pytest.raises(DqpaintError, match=message):
        read_file(write("mine.toml", text))


@pytest.mark.parametrize(
    ("name", "message"),
    [
        ("none.toml", "none.toml' cannot be read"),
        ("none.urdf:tip", "none.urdf' cannot be read"),
    ],
)
def test_a_missing_file_is_named(name, message):
    with pytest.raises(DqpaintError, match=message):
        find_card(name)


def test_a_name_is_not_a_file():
    with pytest.raises(UnknownNameError):
        find_card("arm")


@pytest.mark.parametrize(("old", "new", "link", "message"), [
    ("</robot>", "", "l6", r"arm\.urdf .*no element found"),
    ("<robot ", "<rowboat ", "l6", "mismatched tag"),
    ('<parent link="base"/>', '<parent link="l6"/>', "l6", "loop of links"),
    ('<parent link="l2"/>', '<parent link="l9"/>', "l6", "'l9'"),
    ('<parent link="l2"/>', "", "l6", "'j3' has no parent"),
    ('<child link="l3"/>', '<child link="l2"/>', "l6", "'j2' and 'j3' .*'l2'"),
    ('<link name="l2">', '<link name="l1">', "l6", "two .*'l1'"),
    ('<link name="tip"/>', '<link name="tip"/><link name="alone"/>', "l6", "not connected"),
    ('velocity="2" effort="400"', 'velocity="0" effort="400"', "l6",
     "joint 'j1' .*velocity of 0.*rad/s"),
    ('velocity="2" effort="400"', 'velocity="2"', "l6", "joint 'j1' .*effort"),
    ('lower="-2.5" upper="2.1"', 'lower="0" upper="0"', "l6", "lower below upper"),
    ('upper="2.1"', 'upper="far"', "l6", "joint 'j1': upper 'far'"),
    ('xyz="0 0 0.3"', 'xyz="0 0"', "l6", "joint 'j1': origin xyz=\"0 0\""),
    ('<axis xyz="0 0 1"/>', '<axis xyz="0 0 0"/>', "l6", "not all zero"),
    ('mass value="6"', 'mass value="-6"', "l6", "mass .*'l1' .*'-6'"),
    ('ixx="0.02"', 'ixx="much"', "l6", "inertia .*'l1'"),
    ('"j3" type="revolute"', '"j3" type="prismatic"', "l6", "'j3' is prismatic"),
    ("<link", "<link", "finger", "joint 'grip' is prismatic"),
    ("<link", "<link", "hand", "arm.urdf .*'hand'; .*l1"),
    ("<link", f"{XACRO}<link", "l6", "is a xacro file"),
])  # fmt: skip
def test_faults_of_a_urdf_are_told_by_their_place(write, old, new, link, message):
    text = arm_urdf()
    assert old in text
    with pytest.raises(DqpaintError, match=message):
        Kinematics(read_file(write("arm.urdf", text.replace(old, new, 1)) + f":{link}"))


def test_a_file_without_its_ending_is_asked_for_whole(write, monkeypatch):
    monkeypatch.chdir(Path(write("mine.toml", VIPER + LIMITS)).parent)
    with pytest.raises(UsageError, match=r"no robot named 'mine'; .*: mine.toml"):
        find_card("mine")
    with pytest.raises(UnknownNameError, match="known: "):
        find_card("yours")

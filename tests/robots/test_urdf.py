"""What is settled in a description before the libraries read it, and what is said of it."""

import re
from xml.etree import ElementTree as Xml

import numpy as np
import pinocchio
import pytest

from dqpaint import dq
from dqpaint.errors import DqpaintError
from dqpaint.plants import PLANTS
from dqpaint.plants.engines.pybullet_client import bullet, joint_indices, quiet
from dqpaint.robots.kinematics.kinematics import Kinematics
from dqpaint.robots.loading.load_file import read_file
from dqpaint.robots.model.card import read_card
from dqpaint.robots.urdf.prepare import is_valid_inertia, prepare, urdf_file
from dqpaint.robots.urdf.tree import MOST_JOINTS, MOST_LINKS, Tree
from tests.support.arm_files import arm_urdf
from tests.support.installed import needs_pybullet_data
from tests.support.mesh_files import stl

INERTIAL = (
    '<inertial><origin xyz="0.05 0 0.02"/><mass value="4"/>'
    '<inertia ixx="0.02" ixy="0.001" ixz="0" iyy="0.03" iyz="0" izz="0.025"/></inertial>'
)


CARD = """home_deg = [0, -60, 120, 0, -60, 0]
urdf = { file = "arm.urdf", link = "tip" }
canvas = { at_m = [0.6, 0, 0.4], right = [0, 1, 0], up = [0, 0, 1] }
"""  # what would take a quarter of a second to find


@pytest.fixture
def read(tmp_path):
    def make(text):
        (tmp_path / "arm.urdf").write_text(text)
        (tmp_path / "arm.toml").write_text(CARD)
        return read_file(str(tmp_path / "arm.toml"))

    return make


def masses_of(card):
    """PyBullet's and pinocchio's joint-space inertia at one posture."""
    with quiet(), urdf_file(card) as path:
        client = bullet.connect(bullet.DIRECT)
        flags = bullet.URDF_USE_INERTIA_FROM_FILE
        body = bullet.loadURDF(path, useFixedBase=True, flags=flags, physicsClientId=client)
    q = [0.1, -0.2, 0.3, 0.4, -0.5, 0.6]
    assert len(joint_indices(body, client)) == 6
    theirs = np.array(bullet.calculateMassMatrix(body, q, physicsClientId=client))
    bullet.disconnect(client)
    model = Kinematics(card).model
    ours = pinocchio.crba(model, model.createData(), np.array(q))
    return theirs, np.triu(ours) + np.triu(ours, 1).T


@pytest.mark.slow
@pytest.mark.parametrize(("old", "new", "notes"), [
    ("<link", "<link", []),
    (INERTIAL, "", ["l3"]),
    (INERTIAL, INERTIAL.replace('value="4"', 'value="0"'),
     ["l3"]),
    ('ixx="0.02" ixy="0.001" ixz="0" iyy="0.03" iyz="0" izz="0.025"',
     'ixx="0" ixy="0" ixz="0" iyy="0" iyz="0" izz="0"',
     ["l1"]),
    ('ixx="0.02" ixy="0.001"', 'ixx="0.2" ixy="0.001"',
     ["l1"]),
    ('<axis xyz="0 1 0"/>', '<axis xyz="0 2 0"/>', []),
    ('<link name="base"/>',
     '<link name="base"><visual><geometry><mesh filename="package://a/b.stl"/></geometry></visual></link>',
     ["package://a/b.stl"]),
])  # fmt: skip
def test_what_is_assumed_is_said_and_the_same_for_both_libraries(read, old, new, notes):
    """The tip has no <inertial>, the finger slides: neither becomes a kilogram or a joint."""
    text = arm_urdf()
    assert old in text
    card = read(text.replace(old, new, 1))
    told = prepare(card).notes
    assert [re.search(r"'(.+?)'", note)[1] for note in told] == notes  # each names its thing
    theirs, ours = masses_of(card)
    np.testing.assert_allclose(theirs, ours, atol=1e-12)


def test_long_axes_turn_by_the_same_angle(read):
    straight, long = (
        Kinematics(read(arm_urdf().replace('"0 1 0"', axis))) for axis in ('"0 1 0"', '"0 2 0"')
    )
    q = np.array([0.1, -0.2, 0.3, 0.4, -0.5, 0.6])
    np.testing.assert_allclose(straight.pose(q), long.pose(q), atol=1e-15)


def test_a_guessed_inertia_leaves_the_mass_where_it_is(read):
    without = arm_urdf().replace(
        'ixx="0.02" ixy="0.001" ixz="0" iyy="0.03" iyz="0" izz="0.025"',
        'ixx="0" ixy="0" ixz="0" iyy="0" iyz="0" izz="0"',
    )
    inertia = Kinematics(read(without)).model.inertias[1]
    assert inertia.mass == 6
    np.testing.assert_allclose(inertia.lever, [0.05, 0, 0.02])
    np.testing.assert_allclose(inertia.inertia, 0.4 * 6 * 0.05**2 * np.eye(3), atol=1e-15)


def test_a_mimicking_finger_stands_still(read):
    mimic = arm_urdf().replace(
        'velocity="1" effort="1"/></joint>', 'velocity="1" effort="1"/><mimic joint="j1"/></joint>'
    )
    card = read(mimic)
    assert "mimic" not in prepare(card).text
    assert Kinematics(card).model.nv == 6


def test_a_mesh_is_found_from_where_the_file_is(read, tmp_path):
    (tmp_path / "meshes").mkdir()
    (tmp_path / "meshes/a.stl").write_bytes(stl())
    for name in ("package://pack/meshes/a.stl", "meshes/a.stl", f"{tmp_path}/meshes/a.stl"):
        shape = f'<visual><geometry><mesh filename="{name}"/></geometry></visual>'
        card = read(arm_urdf().replace('<link name="base"/>', f'<link name="base">{shape}</link>'))
        assert prepare(card).notes == ()
        assert f'filename="{tmp_path.resolve()}/meshes/a.stl"' in prepare(card).text


@needs_pybullet_data
def test_products_with_the_other_sign_make_bodies_of_the_xarm_s_links():
    card = read_card("xarm6")
    assert prepare(card).notes == ()
    raw = card.model_copy(update={
        "urdf": card.urdf.model_copy(update={"products_negated": False})
    })  # fmt: skip
    assert [note.split("'")[1] for note in prepare(raw).notes] == ["link2", "link3"]


@pytest.mark.parametrize(("moments", "fine"), [
    ([1, 1, 1], True), ([1, 2, 3], True), ([1, 2, 3.01], False), ([0, 1, 1], False),
    ([-1, 1, 1], False),
])  # fmt: skip
def test_a_body_obeys_the_triangle(moments, fine, rng):
    q = rng.normal(size=4)
    R = dq.matrix_from_quaternion(q / np.linalg.norm(q))
    assert is_valid_inertia(R @ np.diag(moments) @ R.T) == fine


@pytest.mark.slow
@pytest.mark.parametrize("name", ["panda", "xarm6", "lwr4"])
def test_the_stiff_plant_moves_the_arm_s_own_joints(name, tmp_path, monkeypatch):
    """Fingers are no joints of the plant; a run ends where the rates say, and leaves no file."""
    monkeypatch.setattr("tempfile.tempdir", str(tmp_path))
    card = read_card(name)
    plant = PLANTS["stiff"](card, card.home, 0.01)
    rates = 0.2 * np.cos(np.arange(card.joints))
    for _ in range(20):
        plant.run(rates)
    # within what weak wrist motors lose while they speed up
    np.testing.assert_allclose(plant.posture, card.home + 0.2 * rates, atol=3e-3)
    plant.close()
    assert not list(tmp_path.iterdir())


@pytest.mark.parametrize(("old", "new", "said"), [
    ('name="j2"', 'name="j1"', "arm.urdf: two joints .*'j1'"),
    ('name="j2"', 'name=""', "arm.urdf: a joint has no name"),
    ('xyz="0.05 0 0.02"', 'xyz="0.05 nan 0.02"', "link 'l1': inertial origin xyz="),
    ('<link name="base"/>', '<link name="base"><visual><geometry/></visual></link>',
     "link 'base': visual"),
    ('<link name="base"/>', '<link name="base"><visual><geometry><box size="1 nan 1"/></geometry>'
     '</visual></link>', "link 'base': visual box size=\"1 nan 1\""),
    ('<axis xyz="0 1 0"/>', '<axis xyz="0 1 0"/><dynamics damping="much"/>',
     "joint 'j2': damping 'much'"),
    ('velocity="2"', 'velocity="quick"', "arm.urdf: joint 'j1': velocity 'quick'"),
    ('effort="400"', 'effort="0"', "effort limit .*Nm"),
    ('<robot name="arm">', '<?xml version="1.0" encoding="klingon"?><robot name="arm">',
     "arm.urdf is not a valid URDF: .*encoding"),
])  # fmt: skip
def test_faults_of_a_description_are_told_with_their_place(read, old, new, said):
    with pytest.raises(DqpaintError, match=said):
        prepare(read(arm_urdf().replace(old, new, 1)))


def test_what_a_library_would_refuse_is_settled(read):
    """A base with a mass alone, no name of the robot, the name of a mesh no file can have."""
    base = (
        '<link name="base"><inertial><mass value="3"/></inertial><visual><geometry>'
        f'<mesh filename="{300 * "m"}.stl"/></geometry></visual></link>'
    )
    text = arm_urdf().replace('<link name="base"/>', base).replace('<robot name="arm">', "<robot>")
    card = read(text)
    assert any("link 'base' has a mass but no inertia" in note for note in prepare(card).notes)
    assert Kinematics(card).model.nv == 6


def test_long_rows_of_fixed_links_are_one_body(read):
    rows = "".join(
        f'<link name="f{i}"/><joint name="g{i}" type="fixed"><parent link="f{i - 1}"/>'
        f'<child link="f{i}"/></joint>'
        for i in range(1, 1500)
    )
    first = '<link name="f0"/><joint name="g0" type="fixed"><parent link="tip"/><child link="f0"/>'
    text = arm_urdf().replace("</robot>", first + "</joint>" + rows + "</robot>")
    assert "f1499" in prepare(read(text)).text


def test_an_arm_with_a_slide_is_refused_for_it(tmp_path):
    text = arm_urdf().replace(
        '<joint name="end" type="fixed">', '<joint name="end" type="prismatic">'
    )
    (tmp_path / "arm.urdf").write_text(text)
    with pytest.raises(DqpaintError, match="'end' is prismatic"):
        read_file(str(tmp_path / "arm.urdf"))


def test_a_range_far_from_zero_is_searched_round_its_middle(read):
    from dqpaint.robots.loading.defaults import _one_turn

    card = read(arm_urdf())
    low, high = _one_turn(card)
    assert low.tolist() == card.lower.tolist()
    limits = card.limits.model_copy(update={
        "lower_deg": (5700.0, *card.limits.lower_deg[1:]),
        "upper_deg": (5760.0, *card.limits.upper_deg[1:]),
    })  # fmt: skip
    low, high = _one_turn(card.model_copy(update={"limits": limits}))
    np.testing.assert_allclose(np.degrees([low[0], high[0]]), [5700, 5760])


SLIPS = {
    "a colour": (
        "</robot>",
        '<material name="a"><color rgba="1 x"/></material><material/></robot>',
    ),
    "a version": ("<robot ", '<robot version="7.x" '),
    "a safety controller": ("<axis", "<safety_controller/><calibration rising='x'/><axis"),
    "other things": ("</robot>", "<sensor/><gazebo reference='z'/><transmission/></robot>"),
}


@pytest.mark.parametrize("slip", SLIPS)
def test_slips_in_what_has_no_part_in_it_are_no_matter(slip, read, capfd):
    """Libraries refuse such files, or print of them: what they are given has none of it."""
    plain = Kinematics(read(arm_urdf()))
    other = Kinematics(read(arm_urdf().replace(*SLIPS[slip])))
    q = np.array([0.1, -0.2, 0.3, 0.4, -0.5, 0.6])
    np.testing.assert_array_equal(plain.pose(q), other.pose(q))
    assert prepare(other.card).text == prepare(plain.card).text
    assert capfd.readouterr() == ("", "")


COLOURS = {  # of a shape, and of the robot beside it -> what is left
    ('<material name="own"><color rgba="0.2 0.4 0.6 1"/></material>', ""): "0.2 0.4 0.6 1",
    ('<material name="named"/>', '<material name="named"><color rgba="1 .5 0 1"/></material>'): (
        "1 .5 0 1"
    ),
    ('<material name="nobody"/>', ""): None,
    ('<material name="a"><color rgba="1 x 0 1"/></material>', ""): None,
    ('<material name="a"><color rgba="1 1 0"/></material>', ""): None,
    ('<material name="a"><color rgba="1 1 0 7"/></material>', ""): None,
    ('<material name="a"><texture filename="wood.png"/></material>', ""): None,
    ("<material/>", ""): None,
}


@pytest.mark.parametrize(("given", "left"), COLOURS.items())
def test_colours_stay_where_they_are_sound(given, left, read, capfd):
    own, beside = given
    shape = f'<link name="l3"><visual><geometry><sphere radius="0.1"/></geometry>{own}</visual>'
    text = arm_urdf().replace('<link name="l3">', shape, 1).replace("</robot>", f"{beside}</robot>")
    tree = Xml.fromstring(prepare(read(text)).text)
    colours = [one.get("rgba") for one in tree.find("link[@name='l3']").iter("color")]
    assert colours == ([left] if left else [])
    assert tree.find("material") is None
    assert capfd.readouterr() == ("", "")


SHAPE = '<link name="l3"><visual><geometry>{}</geometry></visual>'


@pytest.mark.parametrize(("shape", "said"), [
    ("<cone/>", "link 'l3': visual is a cone"),
    ('<mesh filename="a.stl" scale="a b"/>', 'visual mesh scale="a b"'),
    ('<mesh filename="a.stl" scale="1 0 1"/>', 'visual mesh scale="1 0 1"'),
])  # fmt: skip
def test_shapes_that_are_none(shape, said, read):
    with pytest.raises(DqpaintError) as caught:
        read(arm_urdf().replace('<link name="l3">', SHAPE.format(shape)))
    assert said in str(caught.value)


@pytest.mark.parametrize(("joints", "fits"), [(MOST_JOINTS, True), (MOST_JOINTS + 1, False)])
def test_the_joints_of_an_arm_have_a_limit(tmp_path, joints, fits):
    links = "".join(f'<link name="l{i}"/>' for i in range(joints + 1))
    turning = "".join(
        f'<joint name="j{i}" type="revolute"><parent link="l{i}"/><child link="l{i + 1}"/>'
        f'<axis xyz="0 0 1"/><limit lower="-1" upper="1" velocity="1" effort="1"/></joint>'
        for i in range(joints)
    )
    (tmp_path / "a.urdf").write_text(f'<robot name="a">{links}{turning}</robot>')
    tree = Tree(tmp_path / "a.urdf")
    if fits:
        assert len(tree.arm(f"l{joints}")) == joints
    else:
        with pytest.raises(DqpaintError, match=f"{joints} joints"):
            tree.arm(f"l{joints}")


@pytest.mark.parametrize(("links", "fits"), [(MOST_LINKS, True), (MOST_LINKS + 1, False)])
def test_links_have_a_limit(tmp_path, links, fits):
    body = '<link name="l0"/>' + "".join(
        f'<link name="l{i}"/><joint name="j{i}" type="fixed"><parent link="l0"/>'
        f'<child link="l{i}"/></joint>'
        for i in range(1, links)
    )
    (tmp_path / "a.urdf").write_text(f'<robot name="a">{body}</robot>')
    if fits:
        assert len(Tree(tmp_path / "a.urdf").links) == links
    else:
        with pytest.raises(DqpaintError, match=f"{links} links"):
            Tree(tmp_path / "a.urdf")


@pytest.mark.parametrize(("old", "edge", "beyond"), [
    ('origin xyz="0 0 0.3"', 'origin xyz="0 0 1000"', 'origin xyz="0 0 1000.1"'),
    ('rpy="0 0 0"', 'rpy="0 0 1e6"', 'rpy="0 0 1.1e6"'),
    ('mass value="6"', 'mass value="1e9"', 'mass value="1.1e9"'),
    ('ixx="0.02"', 'ixx="1e9"', 'ixx="1.1e9"'),
    ('velocity="2"', 'velocity="1.74e7"', 'velocity="1.75e7"'),
    ('effort="400"', 'effort="1e-6"', 'effort="9e-7"'),
    ('upper="2.1"', 'upper="1e6"', 'upper="1.1e6"'),
    ('lower="-2.5" upper="2.1"', 'lower="0" upper="2e-6"', 'lower="0" upper="9e-7"'),
])  # fmt: skip
def test_numbers_have_a_range(read, old, edge, beyond):
    assert old in arm_urdf()
    prepare(read(arm_urdf().replace(old, edge)))
    with pytest.raises(DqpaintError, match=r"arm\.(urdf|toml)"):
        prepare(read(arm_urdf().replace(old, beyond)))

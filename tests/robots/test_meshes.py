"""Mesh files are read by us before a library does, and what is wrong with one is said."""

import random
import subprocess
import sys
from importlib.resources import files

import cv2
import numpy as np
import pytest

from dqpaint.errors import DqpaintError
from dqpaint.robots.loading.load_file import read_file
from dqpaint.robots.urdf import meshes
from dqpaint.robots.urdf.meshes import MeshError, check_mesh
from dqpaint.robots.urdf.prepare import prepare as prepared
from tests.support.arm_files import arm_urdf
from tests.support.mesh_files import DAE, OBJ, stl


def checked(tmp_path, name, data):
    path = tmp_path / name
    path.write_bytes(data.encode() if isinstance(data, str) else data)
    meshes._check.cache_clear()
    return check_mesh(path)


@pytest.mark.parametrize(("name", "data", "triangles", "extent"), [
    ("a.obj", OBJ, 4, 3.0), ("a.OBJ", OBJ.replace(b"\n", b"\r\n"), 4, 3.0),
    ("a.stl", stl(), 2, 1.0), ("a.dae", DAE, 3, 2.0),
])  # fmt: skip
def test_sound_files_are_taken(tmp_path, name, data, triangles, extent):
    found = checked(tmp_path, name, data)
    assert (found.triangles, found.extent) == (triangles, extent)
    assert found.tried == name.endswith("dae")


WRONG = {
    "an index beyond": ("a.obj", OBJ.replace(b"4//1", b"5//1"), "corner '5//1'"),
    "zero": ("a.obj", OBJ.replace(b"4//1", b"0//1"), "corner '0//1'"),
    "a texture beyond": ("a.obj", OBJ.replace(b"4/1 3", b"4/2 3"), "corner '4/2'"),
    "a normal beyond": ("a.obj", OBJ.replace(b"4//1", b"4//2"), "corner '4//2'"),
    "back too far": ("a.obj", OBJ.replace(b"-3\n", b"-5\n", 2), "corner '-5'"),
    "back before it is there": ("a.obj", b"f -1 -1 -1\n" + OBJ, "line 1"),
    "a face before its vertices": ("a.obj", b"f 1 2 3\n" + OBJ, "line 1"),
    "a vertex too late": ("a.obj", OBJ + b"f 1 2 5\nv 1 1 1\n", "corner '5'"),
    "a slash at its end": ("a.obj", OBJ + b"f 1 2 3/\n", "corner '3/'"),
    "slashes alone": ("a.obj", OBJ + b"f 1 2 3//\n", "corner '3//'"),
    "a normal left out": ("a.obj", OBJ + b"f 1 2 3/1/\n", "corner '3/1/'"),
    "huge": ("a.obj", OBJ.replace(b"4//1", b"99999999999//1"), "corner"),
    "no number": ("a.obj", OBJ.replace(b"4//1", b"x//1"), "corner"),
    "infinite": ("a.obj", OBJ.replace(b"-3", b"1e999", 1), "number"),
    "nan": ("a.obj", OBJ.replace(b"-3", b"nan", 1), "number"),
    "a long number": ("a.obj", OBJ.replace(b"-3", b"0" * 41, 1), "number"),
    "underscores": ("a.obj", OBJ.replace(b"-3", b"1_0", 1), "number"),
    "too few": ("a.obj", OBJ.replace(b" 0 -3", b" 0", 1), "too few"),
    "a curve": ("a.obj", OBJ + b"curv 0 1 1 2\n", "curv"),
    "a long line": ("a.obj", OBJ + b"g " + b"n" * meshes.LONGEST_LINE + b"\n", "longer"),
    "joined lines": ("a.obj", OBJ + b"f 1 2 \\\n3\n", "backslash"),
    "a zero byte": ("a.obj", OBJ + b"\0", "zero"),
    "a bare CR": ("a.obj", OBJ + b"#\rf 9 9 9\n", "CR"),
    "no faces": ("a.obj", b"v 0 0 0\n", "no faces"),
    "empty": ("a.obj", b"", "no faces"),
    "more said": ("a.stl", stl(said=3), "as long"),
    "endless": ("a.stl", stl(said=0xFFFFFFFF), "as long"),
    "no triangles": ("a.stl", stl(count=1, said=0)[:84], "no triangles"),
    "an STL of text": ("a.stl", b"solid a\nendsolid\n", "binary"),
    "far": ("a.stl", stl(last=1e38), "number"),
    "an infinite STL": ("a.stl", stl(last=np.inf), "number"),
    "an STL with nan": ("a.stl", stl(last=np.nan), "number"),
    "an empty Collada": ("a.dae", "<COLLADA></COLLADA>", "asset"),
    "no Collada": ("a.dae", "<robot><asset/></robot>", "Collada"),
    "no XML": ("a.dae", "solid", "XML"),
    "entities": ("a.dae", '<!DOCTYPE a [<!ENTITY b "c">]>' + DAE[21:], "entities"),
    "an index beyond, Collada": ("a.dae", DAE.replace("1 0 2 0</p>", "1 0 3 0</p>"), "row"),
    "a normal beyond, Collada": ("a.dae", DAE.replace("1 0 2 0</p>", "1 0 2 1</p>"), "row"),
    "a negative index": ("a.dae", DAE.replace("1 0 2 0</p>", "1 0 -1 0</p>"), "row"),
    "a huge index": ("a.dae", DAE.replace("2 0</p>", f"{10**30} 0</p>"), "index"),
    "half a corner": ("a.dae", DAE.replace("2 0</p>", "2</p>"), "length"),
    "a source that is not": ("a.dae", DAE.replace('source="#v"', 'source="#w"'), "row"),
    "fewer numbers": ("a.dae", DAE.replace(" 2 0</float", " 2</float"), "numbers"),
    "more rows": ("a.dae", DAE.replace('count="3" stride', 'count="4" stride'), "rows"),
    "a wide stride": ("a.dae", DAE.replace('stride="3"', 'stride="99"'), "stride"),
    "more triangles": ("a.dae", DAE.replace('triangles count="1"', 'triangles count="9"'), "faces"),
    "other faces": ("a.dae", DAE.replace("triangles", "trifans"), "trifans"),
    "nan, Collada": ("a.dae", DAE.replace("0 2 0<", "0 nan 0<"), "numbers"),
    "skins": ("a.dae", DAE.replace("<scene>", "<library_controllers/><scene>"), "controllers"),
    "another kind": ("a.ply", b"ply\n", "known: .obj"),
    "glTF": ("a.glb", b"glTF\2\0\0\0", "known: .obj"),
    "no kind": ("passwd", b"root", "known: .obj"),
}


@pytest.mark.parametrize("name", WRONG)
def test_what_is_wrong_is_said(tmp_path, name):
    file, data, what = WRONG[name]
    with pytest.raises(MeshError, match=what):
        checked(tmp_path, file, data)


@pytest.mark.parametrize("over", [0, 1])
def test_the_size_of_a_mesh_has_a_limit(tmp_path, monkeypatch, over):
    monkeypatch.setattr(meshes, "LARGEST_FILE", len(stl()) - over)
    if over:
        with pytest.raises(MeshError, match="larger"):
            checked(tmp_path, "a.stl", stl())
    else:
        checked(tmp_path, "a.stl", stl())


@pytest.mark.parametrize(("data", "sound"), [(b"", False), (b"text", False), (None, True)])
def test_textures_are_pictures_of_bounded_size(tmp_path, monkeypatch, data, sound):
    picture = cv2.imencode(".png", np.zeros((4, 5, 3), np.uint8))[1].tobytes()
    (tmp_path / "t.png").write_bytes(picture if data is None else data)
    (tmp_path / "a.mtl").write_bytes(b"newmtl red\r\nKd 1 0 0\r\n  map_Kd t.png\r\n")
    if sound:
        checked(tmp_path, "a.obj", OBJ)
        monkeypatch.setattr(meshes, "MOST_PIXELS", 20)
        checked(tmp_path, "a.obj", OBJ)
        monkeypatch.setattr(meshes, "MOST_PIXELS", 19)
    with pytest.raises(MeshError, match="texture"):
        checked(tmp_path, "a.obj", OBJ)


def arm_with(tmp_path, name, data, scale="1 1 1"):
    """An arm whose links are all that mesh, once to be seen and once to collide."""
    (tmp_path / name).write_bytes(data.encode() if isinstance(data, str) else data)
    shape = f'<geometry><mesh filename="{name}" scale="{scale}"/></geometry>'
    both = f"<visual>{shape}</visual><collision>{shape}</collision></link>"
    head, middle = arm_urdf().split("</link>", 1)
    (tmp_path / "arm.urdf").write_text(f"{head}{both}{middle}")
    (tmp_path / "arm.toml").write_text(
        "home_deg = [0, -60, 120, 0, -60, 0]\n"
        'urdf = { file = "arm.urdf", link = "tip" }\n'
        "canvas = { at_m = [0.6, 0, 0.4], right = [0, 1, 0], up = [0, 0, 1] }\n"
    )
    meshes._check.cache_clear()
    return prepared(read_file(str(tmp_path / "arm.toml")))


def test_what_is_wrong_is_left_out_and_said(tmp_path):
    for file, data, _ in (WRONG["an index beyond"], WRONG["glTF"], WRONG["far"]):
        found = arm_with(tmp_path, file, data)
        assert "<mesh" not in found.text
        assert not found.whole
        assert any(f"mesh '{file}'" in note for note in found.notes)
    assert arm_with(tmp_path, "a.stl", stl()).text.count("<mesh") == 2


@pytest.mark.parametrize(("last", "fits"), [(1.0, True), (1.001, False)])
def test_a_mesh_is_no_larger_than_an_arm_can_be(tmp_path, last, fits):
    found = arm_with(tmp_path, "a.stl", stl(last=last), "1 1 -1000")
    assert ("<mesh" in found.text) == fits == found.whole
    with pytest.raises(DqpaintError, match="1001"):
        arm_with(tmp_path, "a.stl", stl(), "1 1 -1001")


def test_all_meshes_of_an_arm_together_have_a_limit(tmp_path, monkeypatch):
    monkeypatch.setitem(prepared.__globals__, "MOST_TRIANGLES", 4)
    arm_with(tmp_path, "a.stl", stl())  # two triangles, seen and to collide
    with pytest.raises(DqpaintError, match="6 triangles"):
        arm_with(tmp_path, "a.stl", stl(3))


@pytest.mark.slow
def test_what_takes_the_libraries_down_is_left_out(tmp_path):
    """Collada has more ways to do that than a check of its numbers finds."""
    bad = DAE.replace('<geometry id="g">', "<geometry>")
    found = arm_with(tmp_path, "a.dae", DAE)
    assert (found.whole, found.text.count("<mesh")) == (True, 2)
    meshes.try_meshes.cache_clear()
    checked(tmp_path, "b.dae", bad)
    lost = arm_with(tmp_path, "b.dae", bad)
    survives = meshes.try_meshes((tmp_path / "b.dae",)) == ()
    assert ("<mesh" in lost.text) == survives


READ_EACH = """
import sys
from dqpaint.plants.engines.pybullet_client import Client, bullet, quiet
from dqpaint.robots.kinematics.collisions import read_mesh

with Client() as client:
    for name in sys.argv[1:]:
        with quiet():
            for read in (lambda: read_mesh(name, (1.0, 1.0, 1.0)),
                         lambda: bullet.createVisualShape(
                             bullet.GEOM_MESH, fileName=name, physicsClientId=client.client)):
                try:
                    read()
                except (ValueError, bullet.error):
                    pass
print("read")
"""


@pytest.mark.slow
def test_the_libraries_survive_what_was_checked(tmp_path):
    """Mutated files: those that pass are read by PyBullet and coal without a signal."""
    chance = random.Random(3)
    kept = []
    for k in range(400):
        name, data = chance.choice([("obj", OBJ), ("stl", stl())])
        data = bytearray(data)
        for _ in range(chance.randint(1, 4)):
            data[chance.randrange(len(data))] = chance.choice(b"0123456789-/.evnf \n")
        try:
            checked(tmp_path, f"{k}.{name}", bytes(data))
        except MeshError:
            continue
        kept.append(str(tmp_path / f"{k}.{name}"))
    assert len(kept) > 40
    words = [sys.executable, "-c", READ_EACH, *kept]
    done = subprocess.run(words, capture_output=True, text=True, timeout=120)
    assert (done.returncode, done.stdout) == (0, "read\n"), done.stderr[-500:]


@pytest.mark.slow
def test_the_meshes_of_real_arms_are_sound():
    folder = files("pybullet_data")
    for name in ("kuka_iiwa/meshes", "franka_panda/meshes/visual", "laikago"):
        for path in (folder / name).iterdir():
            if path.suffix in meshes.KINDS:
                assert check_mesh(path).triangles > 10

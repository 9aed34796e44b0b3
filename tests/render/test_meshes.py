"""Fine meshes of round shapes, against the geometry of the shapes themselves."""

import xml.etree.ElementTree as Xml

import numpy as np
import pytest

from dqpaint.render.meshes import RINGS, SHAPES, SIDES, revolution_mesh, with_fine_meshes
from tests.support.urdf_shapes import BOX, CAPSULE, urdf

RADIUS, LENGTH = 0.3, 0.8
AREAS = {
    "sphere": 4 * np.pi * RADIUS**2,
    "cylinder": 2 * np.pi * RADIUS * (LENGTH + RADIUS),
    "capsule": 4 * np.pi * RADIUS**2 + 2 * np.pi * RADIUS * LENGTH,
}
VOLUMES = {
    "sphere": 4 / 3 * np.pi * RADIUS**3,
    "cylinder": np.pi * RADIUS**2 * LENGTH,
    "capsule": 4 / 3 * np.pi * RADIUS**3 + np.pi * RADIUS**2 * LENGTH,
}


def read(kind):
    rows = [
        line.split() for line in revolution_mesh(SHAPES[kind](RADIUS, LENGTH)).decode().splitlines()
    ]
    points, normals = (np.array([r[1:] for r in rows if r[0] == w], float) for w in ("v", "vn"))
    faces = np.array([[int(part.split("//")[0]) for part in r[1:]] for r in rows if r[0] == "f"])
    return points, normals, faces - 1


@pytest.mark.parametrize("kind", SHAPES)
def test_it_is_closed_faces_outwards_and_has_the_size(kind):
    points, normals, faces = read(kind)
    a, b, c = points[faces].transpose(1, 0, 2)
    across = np.cross(b - a, c - a)
    area = np.linalg.norm(across, axis=1)
    assert 0.5 * area.sum() == pytest.approx(AREAS[kind], rel=0.01)
    # by the divergence theorem: only a closed surface that faces outwards has this volume
    assert (a * across).sum() / 6 == pytest.approx(VOLUMES[kind], rel=0.012)
    np.testing.assert_allclose(np.linalg.norm(normals, axis=1), 1, atol=1e-6)
    flat = across / np.maximum(area, 1e-12)[:, None]
    smooth = normals[faces].mean(axis=1)
    kept = area > 1e-9  # at a pole two corners of a facet are one
    cosine = (flat * smooth).sum(axis=1)[kept]
    assert cosine.min() > np.cos(np.pi / min(SIDES, 2 * RINGS))


def test_each_normal_stands_on_its_surface():
    points, normals, _ = read("capsule")
    axis = np.clip(points[:, 2], -LENGTH / 2, LENGTH / 2)
    away = points - np.stack([0 * axis, 0 * axis, axis], 1)
    np.testing.assert_allclose(away, RADIUS * normals, atol=1e-6)


def test_a_description_keeps_all_but_its_round_shapes(tmp_path):
    path = urdf(tmp_path, base=BOX, first=CAPSULE)
    files = with_fine_meshes(path.read_bytes())
    assert sorted(files) == ["0.obj", "1.obj", "2.obj", "arm.urdf"]
    tree, before = Xml.fromstring(files["arm.urdf"]), Xml.parse(path).getroot()
    assert len(tree.findall(".//mesh")) == 3
    assert len(tree.findall(".//box")) == len(before.findall(".//box"))
    assert [e.tag for e in tree] == [e.tag for e in before]


def test_a_description_with_meshes_is_left_alone(tmp_path):
    own = '<visual><geometry><mesh filename="own.stl"/></geometry></visual>'
    assert with_fine_meshes(urdf(tmp_path, base=own).read_bytes()) is None

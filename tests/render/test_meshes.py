"""Triangles of shapes and files, against the geometry of the shapes themselves."""

import numpy as np
import pytest

from dqpaint.render.meshes import (
    RINGS,
    SHAPES,
    SIDES,
    MeshFileError,
    box_mesh,
    crease_normals,
    read_mesh_file,
    round_mesh,
)

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


@pytest.mark.parametrize("kind", SHAPES)
def test_it_is_closed_faces_outwards_and_has_the_size(kind):
    corners, normals = round_mesh(kind, RADIUS, LENGTH)
    a, b, c = corners.transpose(1, 0, 2)
    across = np.cross(b - a, c - a)
    area = np.linalg.norm(across, axis=1)
    assert 0.5 * area.sum() == pytest.approx(AREAS[kind], rel=0.01)
    # by the divergence theorem: only a closed surface that faces outwards has this volume
    assert (a * across).sum() / 6 == pytest.approx(VOLUMES[kind], rel=0.012)
    np.testing.assert_allclose(np.linalg.norm(normals, axis=-1), 1, atol=1e-6)
    flat = across / np.maximum(area, 1e-12)[:, None]
    smooth = normals.mean(axis=1)
    kept = area > 1e-9  # at a pole two corners of a facet are one
    cosine = (flat * smooth).sum(axis=1)[kept]
    assert cosine.min() > np.cos(np.pi / min(SIDES, 2 * RINGS))


def test_each_normal_stands_on_its_surface():
    corners, normals = round_mesh("capsule", RADIUS, LENGTH)
    axis = np.clip(corners[..., 2], -LENGTH / 2, LENGTH / 2)
    away = corners - np.stack([0 * axis, 0 * axis, axis], -1)
    np.testing.assert_allclose(away, RADIUS * normals, atol=1e-9)


def test_a_box_is_closed_and_faces_outwards():
    corners, normals = box_mesh((0.2, 0.4, 0.6))
    a, b, c = corners.transpose(1, 0, 2)
    across = np.cross(b - a, c - a)
    assert (a * across).sum() / 6 == pytest.approx(0.2 * 0.4 * 0.6)
    flat = across / np.linalg.norm(across, axis=1)[:, None]
    np.testing.assert_allclose(flat[:, None] + 0 * normals, normals, atol=1e-12)


def test_normals_are_smooth_but_for_sharp_edges():
    """Of bare facets those of a ball are found again, and those of a cylinder with its edges."""
    for kind in ("sphere", "cylinder"):
        corners, wanted = round_mesh(kind, RADIUS, LENGTH)
        solid = np.linalg.norm(np.cross(corners[:, 1] - corners[:, 0],
                                        corners[:, 2] - corners[:, 0]), axis=1) > 1e-9  # fmt: skip
        corners, wanted = corners[solid], wanted[solid]
        cosine = (crease_normals(corners) * wanted).sum(axis=-1)
        assert cosine.min() > np.cos(np.radians(6))
    corners, normals = box_mesh((0.2, 0.4, 0.6))
    np.testing.assert_allclose(crease_normals(corners), normals, atol=1e-12)


OBJ = """v 0 0 0
v 1 0 0
v 1 1 0
v 0 1 0
vn 0 0 1
vn 0 1 1
f {faces}
"""


@pytest.mark.parametrize("faces", ["1//1 2//1 3//2 4//2", "-4//1 -3/7/-2 -2//2 -1//-1"])
def test_an_obj_has_its_own_normals(faces, tmp_path):
    """A square, counted from the start or the end, twice as wide."""
    (tmp_path / "a.obj").write_text(OBJ.format(faces=faces))
    corners, normals = read_mesh_file(str(tmp_path / "a.obj"), (2.0, 1.0, 1.0))
    np.testing.assert_array_equal(corners[0], [[0, 0, 0], [2, 0, 0], [2, 1, 0]])
    np.testing.assert_array_equal(corners[1], [[0, 0, 0], [2, 1, 0], [0, 1, 0]])
    np.testing.assert_allclose(normals[0, 0], [0, 0, 1])
    np.testing.assert_allclose(normals[0, 2], np.array([0, 1, 1]) / np.sqrt(2))


@pytest.mark.parametrize("text", ["", "v 0 0 0\nf 1 1 2\n", "v a b c\nf 1 1 1\n"])
def test_a_file_that_is_no_mesh_is_refused(text, tmp_path):
    (tmp_path / "a.obj").write_text(text)
    with pytest.raises(MeshFileError):
        read_mesh_file(str(tmp_path / "a.obj"), (1.0, 1.0, 1.0))
    with pytest.raises(MeshFileError):
        read_mesh_file(str(tmp_path / "none.stl"), (1.0, 1.0, 1.0))

"""Files of the 3-D view, read back by another hand."""

import json
import struct

import numpy as np

from dqpaint.studio.work.mesh_files import line_glb, stl

CORNERS = np.array([[0.0, 0, 0], [1, 0, 0], [0, 2, 0], [0.3, 0.4, 5]])
TRIANGLES = np.array([[0, 2, 1], [0, 1, 3], [1, 2, 3], [2, 0, 3]])


def test_stl():
    data = stl(CORNERS[TRIANGLES])
    (count,) = struct.unpack("<I", data[80:84])

    assert count == 4
    assert len(data) == 84 + 50 * 4
    for i, triangle in enumerate(TRIANGLES):
        numbers = np.array(struct.unpack("<12f", data[84 + 50 * i : 132 + 50 * i])).reshape(4, 3)
        a, b, c = CORNERS[triangle]
        normal = np.cross(b - a, c - a)
        assert np.allclose(numbers[0], normal / np.linalg.norm(normal), atol=1e-6)
        assert np.allclose(numbers[1:], CORNERS[triangle])


def test_glb(rng):
    points, colours = rng.normal(size=(50, 3)), rng.uniform(size=(50, 3))
    data = line_glb(points, colours)
    magic, version, size = struct.unpack("<4sII", data[:12])
    length, kind = struct.unpack("<I4s", data[12:20])
    document = json.loads(data[20 : 20 + length])
    binary = data[28 + length :]

    assert (magic, version, size, kind) == (b"glTF", 2, len(data), b"JSON")
    assert document["buffers"][0]["byteLength"] == len(binary)
    found = np.frombuffer(binary, "<f4").reshape(2, 50, 3)
    assert np.allclose(found[0], points, atol=1e-6)
    assert np.allclose(found[1], colours, atol=1e-6)
    assert np.allclose(document["accessors"][0]["min"], points.min(axis=0), atol=1e-6)

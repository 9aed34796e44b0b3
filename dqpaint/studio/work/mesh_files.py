"""Meshes and lines -> files that the 3-D view loads: binary STL, binary glTF."""

import json
import struct

import numpy as np

from dqpaint.dq import Floats

STL_HEADER = b"binary STL".ljust(80)


def stl(corners: Floats) -> bytes:
    """Triangles (T, 3, 3) as binary STL."""
    places = corners
    across = np.cross(places[:, 1] - places[:, 0], places[:, 2] - places[:, 0])
    normals = across / np.maximum(np.linalg.norm(across, axis=1, keepdims=True), 1e-30)
    rows = np.zeros(len(corners), np.dtype([("numbers", "<f4", 12), ("attribute", "<u2")]))
    rows["numbers"] = np.concatenate([normals[:, None], places], axis=1).reshape(-1, 12)
    return STL_HEADER + np.uint32(len(corners)).tobytes() + rows.tobytes()


def line_glb(points: Floats, colours: Floats) -> bytes:
    """A polyline with a colour at each point, as binary glTF 2.0.

    Args:
        points: (K, 3) [m].
        colours: (K, 3) linear, 0 to 1.
    """
    places = np.ascontiguousarray(points, "<f4")
    shades = np.ascontiguousarray(np.clip(colours, 0.0, 1.0), "<f4")
    binary = places.tobytes() + shades.tobytes()
    count, size = len(places), places.nbytes
    document = {
        "asset": {"version": "2.0"},
        "scene": 0,
        "scenes": [{"nodes": [0]}],
        "nodes": [{"mesh": 0}],
        "meshes": [{"primitives": [
            {"attributes": {"POSITION": 0, "COLOR_0": 1}, "mode": 3, "material": 0}
        ]}],
        "materials": [{"extensions": {"KHR_materials_unlit": {}}}],
        "extensionsUsed": ["KHR_materials_unlit"],
        "accessors": [
            {"bufferView": 0, "componentType": 5126, "count": count, "type": "VEC3",
             "min": places.min(axis=0).tolist(), "max": places.max(axis=0).tolist()},
            {"bufferView": 1, "componentType": 5126, "count": count, "type": "VEC3"},
        ],
        "bufferViews": [
            {"buffer": 0, "byteOffset": 0, "byteLength": size},
            {"buffer": 0, "byteOffset": size, "byteLength": size},
        ],
        "buffers": [{"byteLength": len(binary)}],
    }  # fmt: skip
    text = json.dumps(document, separators=(",", ":")).encode()
    text += b" " * (-len(text) % 4)
    total = 12 + 8 + len(text) + 8 + len(binary)
    return (
        struct.pack("<4sII", b"glTF", 2, total)
        + struct.pack("<I4s", len(text), b"JSON") + text
        + struct.pack("<I4s", len(binary), b"BIN\0") + binary
    )  # fmt: skip

"""Small sound mesh files: a tetrahedron, triangles, a Collada file."""

import struct

import numpy as np

OBJ = b"""# a tetrahedron
mtllib a.mtl
o solid
v 0 0 0
v 1 0 0 0.1 0.2 0.3
v 0 2 0
v 0 0 -3
vt 0 0.5
vn 0 0 1
usemtl red
s off
f 1/1/1 2/1/1 3/1/1
f 1//1 2//1 4//1
f -1 -2 -3
f 1/1 4/1 3/1
"""


def stl(count=2, said=None, last=1.0):
    rows = np.zeros((count, 12), "<f4")
    rows[:, 3:] = np.arange(9) / 8
    rows[-1, -1] = last
    body = b"".join(row.tobytes() + b"\0\0" for row in rows)
    return bytes(80) + struct.pack("<I", count if said is None else said) + body


DAE = """<?xml version="1.0"?>
<COLLADA xmlns="http://www.collada.org/2005/11/COLLADASchema" version="1.4.1">
  <asset><unit meter="1" name="meter"/><up_axis>Z_UP</up_axis></asset>
  <library_geometries><geometry id="g"><mesh>
    <source id="p"><float_array id="pa" count="9">0 0 0 1 0 0 0 2 0</float_array>
      <technique_common><accessor source="#pa" count="3" stride="3">
        <param name="X" type="float"/><param name="Y" type="float"/><param name="Z" type="float"/>
      </accessor></technique_common></source>
    <source id="n"><float_array id="na" count="3">0 0 1</float_array>
      <technique_common><accessor source="#na" count="1" stride="3">
        <param name="X" type="float"/><param name="Y" type="float"/><param name="Z" type="float"/>
      </accessor></technique_common></source>
    <vertices id="v"><input semantic="POSITION" source="#p"/></vertices>
    <triangles count="1" material="m"><input semantic="VERTEX" source="#v" offset="0"/>
      <input semantic="NORMAL" source="#n" offset="1"/><p>0 0 1 0 2 0</p></triangles>
  </mesh></geometry></library_geometries>
  <library_visual_scenes><visual_scene id="s"><node><instance_geometry url="#g"/></node>
  </visual_scene></library_visual_scenes>
  <scene><instance_visual_scene url="#s"/></scene>
</COLLADA>"""

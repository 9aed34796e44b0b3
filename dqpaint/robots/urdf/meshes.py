"""Mesh files of an arm -> what is wrong with each, before a library reads it.

The libraries read past the end of their arrays where an index is wrong, and take whatever memory a
header asks for. So every number of an OBJ, STL or Collada file is read here first; a Collada file
has so many forms that it is read once by the libraries, too, in a process that may die of it.
"""

import math
import os
import re
import subprocess
import sys
from functools import lru_cache
from pathlib import Path
from typing import NamedTuple
from xml.etree import ElementTree as Xml

import numpy as np

from dqpaint.core import picture_size, read_regular
from dqpaint.core.inputs import parse_xml

LARGEST_FILE = 25_000_000  # bytes of a mesh or a texture
LARGEST_MATERIALS = 1_000_000  # bytes of the materials of an OBJ
MOST_TRIANGLES = 1_000_000  # of all shapes of an arm together
MOST_PIXELS = 40_000_000  # of a texture
LARGEST_NUMBER = 1e9  # of a coordinate, before it is scaled
LONGEST_LINE = 2000  # bytes of a text; libraries have buffers of 4096
LONGEST_TRIAL = 10.0  # [s] for all Collada files of an arm
LARGEST_TRIAL = 3_000_000_000  # bytes of address space, of which the libraries are a half
LONGEST_NUMBER = 40  # bytes
LEAST_NUMBERS = {b"v": 3, b"vt": 2, b"vn": 3}
FACES, NAMES = (b"f", b"l", b"p"), (b"g", b"o", b"s", b"usemtl")
# v, v/vt, v//vn or v/vt/vn; PyBullet dies of one that ends with a slash
CORNER = re.compile(rb"(-?\d{1,9})(?:/(?!/?\Z)(-?\d{1,9})?(?:/(-?\d{1,9}))?)?")
TEXTURES = (b"map_", b"bump", b"disp", b"decal", b"refl", b"norm")
DAE_FACES = {"triangles": 3, "polylist": 0, "polygons": 0, "lines": 2}  # corners; 0: any number


class MeshError(Exception):
    """What is wrong with a mesh file, as the end of a sentence about it."""


class Mesh(NamedTuple):
    """What is known of a mesh that was checked.

    Attributes:
        triangles: their number.
        extent: the largest coordinate, not scaled.
        tried: whether it still has to be read in a process of its own.
    """

    triangles: int
    extent: float
    tried: bool = False


def check_mesh(path: Path) -> Mesh:
    """Read a mesh file.

    Raises:
        MeshError: it is wrong, or of a kind that cannot be checked.
    """
    try:
        facts = os.stat(path)
        found = _check(path, facts.st_mtime_ns, facts.st_size)
    except OSError as problem:
        raise MeshError(f"cannot be read: {problem.strerror}") from None
    if isinstance(found, str):
        raise MeshError(found)
    return found


@lru_cache(maxsize=256)  # a description is prepared for each library anew
def _check(path: Path, _changed: int, _size: int) -> Mesh | str:
    kind = KINDS.get(path.suffix.lower())
    if kind is None:
        return f"is of a kind that is not read; known: {', '.join(KINDS)}"
    try:
        return kind(read_regular(path, LARGEST_FILE), path)
    except MeshError as problem:
        return str(problem)


def _obj(data: bytes, path: Path) -> Mesh:
    """A Wavefront OBJ: every index is one of a vertex that stands before it."""
    if b"\0" in data or b"\\" in data or b"\r" in data.replace(b"\r\n", b"\n"):
        raise MeshError("is no plain OBJ text: it has a zero, a backslash or a bare CR")
    counts = {b"v": 0, b"vt": 0, b"vn": 0}
    corners: dict[bytes, int] = {}  # each once, and a line that has it; of those not yet checked
    numbers: dict[bytes, list[bytes]] = {kind: [] for kind in counts}
    triangles = 0
    for number, line in enumerate(data.split(b"\n"), 1):
        if len(line) > LONGEST_LINE:
            raise MeshError(f"line {number} is longer than {LONGEST_LINE} bytes")
        words = line.split()
        if not words or words[0].startswith(b"#"):
            continue
        word, *rest = words
        if word in counts:
            _check_corners(corners, counts)  # PyBullet reads a face with the vertices before it
            corners.clear()
            if len(rest) < LEAST_NUMBERS[word]:
                raise MeshError(f"line {number} has too few numbers")
            counts[word] += 1
            numbers[word] += rest
        elif word in FACES:
            triangles += max(0, len(rest) - 2)
            if b"-" in line:  # counted back from here
                _check_corners(dict.fromkeys(rest, number), counts)
            corners.update(dict.fromkeys(rest, number))
        elif word == b"mtllib":
            _check_materials(path.parent, line.strip()[7:].strip())
        elif word not in NAMES:
            raise MeshError(f"line {number} begins with {_shown(word)}")
    _check_corners(corners, counts)
    if not triangles:
        raise MeshError("has no faces")
    for kind in (b"vt", b"vn"):
        _finite(numbers[kind])
    return Mesh(triangles, _finite(numbers[b"v"]))


def _finite(words: list[bytes]) -> float:
    """The largest of some numbers, without their signs."""
    odd = next((word for word in words if len(word) > LONGEST_NUMBER or b"_" in word), None)
    try:
        values = np.array([] if odd else words, dtype="S").astype(np.float64)
    except ValueError:
        values = np.array([math.nan])
    if odd or not (np.abs(values) <= LARGEST_NUMBER).all():
        raise MeshError(f"has a number that is none, or above {LARGEST_NUMBER:g}")
    return float(np.abs(values).max(initial=0.0))


def _check_corners(corners: dict[bytes, int], counts: dict[bytes, int]) -> None:
    """The corners of faces: each names a vertex, and perhaps a texture's point and a normal."""
    for corner, line in corners.items():
        found = CORNER.fullmatch(corner)
        for kind, text in zip(counts, found.groups() if found else (b"0",), strict=False):
            if text is not None and not 0 < abs(int(text)) <= counts[kind]:
                raise MeshError(f"line {line}: there is no corner {_shown(corner)}")


def _shown(word: bytes) -> str:
    return repr(word[:30].decode("latin-1"))


def _check_materials(folder: Path, name: bytes) -> None:
    """The materials of an OBJ, if they are there, and the pictures that they name."""
    path = _beside(folder, name)
    if path is None:
        return
    data = _bytes(path, LARGEST_MATERIALS)
    if b"\0" in data:
        raise MeshError(f"names materials '{path.name}' that are no text")
    for line in re.split(rb"[\r\n]+", data):
        if len(line) > LONGEST_LINE:
            raise MeshError(f"names materials '{path.name}' with a line that is too long")
        word, _, rest = line.strip().partition(b" ")
        if not word.lower().startswith(TEXTURES):
            continue
        picture = _beside(folder, rest.strip())
        size = picture_size(_bytes(picture, LARGEST_FILE)) if picture else None
        if picture and (size is None or size.width * size.height > MOST_PIXELS):
            raise MeshError(f"has a texture '{picture.name}' that is none, or too large")


def _beside(folder: Path, name: bytes) -> Path | None:
    """A file that a mesh names, if it is there."""
    try:
        path = folder / os.fsdecode(name)
        return path if name and os.path.lexists(path) and not path.is_dir() else None
    except ValueError:
        raise MeshError("names a file that cannot be") from None


def _bytes(path: Path, most: int) -> bytes:
    try:
        return read_regular(path, most)
    except OSError as problem:
        raise MeshError(f"names '{path.name}': {problem.strerror}") from None


def _stl(data: bytes, _path: Path) -> Mesh:
    """An STL of bytes, as long as its number of triangles says."""
    count = int.from_bytes(data[80:84], "little")
    if len(data) != 84 + 50 * count:
        raise MeshError("is no binary STL, or not as long as it says")
    rows = np.frombuffer(data, np.uint8, offset=84).reshape(count, 50)
    numbers = np.ascontiguousarray(rows[:, :48]).view("<f4")[:, 3:]
    if not count or not (np.abs(numbers) <= LARGEST_NUMBER).all():
        raise MeshError("has no triangles, or a coordinate that is no such number")
    return Mesh(count, float(np.abs(numbers).max()))


def _dae(data: bytes, _path: Path) -> Mesh:
    """A Collada file: every index is one of a row that is there."""
    try:
        root = parse_xml(data)
    except ValueError as problem:
        raise MeshError(f"is no sound XML: {problem}") from None
    for element in root.iter():
        element.tag = element.tag.rpartition("}")[2]
    if root.tag != "COLLADA" or root.find("asset") is None:
        raise MeshError("is no Collada file, or has no <asset>")
    if root.find("library_controllers") is not None:
        raise MeshError("has controllers, which are not checked")
    triangles, extent = 0, 0.0
    for mesh in root.iterfind("library_geometries/geometry/mesh"):
        rows: dict[str, int] = {}
        for source in mesh.findall("source"):
            values = _floats(source)
            extent = max(extent, float(np.abs(values).max(initial=0.0)))
            rows[f"#{source.get('id')}"] = len(values) // _stride(source)
        for vertices in mesh.findall("vertices"):
            of = vertices.find("input")
            rows[f"#{vertices.get('id')}"] = (
                rows.get(of.get("source", ""), 0) if of is not None else 0
            )
        triangles += sum(
            _dae_faces(child, rows)
            for child in mesh
            if child.tag not in ("source", "vertices", "extra")
        )
    if not triangles:
        raise MeshError("has no faces")
    return Mesh(triangles, extent, tried=True)


def _stride(source: Xml.Element) -> int:
    accessor = source.find("technique_common/accessor")
    text = "1" if accessor is None else accessor.get("stride", "1")
    if not re.fullmatch(r"[1-9]|1[0-6]", text):
        raise MeshError(f"has a stride of '{text[:20]}'")
    return int(text)


def _floats(source: Xml.Element) -> "np.ndarray[tuple[int], np.dtype[np.float64]]":
    """The numbers of a source, as many as it says."""
    element = source.find("float_array")
    words = "" if element is None else element.text or ""
    try:
        values = np.array(words.split(), dtype=np.float64)
    except ValueError:
        values = np.array([math.nan])
    said = str(len(values)) if element is None else element.get("count", "")
    accessor = source.find("technique_common/accessor")
    rows = "0" if accessor is None else accessor.get("count", "0")
    if said != str(len(values)) or not (np.abs(values) <= LARGEST_NUMBER).all():
        raise MeshError("has a source with other numbers than it says")
    if not rows.isdecimal() or len(rows) > 9 or int(rows) * _stride(source) > len(values):
        raise MeshError("has a source with fewer rows than it says")
    return values


def _dae_faces(faces: Xml.Element, rows: dict[str, int]) -> int:
    """The number of triangles of one element; its indices are those of its sources."""
    if faces.tag not in DAE_FACES:
        raise MeshError(f"has <{faces.tag[:30]}>, which is not checked")
    inputs = [(one.get("offset", "0"), one.get("source", "")) for one in faces.findall("input")]
    if not inputs or not all(re.fullmatch(r"\d|1\d", offset) for offset, _ in inputs):
        raise MeshError("has faces without inputs")
    width = 1 + max(int(offset) for offset, _ in inputs)
    corners = 0
    for element in faces.findall("p"):
        try:
            indices = np.array((element.text or "").split(), dtype=np.int64)
        except (ValueError, OverflowError):
            raise MeshError("has an index that is no number") from None
        if len(indices) % width:
            raise MeshError("has faces of the wrong length")
        table = indices.reshape(-1, width)
        corners += len(table)
        for offset, source in inputs:
            column = table[:, int(offset)]
            if len(column) and not 0 <= column.min() <= column.max() < rows.get(source, 0):
                raise MeshError(f"names a row of '{source[:40]}' that is not there")
    _check_counts(faces, corners)
    return corners


def _check_counts(faces: Xml.Element, corners: int) -> None:
    """The numbers of faces that it says are those of its corners."""
    each, said = DAE_FACES[faces.tag], faces.get("count", "0")
    lengths = faces.find("vcount")
    try:
        of = [] if lengths is None else [int(n) for n in (lengths.text or "").split()]
    except ValueError:
        of = [-1]
    counted = faces.tag != "polylist" or (sum(of) == corners and min(of, default=1) > 0)
    whole = not each or (said.isdecimal() and len(said) < 10 and int(said) * each == corners)
    if not counted or not whole:
        raise MeshError("has faces of other numbers than it says")


KINDS = {".obj": _obj, ".stl": _stl, ".dae": _dae}


@lru_cache(maxsize=64)
def try_meshes(paths: tuple[Path, ...]) -> tuple[Path, ...]:
    """Those of some meshes of which the libraries die, or find no end, in a process of its own."""
    if not paths or _survives(paths):
        return ()
    return tuple(path for path in paths if len(paths) == 1 or not _survives((path,)))


def _survives(paths: tuple[Path, ...]) -> bool:
    try:
        tried = subprocess.run(
            [sys.executable, "-m", "dqpaint.robots.loading.mesh_trial", *map(str, paths)],
            env={**os.environ, "PYTHONPATH": os.pathsep.join(filter(None, sys.path))},
            stdin=subprocess.DEVNULL, capture_output=True, timeout=LONGEST_TRIAL, check=False,
        )  # fmt: skip
    except subprocess.TimeoutExpired:
        return False
    return tried.returncode == 0

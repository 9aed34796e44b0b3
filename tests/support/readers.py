"""Every reader of files of others: bytes -> whether they were taken, refused, or did harm.

A reader takes bytes, or refuses them by the exceptions named with it. Anything else is a fault: any
other exception, a warning of numpy, a number that is not finite, a time of seconds.
"""

import io
import json
import math
import re
import struct
import tempfile
import zipfile
import zlib
from collections.abc import Callable, Iterator
from contextlib import suppress
from dataclasses import dataclass
from functools import cache
from pathlib import Path

import numpy as np

from dqpaint.brushes import images
from dqpaint.core import bags
from dqpaint.core.number_table import NumberTable
from dqpaint.diagnostics import Problem, Span
from dqpaint.editors import completion
from dqpaint.editors.analysis import analyse
from dqpaint.editors.frames import messages
from dqpaint.errors import DqpaintError
from dqpaint.language import ScriptError, parse
from dqpaint.language.imports import point_files
from dqpaint.language.imports.svg import reader as svg_reader
from dqpaint.language.imports.svg.values import SvgError
from dqpaint.language.syntax.source import decoded
from dqpaint.language.writing.formatter import formatted
from dqpaint.painting import film_file
from dqpaint.robots.loading import load_file
from dqpaint.robots.urdf import meshes
from dqpaint.robots.urdf.tree import Tree
from dqpaint.settings import file as settings_file
from dqpaint.simulation.recorded_run import read_recording
from dqpaint.studies.runner import journal
from tests.support.arm_files import arm_urdf
from tests.support.drawing_texts import HERE, MIXED, ROSE, STAR, WHOLE
from tests.support.mesh_files import DAE, OBJ, stl

CORPUS = Path(__file__).parents[1] / "corpus"
SMALLEST_BYTES = 60_000  # a seed is at most so long: a fuzzer learns little from a long one
MOST_SCRAPS = 4


def finite(thing: object) -> None:
    """Every number of it is."""
    if isinstance(thing, float):
        assert math.isfinite(thing)
    elif isinstance(thing, np.ndarray):
        assert thing.dtype.kind not in "fc" or np.isfinite(thing).all()
    elif isinstance(thing, tuple | list):
        for part in thing:
            finite(part)
    elif hasattr(thing, "__dataclass_fields__"):
        for name in thing.__dataclass_fields__:
            finite(getattr(thing, name))


@dataclass(frozen=True)
class Reader:
    """A reader of files.

    Attributes:
        read: bytes, with the path of a file that has them; raises if they are no good.
        seeds: sound files and crooked ones, small.
        refusals: what it may raise.
        words: what its files are made of.
        ending: of the file's name.
        mended: of bytes that were changed, those with sums and lengths that fit again, which would
            else stop all but a few at the gate.
    """

    read: Callable[[bytes, Path], object]
    seeds: Callable[[], list[bytes]]
    refusals: tuple[type[Exception], ...] = (DqpaintError,)
    words: tuple[bytes, ...] = ()
    ending: str = ".txt"
    mended: Callable[[bytes], bytes] = bytes


def attempt(reader: Reader, data: bytes, path: Path) -> bool:
    """Read bytes; whether they were taken. What is a fault is raised."""
    path.write_bytes(data)
    try:
        reader.read(data, path)
    except reader.refusals as refusal:
        if not str(refusal):
            raise AssertionError("it is refused without a word") from refusal
        for finding in getattr(refusal, "diagnostics", ()):
            assert finding.code != "E999", finding.message
        return False
    return True


# Drawings, and what they name.


def _traj(data: bytes, path: Path) -> None:
    finite(parse(decoded(data, path.name), "fuzz.traj", HERE).segments)


def _editor(data: bytes, path: Path) -> None:
    """What an editor asks of a text, at a place that its length makes."""
    text = decoded(data, path.name)
    at = len(data) * 7919 % (len(text) + 1)
    assert all(entry.word for entry in completion.completions(text, at))
    completion.meaning_at(text, at)
    found = analyse(text, "fuzz.traj", False)
    for one in found.diagnostics:
        assert one.code != "E999", one.message
        assert one.span is None or 0 <= one.span.start <= one.span.end <= len(found.source)
    with suppress(ScriptError):
        made = formatted(text)
        assert formatted(made) == made


def _svg(data: bytes, _path: Path) -> None:
    drawing, _ = svg_reader._read.__wrapped__(data, len(data) % 2 == 0)
    for line in drawing.lines:
        finite(line[0])


def _points(data: bytes, _path: Path) -> None:
    finite(point_files._numbers_in.__wrapped__("a.csv", data, Span(0, 0)))


def _recorded(_data: bytes, path: Path) -> None:
    found = read_recording(str(path), tuple("1234567"))
    finite(found.t)
    finite([part for part in (found.postures, found.poses, found.commands) if part is not None])


def _bags() -> list[bytes]:
    made = bags.BagWriter()
    for k in range(5):
        state = bags.Encoder(k * 10**7).texts("1234567").sequence([0.1 * k] * 7)
        made.add("/joint_states", bags.JOINT_STATE, k * 10**7, state.sequence([]).sequence([]))
    return [made.finish()]


def _table(_data: bytes, path: Path) -> None:
    table = NumberTable(str(path), "table")
    finite(table.columns(table.names))


def _settings(_data: bytes, path: Path) -> None:
    settings_file.read_given(str(path), lambda _: None, "leave")


def _messages(data: bytes, _path: Path) -> None:
    """However broken, it ends, makes nothing longer, and the next message comes out whole."""
    assert sum(len(body) for body in messages(io.BytesIO(data))) <= len(data) + 2 * data.count(b":")
    last = b'{"jsonrpc": "2.0", "method": "x"}'
    *_, found = messages(io.BytesIO(data + b"\r\nContent-Length: 33\r\n\r\n" + last))
    assert json.loads(found[found.rfind(b'{"jsonrpc') :] or found)


# Pictures and films.


def _image(_data: bytes, path: Path) -> None:
    finite(images.columns(str(path), 8))


def _film(_data: bytes, path: Path) -> None:
    found = film_file.read(str(path))
    for sweep in found.scene.light:
        finite([sweep.pose, sweep.colours])


def png_with_sums(data: bytes) -> bytes:
    """A PNG whose pieces have the sums they need; anything else as it is."""
    if not data.startswith(b"\x89PNG\r\n\x1a\n"):
        return data
    out, at = bytearray(data[:8]), 8
    while at + 12 <= len(data):
        size = int.from_bytes(data[at : at + 4], "big")
        body = data[at + 4 : at + 8 + size]
        if len(data) < at + 12 + size:
            break
        out += data[at : at + 4] + body + struct.pack(">I", zlib.crc32(body))
        at += 12 + size
    return bytes(out + data[at:])


def film_with_sums(data: bytes) -> bytes:
    """A film of stored arrays whose sums fit: what stands in them is what is tried."""
    try:
        with zipfile.ZipFile(io.BytesIO(data)) as packed:
            members = packed.infolist()
    except Exception:  # zipfile has many
        return data
    out = bytearray(data)
    for one in members:
        begin = one.header_offset
        head = data[begin : begin + 30]
        if len(head) < 30 or one.compress_type != zipfile.ZIP_STORED or one.file_size > len(data):
            continue
        names, extra = struct.unpack("<HH", head[26:30])
        first = begin + 30 + names + extra
        total = zlib.crc32(data[first : first + one.compress_size])
        out = out.replace(struct.pack("<I", one.CRC), struct.pack("<I", total))
    return bytes(out)


@cache
def _film_seeds() -> list[bytes]:
    import dqpaint

    text = "period 50 ms\nline to (30, 10) mm in 0.4 s light red to blue\n"
    made = []
    with tempfile.TemporaryDirectory() as name:
        drawing = Path(name) / "a.traj"
        drawing.write_text(text)
        for choices in ({}, {"brush": "bar:length=100mm,leds=3", "pwm": 100.0}, {"overlay": True}):
            done = dqpaint.draw(drawing, plant="ideal", size=(64, 36), **choices)
            arrays = dict(np.load(io.BytesIO(film_file.encode(
                done.scene, done.settings, done.arm_motion))))  # fmt: skip
            packed = io.BytesIO()
            np.savez(packed, **arrays)
            made.append(packed.getvalue())
    return made


def _image_seeds() -> list[bytes]:
    import cv2

    rng = np.random.default_rng(3)
    picture = rng.integers(0, 256, (7, 9, 3), dtype=np.uint8)
    made = []
    for kind in (".png", ".jpg", ".bmp", ".webp", ".tiff", ".ppm", ".pgm", ".pbm"):
        grey = kind in (".pgm", ".pbm")
        made.append(cv2.imencode(kind, picture[..., 0] if grey else picture)[1].tobytes())
    made.append(cv2.imencode(".hdr", picture.astype(np.float32))[1].tobytes())
    made.append(cv2.imencode(".pfm", picture.astype(np.float32))[1].tobytes())
    made.append(b"GIF89a\x02\0\x02\0\x80\0\0\xff\0\0\0\0\xff,\0\0\0\0\x02\0\x02\0\0\x02\x02D\n\0;")
    return made


# Arms.


def _end(tree: Tree) -> str:
    """The link that carries the light."""
    return "tip" if "tip" in tree.links else load_file._only_tip(tree)


def _urdf(data: bytes, path: Path) -> None:
    tree = Tree(path)
    link = _end(tree)
    finite(tuple(tuple(numbers) for numbers in load_file._limits(tree, link).values()))


def _card(_data: bytes, path: Path) -> None:
    raw = load_file._read_toml(path)
    if "urdf" in raw:
        raise DqpaintError("it names a file")
    finite(load_file._validate({"name": "a", "title": "a", "source": "a", "licence": "", **raw},
                               path).home)  # fmt: skip


def _mesh(ending: str) -> Callable[[bytes, Path], None]:
    def read(data: bytes, path: Path) -> None:
        meshes._check.cache_clear()
        found = meshes.check_mesh(path)
        assert found.triangles > 0
        assert math.isfinite(found.extent)
        if not found.tried:
            assert ending != ".dae"

    return read


def mesh_by_libraries(data: bytes, path: Path) -> None:
    """A mesh that passes is read by coal and PyBullet, too, which may not die of it."""
    from dqpaint.plants.engines.pybullet_client import Client, bullet, quiet
    from dqpaint.robots.kinematics.collisions import read_mesh

    meshes._check.cache_clear()
    if meshes.check_mesh(path).tried:
        raise meshes.MeshError("is tried in a process of its own")
    with suppress(ValueError):
        finite(read_mesh(str(path), (1.0, 1.0, 1.0))[0])
    with Client() as client, quiet():
        world = client.client
        for make, word in (
            (bullet.createCollisionShape, "collision"), (bullet.createVisualShape, "visual"),
        ):  # fmt: skip
            with suppress(bullet.error):
                make(bullet.GEOM_MESH, fileName=str(path), physicsClientId=world)
            assert word


def urdf_by_libraries(_data: bytes, path: Path) -> None:
    """A description that passes is prepared, and read by pinocchio and PyBullet."""
    import pinocchio

    from dqpaint.plants.engines.pybullet_client import Client, bullet, quiet
    from dqpaint.robots.kinematics.kinematics import Kinematics
    from dqpaint.robots.urdf.prepare import prepare, urdf_file

    tree = Tree(path)
    link = _end(tree)
    limits = load_file._limits(tree, link)
    card = load_file._validate(
        {"name": "a", "title": "a", "source": "a", "licence": "", "tool": {}, "limits": limits,
         "urdf": {"file": str(path), "link": link}, "home_deg": load_file._middles(limits),
         "canvas": load_file.PLACEHOLDER_CANVAS}, path,
    )  # fmt: skip
    text = prepare(card).text
    model = Kinematics(card).model
    for kind in (pinocchio.GeometryType.COLLISION, pinocchio.GeometryType.VISUAL):
        with suppress(ValueError):
            pinocchio.buildGeomFromUrdfString(model, text, kind)
    posture = pinocchio.neutral(model)
    finite(pinocchio.crba(model, model.createData(), posture))
    with Client() as client, quiet(), urdf_file(card) as name, suppress(bullet.error):
        bullet.loadURDF(name, physicsClientId=client.client)


# Studies.


def _journal(data: bytes, path: Path) -> None:
    folder = path.parent / "study"
    folder.mkdir(exist_ok=True)
    (folder / journal.NAME).write_bytes(data)
    found = journal.Journal(folder)
    try:
        for result in found.results.values():
            finite(tuple(result.figures.values()))
            assert journal.decode_line(journal.encode_line(result)) == result
    finally:
        found.close()
        for left in folder.iterdir():
            left.unlink()


def journal_with_sums(data: bytes) -> bytes:
    """A journal whose lines have the hashes they need, if its length is odd."""
    if len(data) % 2:
        return data
    rest = len(journal.HEAD) + journal.DIGITS + 3
    return b"\n".join(
        journal.HEAD + journal._hash(line[rest:]) + b'", ' + line[rest:]
        if line.startswith(journal.HEAD) and len(line) > rest else line
        for line in data.split(b"\n")
    )  # fmt: skip


def _journal_seeds() -> list[bytes]:
    from dqpaint.studies.runner.run import Result

    results = [
        Result(f"{k:032x}", "done", "", {"position_error_rms_m": 0.001 * k, "b": -1e-300}, wall=0.5)
        for k in range(3)
    ]
    lines = b"".join(map(journal.encode_line, results))
    return [lines, lines[:-30], lines + b"\n", b'{"key": "a", "status": "done"}\n']


def _texts(*texts: str) -> Callable[[], list[bytes]]:
    return lambda: [text.encode() for text in texts]


def _files(*patterns: str) -> Callable[[], list[bytes]]:
    root = Path(__file__).parents[2]

    def seeds() -> list[bytes]:
        found = [path.read_bytes() for pattern in patterns for path in sorted(root.glob(pattern))]
        return [data for data in found if len(data) <= SMALLEST_BYTES]

    return seeds


def _words(text: str) -> tuple[bytes, ...]:
    return tuple(word.encode() for word in text.split())


def _q(names: Iterator[str]) -> str:
    head = ",".join(["t_s", *names])
    rows = [f"{0.1 * k:.2f}," + ",".join("0.1" for _ in head.split(",")[1:]) for k in range(4)]
    return "\n".join([head, *rows]) + "\n"


def _poses() -> str:
    return "t_s;x_m;y_m;z_m;qw;qx;qy;qz\n0;0.5;0;0.5;1;0;0;0\n0.1;0.5;0.1;0.5;0;1;0;0\n"


SETTINGS = """dqpaint = "0.2"
view = "iso"
controller = "p"
size = "64x36"
exposure = "f/8,iso100,35mm,0.05cd"
gain.k = 20
[disturb]
twist = "sine,x=0.02,frequency=2"
"""
SUMMARY = ('{"schema": "dqpaint-run-2", "sha256": "00", "versions": {"dqpaint": "0.2"}, '
           '"settings": {"width": 64, "height": 36, "gains": {"k": 20.0}}}')  # fmt: skip
FRAMES = "".join(
    f"Content-Length: {len(body)}\r\n\r\n{body}"
    for body in ('{"jsonrpc": "2.0", "id": 1, "method": "a", "params": {"text": "x\\r\\n"}}',
                 '{"jsonrpc": "2.0", "method": "exit"}')
)  # fmt: skip
MESHED = arm_urdf().replace(
    "</link>", '<visual><geometry><box size="0.1 0.1 0.2"/></geometry></visual><collision><origin '
    'xyz="0 0 0.1" rpy="0 1 0"/><geometry><cylinder radius="0.04" length="0.2"/></geometry>'
    "</collision></link>", 2,
)  # fmt: skip
XML_WORDS = _words('< > /> </ = " <!-- --> <![CDATA[ ]]> &lt; &#0; &a; <!DOCTYPE <!ENTITY <?xml')
NUMBERS = _words(
    "0 -1 1 2 1e9 -1e9 1e-9 1e308 1e400 5e-324 nan inf -inf 0x10 1_0 ٣ 1,5 999999999999"
)
URDF_WORDS = _words(
    "name= link joint type= revolute prismatic fixed floating parent child origin xyz= rpy= axis "
    "limit lower= upper= velocity= effort= inertial mass value= inertia ixx= visual collision "
    "geometry box size= sphere radius= cylinder length= capsule mesh filename= scale= mimic "
    "dynamics damping= friction= material color rgba= transmission safety_controller"
)

READERS = {
    "drawing": Reader(_traj, lambda: [*map(str.encode, (STAR, ROSE, MIXED, WHOLE)),
                                      *_files("trajectories/*.traj")()],
                      words=_words("( ) , + - * / ^ mm deg s rad by to via light tool end repeat "
                                   "let def with frame curve for in samples blend brush strobe"),
                      ending=".traj"),
    "editor": Reader(_editor, lambda: [*map(str.encode, (STAR, MIXED, WHOLE))], ending=".traj"),
    "svg": Reader(_svg, _files("tests/language/files/*.svg"), (SvgError,),
                  (*XML_WORDS, *_words(
                      "M L C A Z m l c s q t a z h v path d= g use href= #a id= transform= scale( "
                      "rotate( matrix( ) viewBox= style= stroke= none url(#a) symbol svg 50% 1em")),
                  ".svg"),
    "points": Reader(_points, _texts("x,y\n0,0\n1,2\n3,4.5\n", "0;0,5\n1;2,5\n", "1 2 3\n4 5 6\n",
                                     "# a\n\n1\t2\n3\t4 # b\n"), (Problem,),
                     _words("# ; , . e5 nan 1_0"), ".csv"),
    "recorded run": Reader(_recorded, _texts(
        _q(f"q{k}_rad" for k in range(1, 8)), _q(f"q{k}_deg" for k in range(1, 8)), _poses()),
        words=_words("# , ; t_s q1_rad q1_deg x_m qw command1_rad_s torque1_Nm"), ending=".csv"),
    "recorded bag": Reader(_recorded, _bags, ending=".mcap"),
    "table": Reader(_table, _texts("t_s,a_m\n0,1\n1,2\n", '"a";b\n1;2\n'), ending=".csv"),
    "settings, TOML": Reader(_settings, _texts(SETTINGS, "[gain]\nk = 3\n"),
                             words=_words("= [ ] { } \" ' . controller plant brush size view look "
                                          "gain disturb true false 1979-05-27 mine.py image="),
                             ending=".toml"),
    "settings, JSON": Reader(_settings, _texts(SUMMARY),
                             words=_words('{ } [ ] : , " null true NaN Infinity gains disturb'),
                             ending=".json"),
    "messages of an editor": Reader(_messages, _texts(FRAMES, FRAMES.replace("36", "3")),
                                    words=(b"Content-Length: ", b"\r\n", b"\r\n\r\n", b"{", b"}",
                                           b'"', b"[", b"]", b"\\", b"\xff")),
    "image": Reader(_image, _image_seeds, ending=".png", mended=png_with_sums),
    "film": Reader(_film, _film_seeds, ending=".npz", mended=film_with_sums,
                   words=_words("<f8 <f4 <i8 |O <U9 True False shape descr , (0, [ ] { } null")),
    "URDF": Reader(_urdf, lambda: [arm_urdf().encode(), arm_urdf(4).encode(), MESHED.encode()],
                   words=(*XML_WORDS, *URDF_WORDS), ending=".urdf"),
    "robot card": Reader(_card, _files("dqpaint/robots/cards/*.toml"),
                         words=_words("= [ ] { } \" [limits] [tool] [canvas] [body] at_m rpy_deg "
                                      "lower_deg home_deg a_m d_m alpha_deg convention modified"),
                         ending=".toml"),
    "mesh, OBJ": Reader(_mesh(".obj"), lambda: [OBJ], (meshes.MeshError,),
                        _words("v vt vn f l g o usemtl mtllib / // -1 0"), ".obj"),
    "mesh, STL": Reader(_mesh(".stl"), lambda: [stl(), stl(1)], (meshes.MeshError,), (), ".stl"),
    "mesh, Collada": Reader(_mesh(".dae"), lambda: [DAE.encode()], (meshes.MeshError,),
                            XML_WORDS, ".dae"),
    "journal": Reader(_journal, _journal_seeds, mended=journal_with_sums,
                      words=_words('{ } : , " NaN null done failed figures key status message')),
    "URDF, by the libraries": Reader(
        urdf_by_libraries, lambda: [arm_urdf().encode(), MESHED.encode()],
        words=(*NUMBERS, *URDF_WORDS), ending=".urdf"),
    "OBJ, by the libraries": Reader(mesh_by_libraries, lambda: [OBJ], (meshes.MeshError,),
                                    _words("v vt vn f / // -1"), ".obj"),
    "STL, by the libraries": Reader(mesh_by_libraries, lambda: [stl(), stl(1)],
                                    (meshes.MeshError,), (), ".stl"),
}  # fmt: skip


def corpus(name: str) -> list[bytes]:
    """The seeds of a reader, with those that were kept since they once did harm or found a way."""
    kept = CORPUS / re.sub(r"\W+", "-", name.lower())
    files = sorted(kept.iterdir()) if kept.is_dir() else []
    return [*READERS[name].seeds(), *(file.read_bytes() for file in files)]

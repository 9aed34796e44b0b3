"""Numbers -> ROS 2 messages in an MCAP file, and back: bags, without ROS.

Messages are encoded here, as CDR (OMG DDSI-RTPS 2.3, section 10): fields in order, each on a
multiple of its own size, counted from behind the four bytes that say which end comes first. The
container is the library mcap's.
"""

import io
import struct
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from importlib.util import find_spec
from typing import TYPE_CHECKING, Any, NamedTuple

from dqpaint.errors import DqpaintError, UsageError

if TYPE_CHECKING:
    from mcap.records import Chunk, McapRecord

LARGEST_UNPACKED = 1_000_000_000  # bytes of all chunks of a file
LARGEST_CHUNK = 100_000_000
MAGIC = b"\x89MCAP0\r\n"
JOINT_STATE = "sensor_msgs/msg/JointState"
HEAD = b"\x00\x01\x00\x00"  # little end first
CUT_OFF = ("EndOfFile", "RecordLengthLimitExceeded")  # a record would be longer than the file
SECOND = 1_000_000_000  # [ns]

_HEADER = "builtin_interfaces/Time stamp\nstring frame_id\n"
_TIME = "int32 sec\nuint32 nanosec\n"
_VECTOR = "float64 x\nfloat64 y\nfloat64 z\n"
_STAMPED = {"std_msgs/Header": _HEADER, "builtin_interfaces/Time": _TIME}
_POSE = "geometry_msgs/Point position\ngeometry_msgs/Quaternion orientation\n"
_TWIST = "geometry_msgs/Vector3 linear\ngeometry_msgs/Vector3 angular\n"
DEFINITIONS: dict[str, tuple[str, dict[str, str]]] = {
    JOINT_STATE: (
        "std_msgs/Header header\nstring[] name\nfloat64[] position\nfloat64[] velocity\n"
        "float64[] effort\n",
        _STAMPED,
    ),
    "geometry_msgs/msg/PoseStamped": (
        "std_msgs/Header header\ngeometry_msgs/Pose pose\n",
        {
            **_STAMPED,
            "geometry_msgs/Pose": _POSE,
            "geometry_msgs/Point": _VECTOR,
            "geometry_msgs/Quaternion": _VECTOR + "float64 w\n",
        },
    ),
    "geometry_msgs/msg/TwistStamped": (
        "std_msgs/Header header\ngeometry_msgs/Twist twist\n",
        {**_STAMPED, "geometry_msgs/Twist": _TWIST, "geometry_msgs/Vector3": _VECTOR},
    ),
    "std_msgs/msg/ColorRGBA": ("float32 r\nfloat32 g\nfloat32 b\nfloat32 a\n", {}),
    "sensor_msgs/msg/CompressedImage": (
        "std_msgs/Header header\nstring format\nuint8[] data\n",
        _STAMPED,
    ),
}
"""What a type is made of: its own fields, and those of the types in it."""


class BagError(DqpaintError):
    """A file is no sound bag."""


class JointStates(NamedTuple):
    """One message of joints; velocity or effort may be empty."""

    stamp: int  # [ns]
    names: list[str]
    position: list[float]
    velocity: list[float]
    effort: list[float]


@dataclass(frozen=True)
class Topic:
    """The messages of one topic: log times [ns] and bodies, in the order of the file."""

    kind: str
    messages: list[tuple[int, bytes]]


def check_installed() -> None:
    """Refuse where the library is not installed.

    Raises:
        UsageError: it is not.
    """
    if find_spec("mcap") is None:
        raise UsageError("bags need the library mcap: pip install 'dqpaint[bags]'")


class Encoder:
    """One message, field by field.

    Args:
        stamp: of its header [ns]; None for a message without one.
        frame: of its header.
    """

    def __init__(self, stamp: int | None, frame: str = "") -> None:
        self._out = bytearray(HEAD)
        if stamp is not None:
            self._pack("i", (stamp // SECOND,))
            self._pack("I", (stamp % SECOND,))
            self.text(frame)

    def _pack(self, kind: str, values: Sequence[float]) -> None:
        self._out += bytes(-(len(self._out) - len(HEAD)) % struct.calcsize("<" + kind))
        self._out += struct.pack(f"<{len(values)}{kind}", *values)

    def floats(self, values: Sequence[float], kind: str = "d") -> "Encoder":
        """Numbers side by side: `d` for float64, `f` for float32."""
        self._pack(kind, values)
        return self

    def text(self, value: str) -> "Encoder":
        """A string."""
        data = value.encode() + b"\0"
        self._pack("I", (len(data),))
        self._out += data
        return self

    def texts(self, values: Sequence[str]) -> "Encoder":
        """A sequence of strings."""
        self._pack("I", (len(values),))
        for value in values:
            self.text(value)
        return self

    def sequence(self, values: Sequence[float]) -> "Encoder":
        """A sequence of float64; one of none has nothing behind its count, no padding either."""
        self._pack("I", (len(values),))
        return self.floats(values) if len(values) else self

    def data(self, value: bytes) -> "Encoder":
        """A sequence of bytes."""
        self._pack("I", (len(value),))
        self._out += value
        return self

    @property
    def body(self) -> bytes:
        """The message."""
        return bytes(self._out)


class BagWriter:
    """An MCAP file of ROS 2 messages; `finish` gives its bytes."""

    def __init__(self) -> None:
        from mcap.writer import Writer

        self._bytes = io.BytesIO()
        self._writer = Writer(self._bytes)
        self._writer.start(profile="ros2", library="dqpaint")
        self._schemas: dict[str, int] = {}
        self._channels: dict[str, int] = {}

    def add(self, topic: str, kind: str, time: int, message: Encoder) -> None:
        """A message of a type of `DEFINITIONS`, at a time [ns]."""
        if kind not in self._schemas:
            own, parts = DEFINITIONS[kind]
            rule = "=" * 80
            text = own + "".join(f"{rule}\nMSG: {name}\n{has}" for name, has in parts.items())
            self._schemas[kind] = self._writer.register_schema(kind, "ros2msg", text.encode())
        if topic not in self._channels:
            self._channels[topic] = self._writer.register_channel(
                topic, "cdr", self._schemas[kind], {"offered_qos_profiles": ""}
            )
        self._writer.add_message(self._channels[topic], time, message.body, time)

    def finish(self) -> bytes:
        """The bytes of the whole file."""
        self._writer.finish()  # type: ignore[no-untyped-call]
        return self._bytes.getvalue()


def read_topics(name: str, data: bytes, kind: str) -> tuple[dict[str, Topic], list[str]]:
    """The topics of a type in an MCAP file by their names, and all topics with their types.

    Raises:
        UsageError: the library is not installed.
        BagError: the file is cut off, its sums are wrong, or it would unpack to too much.
    """
    check_installed()
    found: dict[str, Topic] = {}
    schemas: dict[int, str] = {}
    channels: dict[int, Any] = {}
    try:
        for record in _records(name, data):
            what = type(record).__name__
            if what == "Schema":
                schemas[record.id] = record.name
            elif what == "Channel":
                channels[record.id] = record
                if schemas.get(record.schema_id) == kind:
                    if record.message_encoding != "cdr":
                        raise BagError(
                            f"{name}: {record.topic} is encoded as "
                            f"'{record.message_encoding[:20]}', not as cdr"
                        )
                    found.setdefault(record.topic, Topic(kind, []))
            elif what == "Message" and record.channel_id in channels:
                topic = found.get(channels[record.channel_id].topic)
                if topic is not None:
                    topic.messages.append((record.log_time, record.data))
    except DqpaintError:
        raise
    except Exception as problem:  # the library's own, struct's, zlib's, of compression
        raise _unsound(name, problem, found) from None
    every = [f"{one.topic} ({schemas.get(one.schema_id, '?')})" for one in channels.values()]
    return found, sorted(set(every))


def _unsound(name: str, problem: Exception, found: dict[str, Topic]) -> BagError:
    """The sentence about a file that cannot be read to its end."""
    whole = max((len(one.messages) for one in found.values()), default=0)
    if type(problem).__name__ in CUT_OFF:
        return BagError(
            f"{name} ends in the middle, as if its recorder had been stopped, after {whole} whole "
            f"messages of joints; 'mcap recover {name} -o whole.mcap' keeps what is there"
        )
    reason = " ".join(str(problem).split())[:80]
    return BagError(f"{name} is no sound MCAP file ({reason}), after {whole} messages of joints")


def _records(name: str, data: bytes) -> Iterator[Any]:
    """The records of a file, those in chunks one by one; nothing unpacks to more than it says."""
    from mcap.exceptions import EndOfFile
    from mcap.stream_reader import StreamReader, breakup_chunk

    unpacked = 0
    ended = False
    reader = StreamReader(io.BytesIO(data), emit_chunks=True, record_size_limit=len(data))
    for record in reader.records:
        what = type(record).__name__
        ended = ended or what == "DataEnd"
        if what == "Chunk":
            unpacked += record.uncompressed_size  # type: ignore[attr-defined]
            yield from breakup_chunk(_unpacked(name, record, unpacked), validate_crc=True)
        else:
            yield record
    if not ended:
        raise EndOfFile


def _unpacked(name: str, record: "McapRecord", total: int) -> "Chunk":
    """A chunk with its data unpacked, no further than its own size."""
    chunk: Chunk = record  # type: ignore[assignment]
    size = chunk.uncompressed_size
    if size > LARGEST_CHUNK or total > LARGEST_UNPACKED:
        most = LARGEST_CHUNK if size > LARGEST_CHUNK else LARGEST_UNPACKED
        raise BagError(
            f"{name} would unpack to more than {most:.0e} bytes; keep the joints alone: "
            f"'mcap filter {name} -y /joint_states -o joints.mcap'"
        )
    if chunk.compression == "zstd":
        import zstandard

        whole = zstandard.ZstdDecompressor().stream_reader(chunk.data).read(size + 1)
    elif chunk.compression == "lz4":
        import lz4.frame

        whole = lz4.frame.LZ4FrameDecompressor().decompress(chunk.data, max_length=size + 1)
    elif chunk.compression == "":
        whole = chunk.data
    else:
        raise BagError(f"{name} is packed by '{chunk.compression[:20]}', not by zstd or lz4")
    if len(whole) != size:
        raise BagError(f"{name} has a chunk of another size than it says, {size} bytes")
    return replace(chunk, compression="", data=whole)


class _Decoder:
    """The fields of one message in turn; none reaches beyond its end."""

    def __init__(self, body: bytes) -> None:
        if len(body) < len(HEAD) or body[0] != 0 or body[1] not in (0, 1):
            raise BagError("it does not begin as CDR does")
        self._end = "<" if body[1] else ">"
        self._body, self._at = body[len(HEAD) :], 0

    def numbers(self, kind: str, count: int = 1) -> list[Any]:
        size = struct.calcsize("<" + kind)
        self._at += -self._at % size if count else 0
        stop = self._at + count * size
        if stop > len(self._body):
            raise BagError("it is shorter than its fields")
        values = struct.unpack_from(f"{self._end}{count}{kind}", self._body, self._at)
        self._at = stop
        return list(values)

    def text(self) -> str:
        [size] = self.numbers("I")
        stop = self._at + size
        if stop > len(self._body):
            raise BagError("it is shorter than its fields")
        value = self._body[self._at : stop].rstrip(b"\0").decode("utf-8", "replace")
        self._at = stop
        return value

    def texts(self) -> list[str]:
        [count] = self.numbers("I")
        if count > len(self._body):
            raise BagError("it is shorter than its fields")
        return [self.text() for _ in range(count)]

    def sequence(self) -> list[float]:
        [count] = self.numbers("I")
        return self.numbers("d", count)


def joint_states(body: bytes) -> JointStates:
    """A message of type sensor_msgs/JointState.

    Raises:
        BagError: it is none.
    """
    fields = _Decoder(body)
    [seconds], [nanoseconds] = fields.numbers("i"), fields.numbers("I")
    fields.text()
    return JointStates(
        seconds * SECOND + nanoseconds,
        fields.texts(),
        fields.sequence(),
        fields.sequence(),
        fields.sequence(),
    )

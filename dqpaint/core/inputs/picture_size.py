"""Bytes of a picture file -> its width and height, from its header, before it is decoded.

A file of some kB can claim, and then really need, gigabytes of pixels.
"""

import re
import struct
from typing import Literal, NamedTuple

PNG = b"\x89PNG\r\n\x1a\n"
FRAMES = {*range(0xC0, 0xD0)} - {0xC4, 0xC8, 0xCC}  # markers of JPEG with the size
BARE = {0x01, *range(0xD0, 0xD9)}  # markers of JPEG without a length
TILES = (256, 257, 322, 323)  # tags of TIFF: width and height of the picture, of a tile
SHORT, LONG = 3, 4  # types of numbers of TIFF
ORDERS: dict[str, Literal["little", "big"]] = {"<": "little", ">": "big"}
DIRECTORY_ENTRIES = 4096  # of TIFF; libtiff takes no more


class PictureSize(NamedTuple):
    """Kind of a picture file, and its size.

    Attributes:
        kind: such as PNG.
        width: [px].
        height: [px].
    """

    kind: str
    width: int
    height: int


def picture_size(data: bytes) -> PictureSize | None:
    """The size of a picture, as its header has it; None for a kind that is not known here.

    Args:
        data: PNG, JPEG, BMP, WebP, TIFF, GIF, PNM, PFM or Radiance.
    """
    for kind, begins, read in READERS:
        if data.startswith(begins):
            try:
                size = read(data)
            except (struct.error, IndexError, ValueError):
                return None
            return None if size is None else PictureSize(kind, *size)
    return None


Size = tuple[int, int]


def _png(data: bytes) -> Size | None:
    return struct.unpack(">II", data[16:24]) if data[12:16] == b"IHDR" else None


def _jpeg(data: bytes) -> Size | None:
    """Of its frame; each marker before it says how far the next one is."""
    at = 2
    while at + 9 <= len(data) and data[at] == 0xFF:
        marker = data[at + 1]
        if marker in FRAMES:
            height, width = struct.unpack(">HH", data[at + 5 : at + 9])
            return width, height
        if marker == 0xFF:  # padding
            at += 1
        elif marker in BARE:
            at += 2
        else:
            at += 2 + int(struct.unpack(">H", data[at + 2 : at + 4])[0])
    return None


def _bmp(data: bytes) -> Size | None:
    if struct.unpack("<I", data[14:18])[0] < 16:  # of OS/2
        return struct.unpack("<HH", data[18:22])
    width, height = struct.unpack("<ii", data[18:26])
    return abs(width), abs(height)


def _webp(data: bytes) -> Size | None:
    kind, body = data[12:16], data[20:30]
    if data[8:12] != b"WEBP" or len(body) < 10:
        return None
    if kind == b"VP8X":
        return 1 + int.from_bytes(body[4:7], "little"), 1 + int.from_bytes(body[7:10], "little")
    if kind == b"VP8L":
        bits = int.from_bytes(body[1:5], "little")
        return 1 + (bits & 0x3FFF), 1 + (bits >> 14 & 0x3FFF)
    width, height = struct.unpack("<HH", body[6:10])
    return width & 0x3FFF, height & 0x3FFF


def _tiff(data: bytes) -> Size | None:
    """The first picture, or its tiles if they are larger."""
    sign = "<" if data[:1] == b"I" else ">"
    (at,) = struct.unpack(f"{sign}I", data[4:8])
    (count,) = struct.unpack(f"{sign}H", data[at : at + 2])
    found = dict.fromkeys(TILES, 0)
    for k in range(min(count, DIRECTORY_ENTRIES)):
        entry = data[at + 2 + 12 * k : at + 14 + 12 * k]
        tag, kind, _ = struct.unpack(f"{sign}HHI", entry[:8])
        if tag in found and kind in (SHORT, LONG):
            value = entry[8:12] if kind == LONG else entry[8:10]
            found[tag] = max(found[tag], int.from_bytes(value, ORDERS[sign]))
    width, height, tile_width, tile_height = (found[tag] for tag in TILES)
    return (max(width, tile_width), max(height, tile_height)) if width and height else None


def _gif(data: bytes) -> Size | None:
    return struct.unpack("<HH", data[6:10])


def _text_header(data: bytes) -> Size | None:
    """Of PNM and PFM: two numbers after the kind, with remarks between."""
    head = data[2:4096]
    if re.search(rb"#[^\n]*\r", head):  # where such a remark ends, libraries see differently
        return None
    words = re.sub(rb"#[^\n]*", b" ", head).split(None, 2)
    return int(words[0]), int(words[1])


def _radiance(data: bytes) -> Size | None:
    """The largest of all that could be taken for its size."""
    said = [(int(x), int(y)) for y, x in re.findall(rb"-Y\s*\+?(\d+)\s*\+X\s*\+?(\d+)", data)]
    return (max(x for x, _ in said), max(y for _, y in said)) if said else None


READERS = (
    ("PNG", PNG, _png),
    ("JPEG", b"\xff\xd8\xff", _jpeg),
    ("BMP", b"BM", _bmp),
    ("WebP", b"RIFF", _webp),
    ("TIFF", (b"II*\0", b"MM\0*"), _tiff),
    ("GIF", (b"GIF87a", b"GIF89a"), _gif),
    ("PNM", (b"P1", b"P2", b"P3", b"P4", b"P5", b"P6"), _text_header),
    ("PFM", (b"PF", b"Pf"), _text_header),
    ("Radiance", b"#?", _radiance),
)

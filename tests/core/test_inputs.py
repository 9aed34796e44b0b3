"""Files of others are read within limits that are known before anything is allocated."""

import errno
import os
import random
import socket
import struct

import cv2
import numpy as np
import pytest

from dqpaint.core.inputs import parse_xml, picture_size, read_regular, stat_regular, xml_tree

LIMIT = 1000
OTHERS = {
    "pipe": "a pipe", "link": "a pipe", "zeros": "a device", "socket": "a socket",
    ".": "directory", "gone": "No such file", "x" * 5000: "too long", "a\0b": "this name",
    "\ud800": "this name",
}  # fmt: skip
BOTH = pytest.mark.parametrize("read", [read_regular, stat_regular])


@BOTH
@pytest.mark.parametrize(("size", "fits"), [(0, True), (LIMIT, True), (LIMIT + 1, False)])
def test_a_limit_holds_at_its_edge(tmp_path, read, size, fits):
    path = tmp_path / "a"
    path.write_bytes(bytes(size))
    (tmp_path / "link").symlink_to(path)
    for name in (path, str(path), tmp_path / "link"):
        if fits:
            found = read(name, LIMIT)
            assert found == size if read is stat_regular else found == bytes(size)
            continue
        with pytest.raises(OSError, match="1 kB") as problem:
            read(name, LIMIT)
        assert problem.value.errno == errno.EFBIG


@BOTH
def test_only_files_are_opened(tmp_path, read, monkeypatch):
    os.mkfifo(tmp_path / "pipe")
    (tmp_path / "link").symlink_to(tmp_path / "pipe")
    (tmp_path / "zeros").symlink_to("/dev/zero")
    with socket.socket(socket.AF_UNIX) as door:
        monkeypatch.chdir(tmp_path)  # the name of a socket is short
        door.bind("socket")
        monkeypatch.setattr(os, "open", lambda *_: pytest.fail("it was opened"))
        for name, what in OTHERS.items():
            with pytest.raises(OSError, match=what):
                read(name, LIMIT)


def test_what_comes_while_it_is_opened_is_looked_at_again(tmp_path, monkeypatch):
    """A file that becomes a pipe between the look and the opening does not block."""
    path = tmp_path / "a"
    path.write_bytes(b"1")
    true_open = os.open

    def replaced(name, flags, *rest):
        path.unlink()
        os.mkfifo(path)
        return true_open(name, flags, *rest)

    monkeypatch.setattr(os, "open", replaced)
    with pytest.raises(OSError, match="pipe"):
        read_regular(path, LIMIT)


@pytest.mark.parametrize("grown", [LIMIT, LIMIT + 1])
def test_a_file_that_grows_stays_within_its_limit(tmp_path, monkeypatch, grown):
    path = tmp_path / "a"
    path.write_bytes(b"")
    true_fdopen = os.fdopen

    def growing(*given):
        path.write_bytes(bytes(grown))
        return true_fdopen(*given)

    monkeypatch.setattr(os, "fdopen", growing)
    if grown == LIMIT:
        assert len(read_regular(path, LIMIT)) == LIMIT
    else:
        with pytest.raises(OSError, match="larger"):
            read_regular(path, LIMIT)


ENDINGS = (".png", ".jpg", ".bmp", ".webp", ".tiff", ".gif", ".ppm", ".pgm", ".pbm", ".pfm", ".hdr")


@pytest.mark.parametrize("ending", ENDINGS)
def test_the_size_of_a_picture_is_that_of_its_pixels(ending):
    chance = random.Random(ending)
    for _ in range(20):
        width, height = chance.randint(1, 400), chance.randint(1, 400)
        depth = np.float32 if ending in (".pfm", ".hdr") else np.uint8
        colours = 1 if ending in (".pgm", ".pbm") else 3
        image = np.full((height, width, colours), 0.5 if depth == np.float32 else 200, depth)
        data = cv2.imencode(ending, image)[1].tobytes()
        size = picture_size(data)
        assert (size.width, size.height) == (width, height)
        for cut in range(30, 60 if ending in ENDINGS[:6] else 0):  # known from a part, or not
            part = picture_size(data[:cut])
            assert part is None or part[1:] == (width, height)


def test_sizes_that_could_be_read_in_two_ways_are_the_larger_or_none():
    fake = b"#?RADIANCE\nA=-Y 1 +X 1\nFORMAT=32-bit_rle_rgbe\n\n-Y100000   +X 100000\n"
    assert picture_size(fake)[1:] == (100_000, 100_000)
    assert picture_size(b"P5 #\r100000 100000 255\n1 1 255\n0") is None
    assert picture_size(b"P5 #a\n7 # b\n 9 255\n")[1:] == (7, 9)


def test_a_tile_of_a_tiff_counts():
    entries = [(256, 3, 5), (257, 4, 6), (322, 4, 90_000), (323, 3, 70)]
    body = b"".join(struct.pack("<HHII", tag, kind, 1, value) for tag, kind, value in entries)
    data = b"II*\0" + struct.pack("<IH", 8, len(entries)) + body
    assert picture_size(data)[1:] == (90_000, 70)


def test_no_bytes_break_the_headers():
    chance = random.Random(7)
    heads = [
        cv2.imencode(end, np.zeros((9, 8, 3), np.uint8))[1].tobytes()[:120] for end in ENDINGS[:6]
    ]
    for _ in range(3000):
        data = bytearray(chance.choice(heads))
        for _ in range(chance.randint(1, 6)):
            data[chance.randrange(2, len(data))] = chance.randrange(256)
        size = picture_size(bytes(data[: chance.randint(1, len(data))]))
        assert size is None or min(size.width, size.height) >= 0


@pytest.mark.parametrize(("depth", "count", "fits"), [
    (xml_tree.DEEPEST, 0, True), (xml_tree.DEEPEST + 1, 0, False),
    (1, xml_tree.MOST_ELEMENTS - 1, True), (1, xml_tree.MOST_ELEMENTS, False),
])  # fmt: skip
def test_nesting_and_number_of_elements_have_limits(depth, count, fits):
    data = b"<a>" * depth + b"<b/>" * count + b"</a>" * depth
    if fits:
        assert parse_xml(data).tag == "a"
    else:
        with pytest.raises(ValueError, match="more than"):
            parse_xml(data)


@pytest.mark.parametrize(("data", "what"), [
    (b'<!DOCTYPE a [<!ENTITY b "c">]><a>&b;</a>', "entities"),
    (b'<!DOCTYPE a [<!ENTITY b SYSTEM "/etc/passwd">]><a>&b;</a>', "entities"),
    (b"<a>", "element"), (b"", "element"), (b"<?xml version='1.0' encoding='no'?><a/>", "encoding"),
])  # fmt: skip
def test_other_xml_is_refused(data, what):
    with pytest.raises(ValueError, match=what):
        parse_xml(data)

"""Files: what is text, and what is said of what is not."""

from pathlib import Path

import pytest

from dqpaint.errors import DqpaintError
from dqpaint.language import ScriptError, parse, read

LINE = "line to (1, 0) mm light red # für\n"


@pytest.mark.parametrize(
    "data",
    [
        LINE.encode(),
        b"\xef\xbb\xbf" + LINE.encode(),
        LINE.replace("\n", "\r\n").encode(),
        LINE.replace("\n", "\r").encode(),
        LINE.replace(" ", "\u00a0").encode(),
        LINE.replace(" ", "\t").encode(),
    ],
)
def test_text_files(tmp_path: Path, data: bytes) -> None:
    path = tmp_path / "a.traj"
    path.write_bytes(data + data.removeprefix(b"\xef\xbb\xbf"))
    program = read(path)
    assert program.name == str(path)
    assert [s.line.line for s in program.segments] == [1]
    assert [n.code for n in program.notes] == ["W401"]


@pytest.mark.parametrize(
    ("data", "message"),
    [
        (
            b"move to (0,0)\nlet \xfc = 3",
            "line 2, byte 19 is 0xfc",
        ),
        (b"a\0b", "E307"),
        ("line".encode("utf-16"), "UTF-16"),
        (b" " * 2_000_001, "2 MB"),
    ],
)
def test_other_files(tmp_path: Path, data: bytes, message: str) -> None:
    path = tmp_path / "a.traj"
    path.write_bytes(data)
    with pytest.raises(DqpaintError) as caught:
        read(path)
    assert message in str(caught.value)
    assert str(path) in str(caught.value)


@pytest.mark.parametrize(
    ("name", "reason"),
    [("nix.traj", "no such file"), ("", "directory"), ("a\0b", "no file can have this name")],
)
def test_what_cannot_be_read(tmp_path: Path, name: str, reason: str) -> None:
    with pytest.raises(DqpaintError, match=reason):
        read(f"{tmp_path}/{name}")


def test_a_byte_order_mark_in_a_text() -> None:
    assert len(parse("\ufeff" + LINE, "a").segments) == 1


def test_the_error_names_the_file(tmp_path: Path) -> None:
    path = tmp_path / "a.traj"
    path.write_text("lin", "utf-8")
    with pytest.raises(ScriptError, match="E120") as caught:
        read(path)
    assert f"--> {path}:1:1" in str(caught.value)

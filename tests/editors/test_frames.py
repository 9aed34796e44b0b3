"""Messages are found in bytes, however they are cut, and behind those whose length is wrong."""

import io
import json

import pytest
from hypothesis import given
from hypothesis import strategies as st

from dqpaint.editors.frames import Frames, messages

BODIES = [
    {"jsonrpc": "2.0", "method": "a", "params": {"text": "ö Content-Length: 3\r\n\r\n{}"}},
    {"jsonrpc": "2.0", "id": 1, "method": "b" * 300},
    {"jsonrpc": "2.0", "id": 2, "result": None},
]


class Pieces:
    """Bytes that come in pieces of given sizes, the last one again and again."""

    def __init__(self, data, sizes):
        self._data, self._sizes = io.BytesIO(data), list(sizes)

    def read1(self, _size):
        return self._data.read(self._sizes.pop(0) if len(self._sizes) > 1 else self._sizes[0])


def encoded(body, error=0):
    data = json.dumps(body, ensure_ascii=False).encode()
    told = max(0, len(data) + error)
    return b"Content-Length: %d\r\nContent-Type: x; charset=utf-8\r\n\r\n%s" % (told, data)


def found(data, sizes=(65536,)):
    return [json.loads(body) for body in messages(Pieces(data, sizes))]


@given(st.lists(st.integers(1, 400), min_size=1, max_size=8))
def test_messages_come_out_whole_however_they_arrive(sizes):
    assert found(b"".join(map(encoded, BODIES)), sizes) == BODIES


@given(
    st.integers(0, 2), st.integers(-400, 400), st.lists(st.integers(1, 400), min_size=1, max_size=4)
)
def test_a_wrong_length_costs_no_message(which, error, sizes):
    data = b"".join(encoded(body, error * (k == which)) for k, body in enumerate(BODIES))
    assert found(data, sizes) == BODIES


@given(st.binary(max_size=200), st.lists(st.integers(1, 50), min_size=1, max_size=4))
def test_rubbish_hides_no_later_message(rubbish, sizes):
    data = rubbish + b"\r\n" + encoded(BODIES[1])
    *_, last = messages(Pieces(data, sizes))
    assert json.loads(last) == BODIES[1]


def test_a_broken_message_is_handed_on_and_the_next_is_whole():
    data = b'Content-Length: 30\r\n\r\n{"jsonrpc": "2.0", ' + encoded(BODIES[0])
    first, second = messages(io.BytesIO(data))
    assert first == b'{"jsonrpc": "2.0", '
    assert json.loads(second) == BODIES[0]


def test_an_answer_is_not_waited_for_where_the_length_is_too_long():
    """No more bytes come before this message is answered."""
    source = Pieces(encoded(BODIES[1], 1000), [65536])
    assert json.loads(next(messages(source))) == BODIES[1]


@pytest.mark.parametrize("error", [-3, 0, 3])
def test_the_stream_has_true_lengths(error):
    frames = Frames(io.BytesIO(encoded(BODIES[0], error)))
    assert frames.readline().startswith(b"Content-Length: ")
    assert frames.readline() == b"\r\n"
    assert json.loads(frames.read(10**6)) == BODIES[0]
    assert frames.readline() == b""


def test_a_header_has_one_way_to_be_read():
    """Lines with many colons before one that is none: no way through them is tried twice."""
    crooked = b"Content-Length: 3\r\n" + b"a:b:c:d: e: f \r\n" * 60 + b"\xff"
    *_, last = messages(Pieces(crooked + encoded(BODIES[0]), (65536,)))
    assert json.loads(last) == BODIES[0]

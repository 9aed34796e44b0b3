"""Links and files: what they hold comes back, and what they may not ask for is refused."""

import base64
import json
import random
import zlib

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from dqpaint.errors import UsageError
from dqpaint.studio import sharing

CHOICES = {"controller": "p", "gains": {"k": 3.0}, "plant": "compliant", "ev": 1.5, "seed": 4}


@settings(deadline=None)
@given(st.text(max_size=300).filter(lambda text: max(text, default="a") < "\ud800" or True))
def test_a_text_comes_back(text):
    text = text.encode("utf-8", "ignore").decode()
    shared = sharing.Shared("a.traj", text, CHOICES)

    assert sharing.from_link(sharing.to_link(shared)) == shared
    assert sharing.from_json(sharing.to_json(shared).encode()) == shared


@pytest.mark.parametrize(
    "choices",
    [{"controller": "mine.py"}, {"controller": "/tmp/x.py:Law"}, {"robot": "../arm.urdf"},
     {"recorded": "run.csv"}, {"plant": "x.py:P"}, {"brush": "pixelstick:image=/etc/passwd"},
     {"max_memory": 900.0}, {"timeout": 1e6}, {"nothing": 1},
     {"disturb": {"push": {"file": "a.csv"}}},
     {"ev": 1e9}, {"controller": "unheard\n--law=x.py"}],
)  # fmt: skip
def test_files_code_and_limits_are_refused(choices):
    text = json.dumps({"dqpaint_studio": 1, "name": "a", "text": "", "choices": choices})

    with pytest.raises(UsageError):
        sharing.from_json(text.encode())


def test_a_law_of_the_command_line_may_be_chosen():
    text = sharing.to_json(sharing.Shared("a", "", {"controller": "mine.py"}))

    assert sharing.from_json(text.encode(), ["mine.py"]).choices == {"controller": "mine.py"}


@pytest.mark.parametrize(
    "text",
    ["", "x", "!!!!", base64.urlsafe_b64encode(b"no zip").decode(),
     base64.urlsafe_b64encode(zlib.compress(b"[]")).decode(),
     base64.urlsafe_b64encode(zlib.compress(b'{"dqpaint_studio": 9}')).decode(),
     base64.urlsafe_b64encode(zlib.compress(b"[" * 100_000)).decode(),
     base64.urlsafe_b64encode(zlib.compress(bytes(50_000_000))).decode()],
)  # fmt: skip
def test_damaged_links_are_told(text):
    with pytest.raises(UsageError):
        sharing.from_link(text)


def test_a_long_text_is_no_link():
    text = random.Random(5).randbytes(60_000).hex()

    with pytest.raises(UsageError, match="file"):
        sharing.to_link(sharing.Shared("a", text))

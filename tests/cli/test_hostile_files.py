"""Every place that takes a file: a pipe, a device and what is far too large end in a sentence."""

import io
import os
import signal
import sys
from itertools import product

import pytest

from dqpaint.cli import main
from tests.support.arm_files import arm_urdf

LONGEST = 60  # [s]

PLACES = {
    "drawing": (("check", "{}.traj"), ".traj"),
    "include": (("check", "include.traj"), ".traj"),
    "points": (("check", "points.traj"), ".csv"),
    "svg": (("check", "svg.traj"), ".svg"),
    "image in a drawing": (("check", "image.traj"), ".png"),
    "fmt": (("fmt", "{}.traj"), ".traj"),
    "image": (("preview", "a.traj", "--brush", "pixelstick:image={}.png"), ".png"),
    "settings": (("preview", "a.traj", "--settings", "{}.toml"), ".toml"),
    "summary": (("preview", "a.traj", "--settings", "{}.json"), ".json"),
    "urdf": (("check", "a.traj", "--robot", "{}.urdf"), ".urdf"),
    "card": (("check", "a.traj", "--robot", "{}.toml"), ".toml"),
    "mesh": (("check", "a.traj", "--robot", "arm.urdf:tip"), ".stl"),
    "recorded": (("draw", "a.traj", "--recorded", "{}.csv"), ".csv"),
    "law": (("draw", "a.traj", "--controller", "{}.py"), ".py"),
    "film": (("develop", "{}.npz"), ".npz"),
    "table": (("plot", "{}.csv"), ".csv"),
}


@pytest.fixture
def call(tmp_path, monkeypatch):
    """A command in this process: its exit code, and all it printed."""
    monkeypatch.chdir(tmp_path)

    def run(*words):
        raw = io.BytesIO()
        both = io.TextIOWrapper(raw, "utf-8", write_through=True)
        for name in ("stdout", "stderr"):
            monkeypatch.setattr(sys, name, both)
            both = io.TextIOWrapper(raw, "utf-8", write_through=True)
        monkeypatch.setattr(sys, "argv", ["dqpaint", *words])
        signal.signal(signal.SIGALRM, lambda *_: pytest.fail("it waits"))
        signal.alarm(LONGEST)
        try:
            main.run()
            code = 0
        except SystemExit as stop:
            code = stop.code or 0
        finally:
            signal.alarm(0)
            sys.stdout.flush()
            sys.stderr.flush()
        return code, raw.getvalue().decode()

    return run


def make(folder):
    shape = '<visual><geometry><mesh filename="bad.stl"/></geometry></visual></link>'
    texts = {
        "a.traj": "period 50 ms\nline to (30, 0) mm in 0.5 s\n",
        "include.traj": 'include "bad.traj"\n',
        "points.traj": 'path "bad.csv" unit mm\n',
        "svg.traj": 'svg "bad.svg"\n',
        "image.traj": 'line to (9, 9) mm brush pixelstick image "bad.png"\n',
        "arm.urdf": arm_urdf().replace("</link>", shape, 1),
    }
    for name, text in texts.items():
        (folder / name).write_text(text)


@pytest.mark.parametrize(("place", "what"), list(product(PLACES, ["pipe", "device", "large"])))
def test_no_place_waits_or_fills_the_memory(call, tmp_path, place, what):
    words, ending = PLACES[place]
    make(tmp_path)
    bad = tmp_path / f"bad{ending}"
    if what == "pipe":
        os.mkfifo(bad)
    elif what == "device":
        if place in ("include", "points", "svg", "image in a drawing"):
            pytest.skip("a link that leaves the folder is refused before")
        bad.symlink_to("/dev/zero")
    else:
        with bad.open("wb") as file:
            file.truncate(10**12)  # of holes
    code, said = call(*(word.format("bad") for word in words))
    assert {"pipe": "a pipe", "device": "a device", "large": "larger than"}[what] in said
    assert "internal error" not in said
    assert code == (0 if place == "mesh" else 2 if "usage:" in said else 1)


@pytest.mark.parametrize("words", [
    ("check", "{}"), ("draw", "a.traj", "--robot", "{}"), ("draw", "a.traj", "--robot", "{}.urdf"),
    ("draw", "a.traj", "--controller", "{}.py"), ("draw", "a.traj", "--settings", "{}"),
    ("verify", "{}"), ("develop", "{}"), ("preview", "a.traj", "--brush", "pixelstick:image={}"),
])  # fmt: skip
def test_names_that_no_file_can_have(call, tmp_path, words):
    make(tmp_path)
    for name in ("n" * 5000, "\x1b[31m\x9b\u202e"):
        code, said = call(*(word.format(name) for word in words))
        assert code in (1, 2)
        assert "internal error" not in said
        assert not {"\x1b", "\x9b", "\u202e"} & set(said)


def test_what_a_drawing_says_is_shown_and_not_obeyed(call, tmp_path):
    (tmp_path / "p.csv").write_text("\x1b]0;a\x07,2\n")
    for text in (
        'line to (10,0) mm light "\x1b]0;a\x07"', 'path "\x1b[31mx.csv" unit mm',
        'include "\x1b[2J.traj"', 'path "p.csv" unit mm', "let \x9b = 3", "# \x1b[2J\nlin\x1b",
    ):  # fmt: skip
        (tmp_path / "a.traj").write_text(text + "\n")
        code, said = call("check", "a.traj")
        assert code == 1
        assert not {"\x1b", "\x07", "\x9b"} & set(said)

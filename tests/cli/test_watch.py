"""Drawn again at each save, and only then."""

import os
import pty
import signal
import subprocess
import sys
import time
from contextlib import suppress

import pytest

from dqpaint.cli.watch import watch
from dqpaint.errors import DqpaintError
from dqpaint.language import parse
from dqpaint.language.imports.dependencies import files_of

LINE = "period 20 ms\nline to (30, {}) mm in 400 ms\n"


class Over(BaseException):
    """The end of a test's script."""


def watched(path, show, *steps):
    """Run the watcher; at each look the next step is done, then nothing more until it ends."""
    script = iter(steps)

    def wait(_seconds):
        step = next(script, None)
        if step is None:
            raise Over
        step()

    with pytest.raises(Over):
        watch(path, show, wait)


@pytest.fixture
def files(tmp_path):
    drawing, included = tmp_path / "a.traj", tmp_path / "b.traj"
    drawing.write_text("hold 1 s")
    included.write_text("hold 1 s")
    return drawing, included


def idle():
    pass


def test_a_save_shows_it_again(files):
    drawing, _ = files
    shown = []

    def show():
        shown.append(drawing.read_text())

    pieces = ["hold", "hold 2", "hold 2 s"]

    def write():
        drawing.write_text(pieces.pop(0))

    watched(drawing, show, idle, idle, write, write, write, idle, idle, idle)
    assert shown == ["hold 1 s", "hold 2 s"]  # what was half written was not shown


def test_files_that_were_read_along_are_watched_too(files):
    drawing, included = files
    drawing.write_text('include "b.traj"\nlin "none.csv" "" "/" "%s"\n' % ("x" * 300))
    (drawing.parent / "points.csv").write_text("1,2\n")
    included.write_text('path "points.csv"\ninclude "a.traj"\n')
    assert {"a.traj", "b.traj", "points.csv"} <= {path.name for path in files_of(drawing)}
    shown = []
    later = drawing.parent / "none.csv"
    watched(drawing, lambda: shown.append(1), idle, lambda: included.write_text("hold 33 s"),
            idle, idle, lambda: later.write_text("1"), idle, idle, idle)  # fmt: skip
    assert len(shown) == 3


def test_settings_are_watched_too(files):
    drawing, settings = files
    shown = []
    script = iter([idle, lambda: settings.write_text("ev = 1"), idle, idle])

    def wait(_seconds):
        step = next(script, None)
        if step is None:
            raise Over
        step()

    with pytest.raises(Over):
        watch(drawing, lambda: shown.append(settings.read_text()), wait, [settings])
    assert shown == ["hold 1 s", "ev = 1"]


def test_an_editor_may_move_the_file_away_for_a_moment(files):
    drawing, other = files
    shown = []

    def show():
        shown.append(drawing.read_text())

    def back():
        os.replace(other, drawing)

    watched(drawing, show, drawing.unlink, idle, idle, back, idle, idle, idle)
    assert len(shown) == 2


def test_a_save_while_it_is_drawn_is_not_missed(files):
    drawing, _ = files
    shown = []

    def show():
        shown.append(1)
        if len(shown) == 1:
            drawing.write_text("hold 44 s")

    watched(drawing, show, idle, idle, idle)
    assert len(shown) == 2


def test_errors_are_shown_and_waited_on(files, capsys):
    drawing, _ = files

    def show():
        text = drawing.read_text()
        if "no light" in text:
            raise DqpaintError("no light is on anywhere")
        parse(text, "a.traj")

    watched(drawing, show, lambda: drawing.write_text("lin"), idle,
            lambda: drawing.write_text("no light"), idle, lambda: drawing.write_text("hold 1 s"),
            idle, idle)  # fmt: skip
    told = capsys.readouterr().err
    assert "error[E120]: unknown statement 'lin'\n --> a.traj:1:1" in told
    assert "error: no light is on anywhere" in told
    assert told.count("; Ctrl-C ends") == 4


def until(condition, seconds=20.0):
    begin = time.monotonic()
    while not condition():
        assert time.monotonic() - begin < seconds
        time.sleep(0.01)
    return time.monotonic() - begin


@pytest.mark.slow
def test_a_terminal_sees_pictures_and_errors_and_ctrl_c_ends_it(tmp_path):
    drawing, picture = tmp_path / "a.traj", tmp_path / "a-preview.png"
    drawing.write_text(LINE.format(10))
    near, far = pty.openpty()
    process = subprocess.Popen(
        [sys.executable, "-m", "dqpaint", "preview", "a.traj", "--watch", "--size", "320x180"],
        cwd=tmp_path, stdout=far, stderr=far, env={**os.environ, "COLORTERM": "truecolor"},
        preexec_fn=lambda: signal.signal(signal.SIGINT, signal.SIG_DFL),
    )  # fmt: skip
    seen = b""

    def says(text, since=0):
        nonlocal seen
        os.set_blocking(near, False)
        with suppress(BlockingIOError):
            seen += os.read(near, 1 << 20)
        return text in seen[since:]

    try:
        until(lambda: says(b"watching a.traj"))
        first, mark = picture.read_bytes(), len(seen)
        drawing.write_text("lin to (30, 20) mm\n")
        until(lambda: says(b"Ctrl-C ends", mark))
        assert seen[mark:].lstrip().startswith(b"\x1b[2J")
        assert b"unknown statement 'lin'" in seen[mark:]
        assert picture.read_bytes() == first
        times, memory = [], []
        for i in range(12):
            before, mark = picture.stat().st_mtime_ns, len(seen)
            drawing.write_text(LINE.format(20 + i))
            times.append(until(lambda b=before: picture.stat().st_mtime_ns != b))
            until(lambda m=mark: says(b"Ctrl-C ends", m))
            with open(f"/proc/{process.pid}/statm") as statm:
                memory.append(int(statm.read().split()[1]) * os.sysconf("SC_PAGE_SIZE"))
        assert picture.read_bytes() != first
        assert sorted(times)[6] < 0.5, times
        assert memory[-1] - memory[2] < 5e6, memory
        assert len(os.listdir(f"/proc/{process.pid}/fd")) < 20
        process.send_signal(signal.SIGINT)
        assert process.wait(timeout=10) == 130
        says(b"")
        assert seen.rstrip().endswith(b"interrupted")
        assert sorted(p.name for p in tmp_path.iterdir()) == ["a-preview.png", "a.traj"]
    finally:
        process.kill()
        process.wait()
        os.close(near)
        os.close(far)

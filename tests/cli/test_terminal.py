"""What a terminal shows: tables, pictures in blocks, and progress only where someone looks."""

import io
import re
import sys

import numpy as np

from dqpaint.cli import terminal


class Tty(io.StringIO):
    def isatty(self):
        return True


def colours(text):
    found = re.findall(r"38;2;(\d+);(\d+);(\d+)m\x1b\[48;2;(\d+);(\d+);(\d+)m", text)
    return np.array(found, int).reshape(-1, 2, 3)


def test_table_lines_its_values_up():
    text = terminal.table([("a", "1"), ("long name", "2")])
    assert text == "  a          1\n  long name  2"


def test_blocks_show_a_thin_line_where_it_is_and_nothing_elsewhere():
    image = np.zeros((180, 320, 3), np.uint8)
    image[90, 40:280] = (255, 0, 0)
    lines = terminal.blocks(image, 40).splitlines()
    assert len(lines) == 11
    cells = np.array([colours(line) for line in lines])  # rows, columns, upper and lower, rgb
    lit = np.argwhere(cells[..., 0] > 100)
    assert set(lit[:, 0]) == {5}
    assert set(lit[:, 1]) == set(range(5, 35))
    assert cells[..., 1:].max() == 0
    assert all(line.endswith("\x1b[0m") for line in lines)


def test_blocks_of_black_and_of_tiny_pictures():
    assert colours(terminal.blocks(np.zeros((16, 16, 3), np.uint8), 80)).max() == 0
    assert terminal.blocks(np.full((16, 16, 3), 255, np.uint8), 1)


def test_pictures_are_for_terminals_in_full_colour(monkeypatch):
    monkeypatch.setenv("TERM", "xterm-256color")
    monkeypatch.setenv("COLORTERM", "truecolor")
    monkeypatch.delenv("NO_COLOR", raising=False)
    assert terminal.shows_pictures(Tty())
    assert not terminal.shows_pictures(io.StringIO())
    monkeypatch.setenv("NO_COLOR", "1")
    assert not terminal.shows_pictures(Tty())
    monkeypatch.delenv("NO_COLOR")
    monkeypatch.setenv("COLORTERM", "")
    assert not terminal.shows_pictures(Tty())


def test_progress_tells_a_terminal_the_time_left_and_wipes_itself(monkeypatch):
    now = iter([0.0, 0.1, 3.0])
    monkeypatch.setattr(terminal.time, "monotonic", lambda: next(now))
    monkeypatch.setattr(sys, "stderr", stream := Tty())
    bar = terminal.Progress("star.traj")
    bar(0.1)
    assert stream.getvalue() == ""  # too early to say
    bar(0.25)
    assert "star.traj" in stream.getvalue()
    assert "25%  9 s left" in stream.getvalue()
    bar.__exit__()
    assert stream.getvalue().endswith("\r\x1b[K")


def test_progress_is_silent_elsewhere(monkeypatch):
    monkeypatch.setattr(sys, "stderr", stream := io.StringIO())
    bar = terminal.Progress("star.traj")
    bar._begin -= 10
    bar(0.5)
    bar.__exit__()
    assert stream.getvalue() == ""

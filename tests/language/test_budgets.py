"""Hostile and enormous files, through the command line: an answer within 2 s and 300 MB."""

import os
import resource
import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path

import pytest

MOST_SECONDS = 2.0  # of processor time, the start of the program included
MOST_BYTES = 300 << 20  # of data

LINE = "line by (1, 0) mm"
FILES = {  # the file, the exit code, what is said
    "repeats": ("repeat 9999\n" * 3 + LINE + "\nend" * 3, 1, "error[E304]"),
    "samples": (f"{LINE} samples 10000000000", 1, "error[E302]"),
    "slow": (f"{LINE} speed 1e-6 mm/s", 1, "error[E302]"),
    "brackets": ("let a = " + "(" * 5_000 + "1" + ")" * 5_000, 1, "error[E106]"),
    "opened": ("(" * 5_000_000, 1, "is larger than 2 MB"),
    "opened-2-mb": ("(" * 1_900_000, 1, "error[E120]"),
    "circle": ('include "circle.traj"', 1, "error[E273]"),
    "doubling": (
        "def a0(n)\nhold n\nend\n"
        + "".join(f"def a{i}(n)\na{i - 1}(n)\na{i - 1}(n)\nend\n" for i in range(1, 60))
        + "a59(1 s)",
        1,
        "error[E304]",
    ),
    "functions": (
        "let f0(a) = a\n"
        + "".join(f"let f{i}(a) = f{i - 1}(a) + f{i - 1}(a)\n" for i in range(1, 30))
        + "line by (f29(1)*mm, 0)",
        1,
        "error[E309]",
    ),
    "zero": (f"{LINE}\n\0", 1, "error[E307]"),
    "crlf": (f"{LINE}\r\n{LINE}\r\n", 0, "2 mm"),
    "bom": (f"\ufeff{LINE}\n", 0, "1 mm"),
    "latin": (f"{LINE} # für\n".encode("latin-1"), 1, "line 1, byte 22 is 0xfc ('ü' in Latin-1)"),
    "lines": (f"{LINE}\n" * 100_002, 1, "error[E306]"),
    "one-line": ("line" + " by (1, 0) mm" * 140_000, 1, "error[E314]"),
    "ends": ("end\n" * 99_000, 1, "error[E131]"),
    "deep": ("with rotate 1 deg\n" * 50_000, 1, "error[E126]"),
}


def limit() -> None:
    resource.setrlimit(resource.RLIMIT_DATA, (MOST_BYTES, MOST_BYTES))


def answer(path: Path) -> tuple[int, str, float]:
    """The exit code of `check` within its memory, what it says, and its processor time [s]."""
    before = resource.getrusage(resource.RUSAGE_CHILDREN)
    done = subprocess.run(
        [sys.executable, "-m", "dqpaint", "check", str(path)],
        capture_output=True, text=True, preexec_fn=limit, timeout=120, check=False,
        env={**os.environ, "OPENBLAS_NUM_THREADS": "1"},
    )  # fmt: skip
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    spent = after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime
    return done.returncode, done.stdout + done.stderr, spent


@pytest.mark.slow
@pytest.mark.parametrize("name", FILES)
def test_the_command_line_answers_soon(tmp_path: Path, name: str) -> None:
    text, code, said = FILES[name]
    path = tmp_path / f"{name}.traj"
    path.write_bytes(text if isinstance(text, bytes) else text.encode())
    returned, output, spent = answer(path)
    assert (returned, said in output) == (code, True), output[:500]
    assert "Traceback" not in output
    assert "internal error" not in output
    assert spent < MOST_SECONDS


@pytest.mark.slow
@pytest.mark.parametrize(
    ("rows", "size", "clause", "said"),
    [
        (499_000, 90.0, "speed 1 mm/s", "error[E302]"),
        (499_000, 1.0, "in 100 s", "steps"),
        (499_000, 1.0, "smooth in 100 s", "steps"),
        (999_000, 90.0, "in 100 s", "error[E294]"),
    ],
)
def test_a_path_of_many_points_is_answered_soon(
    tmp_path: Path, rows: int, size: float, clause: str, said: str
) -> None:
    near = "".join(f"{size * (i % 97) / 97:.2f},{i % 89 / 890:.2f}\n" for i in range(rows))
    (tmp_path / "points.csv").write_text(near)
    (tmp_path / "path.traj").write_text(f'path "points.csv" unit mm {clause}\n')
    _, output, spent = answer(tmp_path / "path.traj")
    assert said in output, output[:500]
    assert spent < MOST_SECONDS


def drawing_of(shapes: Iterator[str]) -> str:
    """An SVG of 1000 by 1000 pixels."""
    root = '<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 1000 1000" stroke="red">'
    return f"{root}{''.join(shapes)}</svg>"


def dots(count: int) -> Iterator[str]:
    for i in range(count):
        yield f'<circle cx="{i * 7919 % 1000}" cy="{i * 104729 % 997}" r="1"/>'


def curves(count: int) -> Iterator[str]:
    yield '<path fill="none" d="M500 500'
    for i in range(count):
        end = f"{i * 7919 % 31 - 15} {i * 104729 % 29 - 14}"
        yield f"c{i % 7}.5 {i % 5}.25 {i % 3}.5 {i % 11} {end}"
    yield '"/>'


LARGE = {  # the shapes, the clause, what is said, the most seconds: three times what was measured
    "dots": (dots(20_000), "", " steps of 8 ms", 8.0),
    "curves": (curves(60_000), "speed 4 m/s", " steps of 8 ms", 6.0),
    "too-slow": (curves(60_000), "speed 0.01 mm/s", "error[E302]", 4.0),
}


@pytest.mark.slow
@pytest.mark.parametrize("name", LARGE)
def test_a_large_svg_is_answered_soon(tmp_path: Path, name: str) -> None:
    shapes, clause, said, most = LARGE[name]
    (tmp_path / "a.svg").write_text(drawing_of(shapes))
    (tmp_path / "a.traj").write_text(f'svg "a.svg" height 200 mm {clause}\n')
    _, output, spent = answer(tmp_path / "a.traj")
    assert said in output, output[:500]
    assert spent < most

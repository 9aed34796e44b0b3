"""Hostile and enormous files, through the command line: answered in so many calls and bytes."""

from pathlib import Path

import pytest

from tests.support.svg import curves, dots, drawing_of
from tests.support.work import checked

MOST_CALLS = 2_000_000  # 350,000 of them start the program
LARGE_BYTES = 600 << 20  # of data: speeds at half a million corners, at 60,000 curves
MORE = {"functions": 14_000_000, "deep": 8_000_000}  # twice what is needed
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
    "latin": (f"{LINE} # für\n".encode("latin-1"), 1, "line 1, byte 22 is 0xfc"),
    "lines": (f"{LINE}\n" * 100_002, 1, "error[E306]"),
    "one-line": ("line" + " by (1, 0) mm" * 140_000, 1, "error[E314]"),
    "ends": ("end\n" * 99_000, 1, "error[E131]"),
    "deep": ("with rotate 1 deg\n" * 50_000, 1, "error[E126]"),
}


@pytest.mark.slow
@pytest.mark.parametrize("name", FILES)
def test_the_command_line_answers_soon(tmp_path: Path, name: str) -> None:
    text, code, said = FILES[name]
    path = tmp_path / f"{name}.traj"
    path.write_bytes(text if isinstance(text, bytes) else text.encode())
    answer = checked(path)
    assert (answer.code, said in answer.said) == (code, True), answer.said[:500]
    assert "Traceback" not in answer.said
    assert "internal error" not in answer.said
    assert answer.calls < MORE.get(name, MOST_CALLS)


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
    answer = checked(tmp_path / "path.traj", LARGE_BYTES)
    assert said in answer.said, answer.said[:500]
    assert answer.calls < MOST_CALLS


LARGE = {  # the shapes, the clause, what is said, the most calls: twice what is needed
    "dots": (dots(20_000), "", " steps of 8 ms", 27_000_000),
    "curves": (curves(30_000), "speed 4 m/s", " steps of 8 ms", 5_000_000),
    "too-slow": (curves(60_000), "speed 0.01 mm/s", "error[E302]", 5_000_000),
}


@pytest.mark.slow
@pytest.mark.parametrize("name", LARGE)
def test_a_large_svg_is_answered_soon(tmp_path: Path, name: str) -> None:
    shapes, clause, said, most = LARGE[name]
    (tmp_path / "a.svg").write_text(drawing_of(shapes))
    (tmp_path / "a.traj").write_text(f'svg "a.svg" height 200 mm {clause}\n')
    answer = checked(tmp_path / "a.traj", LARGE_BYTES)
    assert said in answer.said, answer.said[:500]
    assert answer.calls < most

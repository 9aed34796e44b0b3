"""Points from files: what is read, what is refused, and how soon."""

import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from dqpaint.language import Program, ScriptError, parse
from dqpaint.language.strokes import imported_strokes
from dqpaint.program import piecewise
from dqpaint.program.program import CruiseSpeed, Duration, PiecewiseCurve, Samples, Straight
from tests.support.work import FAR_TOO_LONG, Calls

CHECK = """
import sys
from dqpaint.language import ScriptError, read
try:
    read(sys.argv[1])
except ScriptError as error:
    print(error.diagnostics[0].code, error.diagnostics[0].message)
for line in open('/proc/self/status'):  # ru_maxrss would be that of the process it came from, too
    if line.startswith('VmHWM:'):
        print(int(line.split()[1]) // 1024)
"""


def made(folder: Path, line: str, **files: str | bytes) -> Program:
    for name, content in files.items():
        data = content.encode() if isinstance(content, str) else content
        (folder / name.replace("_", ".")).write_bytes(data)
    return parse(f"corner jump\n{line}", str(folder / "a.traj"), folder / "a.traj")


def points(program: Program) -> np.ndarray:
    """The places of a path's rows [mm]."""
    (segment,) = (s for s in program.segments if isinstance(s.path, PiecewiseCurve))
    return np.vstack([segment.path.cubic[:, 0], piecewise.ends(segment.path)[1]]) / 1e-3


ROWS = np.array([[1, 2, 0], [3, -4.5, 0], [0.5, 60, 0]])
STYLES = {
    "comma": "1,2\n3,-4.5\n0.5,60\n",
    "semicolon": "1;2\n3;-4.5\n0.5;60",
    "decimal comma": "1,0;2\n3;-4,5\n0,5;6e1\n",
    "tab": "1\t2\n3\t-4.5\n0.5\t60\n",
    "blanks": "  1   2\n3 -4.5 \n\n0.5\t60\n",
    "heading": "x,y\n1,2\n3,-4.5\n0.5,60\n",
    "comments": "# by hand\n# x y\n1,2  # start\n3,-4.5\n\n0.5,60\n",
    "Windows": "\ufeffx;y\r\n1;2\r\n3;-4.5\r\n0.5;60\r\n",
    "old Mac": "1,2\r3,-4.5\r0.5,60",
    "z": "1,2,0\n3,-4.5,0\n0.5,60,0\n",
    "lines of blanks": "1,2\n   \n3,-4.5\n \t # nothing\n0.5,60\n  ",
    "heading below a comment": "# by hand\n\nx,y\n1,2\n3,-4.5\n0.5,60\n",
    "repeated rows": "1,2\n1,2\n3,-4.5\n3,-4.5\n0.5,60\n",
}


@pytest.mark.parametrize("style", STYLES)
def test_styles(tmp_path: Path, style: str) -> None:
    program = made(tmp_path, 'path "p.csv" unit mm', p_csv=STYLES[style])
    np.testing.assert_allclose(points(program), ROWS, atol=1e-12)


def test_a_file_for_each_axis(tmp_path: Path) -> None:
    """The Drawer's format: one value a line, one file an axis."""
    files = {"x_txt": "1\n3\n0.5\n", "y_txt": "2\n-4.5\n60\n", "z_txt": "7\n8\n9"}
    program = made(tmp_path, 'path "x.txt" "y.txt" "z.txt" unit cm', **files)
    wanted = 10 * (ROWS + np.array([[0, 0, 7], [0, 0, 8], [0, 0, 9]]))
    np.testing.assert_allclose(points(program), wanted, atol=1e-9)
    program = made(tmp_path, 'path "x.txt" "y.txt" unit mm', **files)
    np.testing.assert_allclose(points(program), ROWS, atol=1e-12)


def test_places(tmp_path: Path) -> None:
    """With a unit the rows are places; fitted, the middle of their box is the place."""
    rows = STYLES["comma"]
    there = points(made(tmp_path, 'path "p.csv" unit mm at (10, 20, 30) mm', p_csv=rows))
    np.testing.assert_allclose(there, ROWS + np.array([10, 20, 30]), atol=1e-12)
    fit = points(made(tmp_path, 'path "p.csv" height 129 mm at (1, 2) mm'))
    np.testing.assert_allclose(fit, 2 * (ROWS - [1.75, 27.75, 0]) + [1, 2, 0], atol=1e-12)
    fit = points(made(tmp_path, 'path "p.csv" height 129 mm width 2.5 mm'))
    np.testing.assert_allclose(fit, ROWS - [1.75, 27.75, 0], atol=1e-12)
    framed = points(made(tmp_path, 'with rotate 90 deg scale 2\npath "p.csv" unit mm\nend'))
    np.testing.assert_allclose(framed, 2 * ROWS[:, [1, 0, 2]] * [-1, 1, 1], atol=1e-12)


def test_it_is_one_stroke_with_the_clauses_of_a_stroke(tmp_path: Path) -> None:
    def timing(clause: str) -> object:
        (segment,) = made(
            tmp_path, f'path "p.csv" unit mm {clause}', p_csv="1,2\n3,4\n5,7"
        ).segments
        return segment.timing

    assert timing("samples 77") == Samples(77)
    assert timing("in 3 s") == Duration(3)
    assert timing("speed 30 mm/s") == CruiseSpeed(pytest.approx(0.03), pytest.approx(np.pi / 3))


def test_the_way_there(tmp_path: Path) -> None:
    alone = made(tmp_path, 'path "p.csv" unit mm', p_csv="5,5\n9,5\n")
    assert alone.start.position == pytest.approx((0.005, 0.005, 0))
    assert alone.notes == ()
    after = made(tmp_path, 'line by (5, 2) mm\npath "p.csv" unit mm')
    assert [d.code for d in after.notes] == ["W402"]
    assert after.notes[0].message == "the path starts 3 mm away from where the tool is"
    assert isinstance(after.segments[1].path, Straight)
    assert after.segments[1].light is None


def test_smooth(tmp_path: Path) -> None:
    a = np.radians(np.arange(0, 361, 30))
    rows = "\n".join(f"{np.cos(t):.12f} {np.sin(t):.12f}" for t in a)
    (segment,) = made(tmp_path, 'path "p.csv" unit m smooth', p_csv=rows).segments
    g, piece = np.full(12, 0.5), np.arange(12)
    middles = piecewise.derivatives(segment.path, piece, g)[0]
    np.testing.assert_allclose(np.linalg.norm(middles, axis=1), 1, atol=1e-5)


BAD = {
    "": "there are no numbers in p.csv",
    "x,y\n": "there are no numbers in p.csv",
    "1,2\n3\n": "p.csv, line 2: this row has 1 numbers, the first has 2",
    "1,2\n3,4,5\n": "p.csv, line 2: this row has 3 numbers, the first has 2",
    "x,y\n1,2\n\n3,\n": "p.csv, line 4: this row lacks a number",
    "1,2\nnan,3\n": "p.csv, line 2: this row has a number that is not finite, or far too large",
    "1,2\n3,1e400\n": "p.csv, line 2: this row has a number that is not finite, or far too large",
    "1,2\n3,4_0\n": "p.csv, line 2: this row has '4_0' where a number should be",
    "1,2\n3,4 mm\n": "p.csv, line 2: this row has '4 mm' where a number should be",
    "1,2,3,4\n": "p.csv has 4 columns",
    "a\0b": "p.csv is not a plain text",
    "\udcff\udcfe1,2": "p.csv is not a plain text",
}


@pytest.mark.parametrize("content", BAD)
def test_bad(tmp_path: Path, content: str) -> None:
    data = content.encode("utf-8", "surrogateescape")
    with pytest.raises(ScriptError) as caught:
        made(tmp_path, 'path "p.csv" unit mm', p_csv=data)
    assert caught.value.diagnostics[0].message == BAD[content]


def test_only_files_beside_or_below(tmp_path: Path) -> None:
    (tmp_path / "secret.csv").write_text("1,2\n3,4\n")
    below = tmp_path / "drawings"
    (below / "data").mkdir(parents=True)
    (below / "data/p.csv").write_text("1,2\n3,4\n")
    (below / "link.csv").symlink_to(tmp_path / "secret.csv")
    (below / "round.csv").symlink_to(below / "round.csv")
    assert made(below, 'path "data/p.csv" unit mm').segments
    for name in (
        "../secret.csv",
        "data/../../secret.csv",
        "link.csv",
        str(tmp_path / "secret.csv"),
    ):
        with pytest.raises(ScriptError) as caught:
            made(below, f'path "{name}" unit mm')
        assert caught.value.diagnostics[0].code == "E292"
    for name in ("round.csv", "data", "none.csv", "x" * 300 + ".csv"):
        with pytest.raises(ScriptError) as caught:
            made(below, f'path "{name}" unit mm')
        assert caught.value.diagnostics[0].code in ("E292", "E293")


@pytest.mark.slow
def test_ten_million_rows_are_refused_at_once(tmp_path: Path) -> None:
    with (tmp_path / "p.csv").open("w") as file:
        for _ in range(10):
            file.write("1.5,2.5\n2.5,3.5\n" * 500_000)
    (tmp_path / "a.traj").write_text('path "p.csv" unit mm\n')
    command = [sys.executable, "-c", CHECK, str(tmp_path / "a.traj")]
    told, size = subprocess.run(
        command, capture_output=True, text=True, check=True, timeout=FAR_TOO_LONG
    ).stdout.splitlines()
    assert told == "E294 p.csv is too long: more than 500,000 rows"
    assert int(size) < 300


def test_too_many_bytes(tmp_path: Path) -> None:
    with (tmp_path / "p.csv").open("wb") as file:
        file.truncate(100_000_001)  # takes no room
    with pytest.raises(ScriptError, match=r"E294.*100 MB"):
        made(tmp_path, 'path "p.csv" unit mm')


@pytest.mark.slow
def test_in_a_repeat_the_pieces_are_counted(tmp_path: Path) -> None:
    rows = "".join(f"{i % 7},{i % 11}\n" for i in range(3000))
    line = 'start at (0, 0)\nrepeat {}\npath "p.csv" unit mm speed 1 m/s\nend'
    with Calls(300_000):
        assert (
            len(made(tmp_path, line.format(20), p_csv=rows).segments) == 39
        )  # 19 ways back to the start
        with pytest.raises(ScriptError, match=r"E299.*2,000,000"):
            made(tmp_path, line.format(9999))


def test_what_will_be_too_many_pieces_is_drawn_once(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Each of 700 passes took as long as the first before they were too many."""
    drawn = 0
    inner = imported_strokes.draw_traces

    def draw(*given: object) -> None:
        nonlocal drawn
        drawn += 1
        inner(*given)  # type: ignore[arg-type]

    monkeypatch.setattr(imported_strokes, "draw_traces", draw)
    rows = "".join(f"{i % 7},{i % 11}\n" for i in range(3000))
    text = 'repeat {}\nmove to (0, 0)\npath "p.csv" unit mm speed 1 m/s\nend'
    with pytest.raises(ScriptError, match=r"E299.*\n --> [^:]*:4:1") as caught:
        made(tmp_path, text.format(668), p_csv=rows)
    assert (drawn, len(caught.value.diagnostics)) == (1, 1)
    made(tmp_path, text.format(30))
    assert drawn == 31


SCRAPS = st.sampled_from(
    [
        *("0123456789.,;\t\n -e#x_\0é\ufeff" + '"'),
        *("\r\n", "nan", "inf", "1,2\n", "3;4\n", "1e308"),
    ]
)


@pytest.mark.slow
@settings(
    max_examples=300, deadline=None, suppress_health_check=[HealthCheck.function_scoped_fixture]
)
@given(st.lists(SCRAPS, max_size=40), st.sampled_from(["unit mm", "height 9 mm", "unit m smooth"]))
def test_whatever_is_in_a_file(tmp_path: Path, scraps: list[str], clause: str) -> None:
    try:
        program = made(tmp_path, f'path "p.csv" {clause}', p_csv="".join(scraps))
    except ScriptError as error:
        told = {d.code for d in error.diagnostics}
    else:
        told = set()
        assert np.isfinite(points(program)).all()
    assert "E999" not in told

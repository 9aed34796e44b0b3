"""Files that include files: what they mean together, and where messages point."""

import pickle
from pathlib import Path

import pytest

from dqpaint.diagnostics.diagnostic import file_at, locate
from dqpaint.language import Program, ScriptError, read, render
from dqpaint.program.program import Straight
from tests.support.wrong_drawings import OF_FILES, write


def compiled(folder: Path, files: dict[str, str]) -> Program:
    return read(write(folder, files))


@pytest.mark.parametrize(("code", "files", "file", "caret"), OF_FILES)
def test_messages(tmp_path: Path, code: str, files: dict[str, str], file: str, caret: str) -> None:
    with pytest.raises(ScriptError) as caught:
        compiled(tmp_path, files)
    error = caught.value
    (found,) = error.diagnostics
    assert found.code == code
    assert found.span is not None
    at, _, words = caret.partition(" ")
    assert "{}:{}".format(*locate(error.text, found.span.start)) == at
    assert found.span.text_in(error.text) == words
    assert file_at(error.text, found.span.start, error.name)[1] == str(tmp_path / file)
    assert f"--> {tmp_path / file}:{at}\n" in render(found, error.name, error.text)


def test_lines_stand_where_they_are_included(tmp_path: Path) -> None:
    files = {
        "a.traj": 'speed 20 mm/s\ninclude "in/b.traj"\nwith shift (5, 0) mm\n'
        '  repeat 2\n    include "in/c.traj"\n  end\nend\nstar(r)',
        "in/b.traj": "traj 1\nperiod 5 ms\nlet r = 3 mm\ndef star(a)\n  line by (a, a)\nend",
        "in/c.traj": "let q = 7 mm\nline to (q, 0)\nline to (0, 0)",
    }
    program = compiled(tmp_path, files)
    assert program.period == pytest.approx(0.005)
    ends = [segment.end.position for segment in program.segments]
    assert ends == [
        pytest.approx(p, abs=1e-15)
        for p in [(0.012, 0, 0), (0.005, 0, 0)] * 2 + [(0.008, 0.003, 0)]
    ]
    where = [program.line_name(segment.line) for segment in program.segments]
    b, c = (str(tmp_path / "in" / name) for name in ("b.traj", "c.traj"))
    assert where == [f"{c}:2", f"{c}:3"] * 2 + [f"{b}:5"]
    words = [segment.span.text_in(program.text) for segment in program.segments]
    assert words == ["line to (q, 0)", "line to (0, 0)"] * 2 + ["line by (a, a)"]
    assert pickle.loads(pickle.dumps(program.text)).included == program.text.included


def test_what_two_files_both_need_is_said_once(tmp_path: Path) -> None:
    files = {
        "a.traj": 'include "b.traj"\ninclude "c.traj"\nline to (x1, x2)',
        "b.traj": 'include "d.traj"\nlet x1 = 2*u',
        "c.traj": 'include "d.traj"\nlet x2 = 3*u',
        "d.traj": "let u = 1 mm\nlet f(a) = 2*a\ndef g\nhold 1 s\nend\nframe h at (u, 0)",
    }
    (segment,) = compiled(tmp_path, files).segments
    assert isinstance(segment.path, Straight)
    assert segment.path.by == pytest.approx((0.002, 0.003, 0))


def test_a_name_of_two_files_is_told_with_both_places(tmp_path: Path) -> None:
    files = {"a.traj": 'let r = 1 mm\ninclude "b.traj"', "b.traj": "\nlet r = 2 mm"}
    with pytest.raises(ScriptError) as caught:
        compiled(tmp_path, files)
    (found,) = caught.value.diagnostics
    assert (found.code, found.label) == ("E230", f"(first: {tmp_path}/a.traj:1:5)")


def test_links_do_not_lead_out(tmp_path: Path) -> None:
    (tmp_path / "secret.traj").write_text("hold 1 s")
    (tmp_path / "in").mkdir()
    (tmp_path / "in" / "b.traj").symlink_to(tmp_path / "secret.traj")
    (tmp_path / "in" / "c.traj").symlink_to(tmp_path / "in" / "c.traj")
    for name in ("b", "c"):
        main = tmp_path / "in" / "a.traj"
        main.write_text(f'include "{name}.traj"')
        with pytest.raises(ScriptError, match="outside of the main file's folder"):
            read(main)

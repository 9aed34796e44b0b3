"""Files that a drawing names are seen from the file that names them, and none leads out."""

import math
from pathlib import Path

import pytest

from dqpaint.language import ScriptError, read
from dqpaint.program.piecewise import ends
from dqpaint.program.program import PiecewiseCurve

SQUARE = (
    '<svg xmlns="http://www.w3.org/2000/svg" width="10mm" height="10mm" viewBox="0 0 10 10">'
    '<path d="M0 0H10V10" stroke="red" fill="none"/></svg>'
)


def files(folder: Path, main: str, inner: str) -> Path:
    (folder / "in" / "deep").mkdir(parents=True)
    (folder / "p.csv").write_text("0,0\n1,0\n")
    (folder / "in" / "p.csv").write_text("0,0\n2,0\n")
    (folder / "in" / "deep" / "p.csv").write_text("0,0\n3,0\n")
    (folder / "in" / "s.svg").write_text(SQUARE)
    (folder / "a.traj").write_text(main)
    (folder / "in" / "b.traj").write_text(inner)
    return folder / "a.traj"


def lengths(path: Path) -> list[float]:
    out = []
    for segment in read(path).segments:
        if isinstance(segment.path, PiecewiseCurve):
            start, end = ends(segment.path)
            out.append(round(1e3 * math.dist(start, end), 6))
    return out


def test_a_name_is_seen_from_the_file_it_stands_in(tmp_path: Path) -> None:
    main = files(
        tmp_path,
        'include "in/b.traj"\npath "p.csv" unit mm\npath "in/p.csv" unit mm\nrow()\n',
        'path "p.csv" unit mm\npath "deep/p.csv" unit mm\npath "../p.csv" unit mm\n'
        'def row\n  path "p.csv" unit mm\nend\n',
    )
    # a `def` is drawn by the main file, but stands in the other
    assert lengths(main) == [2, 3, 1, 1, 2, 2]


def test_a_drawing_too(tmp_path: Path) -> None:
    assert read(files(tmp_path, 'include "in/b.traj"', 'svg "s.svg"\n')).segments


@pytest.mark.parametrize("name", ["../../p.csv", "deep/../../../p.csv", "/p.csv"])
def test_no_name_leads_out(tmp_path: Path, name: str) -> None:
    (tmp_path / "p.csv").write_text("0,0\n1,0\n")
    main = files(tmp_path / "own", 'include "in/b.traj"', f'path "{name}" unit mm')
    with pytest.raises(ScriptError) as caught:
        read(main)
    (found,) = caught.value.diagnostics
    assert found.code == "E292"


def test_main_in_the_working_folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    files(tmp_path, 'include "in/b.traj"\npath "p.csv" unit mm', 'path "p.csv" unit mm')
    monkeypatch.chdir(tmp_path)
    assert lengths(Path("a.traj")) == [2, 1]

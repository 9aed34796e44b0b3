"""Words of the language beside each other, as no one of them is tested alone."""

import shutil
from pathlib import Path

import pytest

from dqpaint.core.examples import examples_folder
from dqpaint.diagnostics.diagnostic import file_at
from dqpaint.editors.analysis import analyse
from dqpaint.language import ScriptError, parse, read
from dqpaint.language.writing.builder import Drawing, DrawingError
from dqpaint.motion import plan
from dqpaint.program.program import PiecewiseCurve
from dqpaint.robots.model.card import read_card
from tests.support.wrong_drawings import FILES

CANVAS = read_card("iiwa").canvas.pose


def ends(text: str) -> list[tuple[type, float, float]]:
    segments = parse(text, "a.traj", FILES / "a.traj").segments
    return [(type(s.path), *(round(1e3 * c, 6) for c in s.end.position[:2])) for s in segments]


@pytest.mark.parametrize("start", ["(0, 0)", "(3, 4) mm"])
def test_a_line_reaches_the_path_it_leads_to(start: str, tmp_path: Path) -> None:
    """`blend` rounds corners between lines, and neither end of what comes from elsewhere."""
    (tmp_path / "p.csv").write_text("0,0\n0,9\n9,9\n")
    text = f'blend 2 mm\nmove to (-9, 0) mm\nline to {start}\npath "p.csv" unit mm at {start}\n'
    text += "line by (0, -9) mm"
    segments = parse(text, "a.traj", tmp_path / "a.traj").segments
    assert all(s.light is not None for s in segments)
    assert len(segments) == 3
    assert segments[0].end == segments[1].start
    assert segments[1].end == segments[2].start


def test_dots_are_no_slow_strokes() -> None:
    """A stroke of letters may be shorter than a period; that is nothing to warn of."""
    motion = plan(parse('text "iii" height 5 mm\n'), CANVAS)
    assert "W411" not in {note.code for note in motion.notes}
    motion = plan(parse("line by (1, 0) mm"), CANVAS)
    assert "W411" in {note.code for note in motion.notes}


def test_sizes_have_names() -> None:
    text = 'let height = 9 mm\nlet width = 50 mm\nlet unit = 2\ntext "A" height height width width'
    assert ends(text + "\nline by (unit*mm, 0)") == ends(
        'text "A" height 9 mm width 50 mm\nline by (2 mm, 0)'
    )


@pytest.mark.parametrize("text", ["def ring\nhold 1 s\nend\nring", "zzz"])
def test_a_call_without_its_brackets(text: str) -> None:
    with pytest.raises(ScriptError) as caught:
        parse(text)
    word = text.split()[-1]
    assert caught.value.diagnostics[0].help == f"to draw what a 'def' names, write: {word}()"


def test_a_path_with_its_place_needs_no_word() -> None:
    """Who says where it is knows that the tool has to go there."""

    def codes(line: str) -> set[str]:
        text = f"line by (90, 0) mm\n{line}"
        return {note.code for note in parse(text, "a.traj", FILES / "a.traj").notes}

    assert codes('path "points.csv" unit mm') == {"W402"}
    assert codes('path "points.csv" unit mm at (20, 0) mm') == set()


def test_an_editor_s_lines_are_its_own(tmp_path: Path) -> None:
    (tmp_path / "b.traj").write_text("line by (50, 0) mm\n")
    text = 'include "b.traj"\nline by (0, 20) mm\n'
    known = analyse(text, str(tmp_path / "a.traj"), planned=True)
    assert list(known.figures) == [2]
    assert known.figures[2].length == pytest.approx(0.02, rel=1e-6)
    (tmp_path / "b.traj").write_text("line by (50, 0)\n")
    known = analyse(text, str(tmp_path / "a.traj"), planned=True)
    (found,) = known.diagnostics
    assert found.span is not None
    assert file_at(known.source, found.span.start, "")[1] == str(tmp_path / "b.traj")


def test_a_drawing_from_python_names_files(tmp_path: Path) -> None:
    shutil.copy(examples_folder() / "orbit.csv", tmp_path)
    (tmp_path / "bad.traj").write_text("\nline by (1, 0)\n")
    drawing = Drawing("wave", folder=tmp_path)
    drawing.line(by=(0.02, 0))
    drawing.path("orbit.csv", height=0.05)
    assert any(isinstance(s.path, PiecewiseCurve) for s in drawing.program().segments)
    drawing.include("bad.traj")
    with pytest.raises(DrawingError) as caught:
        drawing.program()
    text = str(caught.value)
    assert f"{tmp_path / 'bad.traj'}:2:9" in text
    assert "= call" not in text.split("error[")[1]  # the fault is not of the call


def test_everything_at_once(tmp_path: Path) -> None:
    (tmp_path / "parts").mkdir()
    shutil.copy(examples_folder() / "orbit.csv", tmp_path / "parts")
    (tmp_path / "parts/lib.traj").write_text(
        "let hue(k) = hsv(k*60 deg)\ndef star(r, c)\nrepeat 5\nline by (r, 0) light c\n"
        "line by polar(r, -144 deg) light c even\nend\nend\n"
        "frame leaf at (60, 20) mm turned 30 deg\n"
        'def ring\npath "orbit.csv" height 30 mm smooth at (-60, 40) mm light orange\nend\n'
    )
    (tmp_path / "a.traj").write_text(
        'include "parts/lib.traj"\nblend 2 mm\nline to (20, 0) mm to (20, 20) mm\n'
        'text "Ada" height 12 mm strobe 10 Hz 40%\nblend off\nring()\n'
        "with frame leaf light cyan\nstar(10 mm, hue(2))\nend\nmove to (-70, -60) mm\n"
        "stroke in 4 s light orange to magenta\nline by (30, 0) mm\n"
        "arc centre (-40, -50) mm angle 90 deg\nend\nbrush bar 20 mm along x\nline by (0, 10) mm\n"
    )
    motion = plan(read(tmp_path / "a.traj"), CANVAS)
    assert motion.notes == () or {note.code for note in motion.notes} <= {"W403", "W411"}
    assert len({s.brush for s in motion.program.segments}) == 2
    assert sum(s.strobe is not None for s in motion.program.segments if s.light) >= 3

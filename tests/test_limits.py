"""Every limit of docs/limits.md at its edge: what has just as much is taken, and one more is not.

The limits are lowered for it. Those of the readers of single files stand in `test_readers.py`.
"""

import importlib
from dataclasses import replace

import pytest

import dqpaint
from dqpaint.core import LARGEST_MAX_SAMPLES, user_files
from dqpaint.errors import DqpaintError, UsageError
from dqpaint.language import ScriptError, parse
from dqpaint.language.expansion import includes
from dqpaint.language.imports import point_files
from dqpaint.language.imports.svg import reader
from dqpaint.light.camera import views
from dqpaint.light.sources import from_motion
from dqpaint.motion import schedule, survey
from dqpaint.robots.urdf import tree
from dqpaint.settings import groups, make_settings
from dqpaint.studies.kinds import sweep

MOST = 12
TEXT = "line by (1, 0) mm\n"
PATH = 'profile constant\nmove to (0, 0) mm\npath "points.csv" unit mm corner jump\n'


def nested(word):
    return lambda n: f"{word}\n" * n + TEXT + "end\n" * n


def called(n):
    """Definitions that call each other, which are blocks within each other when they are drawn."""
    names = [f"f{k}" for k in range(n)]
    inner = ["hold 1 s", *(f"{name}()" for name in names)]
    texts = (f"def {name}()\n{body}\nend\n" for name, body in zip(names, inner, strict=False))
    return "".join(texts) + f"{names[-1]}()\n"


DRAWINGS = {  # each with how much there is of it
    "compile.MOST_LINES": lambda n: TEXT * n,
    "syntax.lexer.MOST_TOKENS": lambda n: f"let a = {'-' * (n - 4)}1\nhold 1 s\n",
    "syntax.parser.DEEPEST": nested("repeat 1"),
    "syntax.expressions.DEEPEST": lambda n: f"let a = {'(' * n}1{')' * n}\n{TEXT}",
    "expansion.blocks.MOST_PASSES": lambda n: f"repeat {n}\n{TEXT}end\n",
    "expansion.blocks.MOST_STATEMENTS": lambda n: TEXT * n,
    "expansion.expander.DEEPEST": called,
    "pen.pen.MOST_SEGMENTS": lambda n: TEXT * n,
    "imports.lettering.LONGEST": lambda n: f'text "{"l" * n}" height 10 mm\n',
    "strokes.imported_strokes.MOST_PIECES": lambda n: PATH + "#" * n,
    "imports.point_files.MOST_ROWS": lambda n: PATH + "#" * n,
}


def codes_of(read):
    try:
        read()
    except ScriptError as problem:
        return [one.code for one in problem.diagnostics]
    return []


@pytest.mark.parametrize("name", DRAWINGS)
def test_a_drawing_at_a_limit_and_beyond(name, tmp_path, monkeypatch):
    module, limit = f"dqpaint.language.{name}".rsplit(".", 1)
    monkeypatch.setattr(importlib.import_module(module), limit, MOST)
    here, found = tmp_path / "a.traj", []
    for n in (MOST, MOST + 1):
        point_files._numbers_in.cache_clear()
        rows = n + (limit == "MOST_PIECES")  # a line has one end more
        (tmp_path / "points.csv").write_text("".join(f"{x},{x * x}\n" for x in range(rows)))
        text = DRAWINGS[name](n)
        found.append(codes_of(lambda text=text: parse(text, str(here), here)))
    assert found[0] == [], found
    assert len(found[1]) == 1, found


def test_files_within_each_other(tmp_path, monkeypatch):
    monkeypatch.setattr(includes, "DEEPEST", 3)
    for k in range(5):
        (tmp_path / f"{k}.traj").write_text(f'include "{k + 1}.traj"\n' if k < 4 else TEXT)
    for first, codes in ((1, []), (0, ["E274"])):
        here = tmp_path / f"{first}.traj"
        assert codes_of(lambda here=here: parse(here.read_text(), here.name, here)) == codes


def test_seconds_of_a_drawing(monkeypatch):
    monkeypatch.setattr(schedule, "MOST_SECONDS", 12.0)
    for seconds, taken in ((11, True), (12, False)):  # and the first sample
        text = f"period 1 s\nhold {seconds} s\n"
        assert (codes_of(lambda text=text: survey(parse(text, "a"))) == []) == taken


def test_samples_of_a_drawing():
    for more, taken in ((0, True), (1, False)):
        program = replace(parse(f"period 1 s\nhold {11 + more} s\n", "a"), most_samples=12)
        assert (codes_of(lambda program=program: survey(program)) == []) == taken


@pytest.mark.parametrize(("name", "taken", "refused"), [
    ("size", "8192x16", "8193x16"), ("size", "16x16", "15x16"),
    ("max_samples", LARGEST_MAX_SAMPLES, LARGEST_MAX_SAMPLES + 1),
    ("timeout", groups.LONGEST_TIMEOUT, 1.01 * groups.LONGEST_TIMEOUT),
    ("max_memory", groups.LARGEST_MEMORY, 1.01 * groups.LARGEST_MEMORY),
])  # fmt: skip
def test_options(name, taken, refused):
    make_settings(**{name: taken})
    with pytest.raises(UsageError):
        make_settings(**{name: refused})


def test_views_of_an_orbit():
    most = views.MOST_ORBIT_VIEWS
    assert len(views.parse_views(f"orbit:{most}")) == most
    for count in (1, most + 1):
        with pytest.raises(UsageError):
            views.parse_views(f"orbit:{count}")


def test_bytes_of_a_law_s_file(tmp_path, monkeypatch):
    path = tmp_path / "law.py"
    path.write_text("def law():\n    pass\n")
    size = path.stat().st_size
    for less in (0, 1):
        monkeypatch.setattr(user_files, "LARGEST_FILE", size - less)
        if less:
            with pytest.raises(DqpaintError):
                user_files.read_definitions(path, "law")
        else:
            assert "law" in user_files.read_definitions(path, "law")[0]


@pytest.mark.parametrize(("name", "where", "data", "line"), [
    ("a.csv", point_files, b"0,0\n40,20\n80,0\n", 'path "a.csv" unit mm\n'),
    ("a.svg", reader, b"<svg xmlns='http://www.w3.org/2000/svg' viewBox='0 0 9 9'>"
     b"<path d='M0 0 L9 9' stroke='red'/></svg>", 'svg "a.svg" height 80 mm\n'),
])  # fmt: skip
def test_bytes_of_a_file_that_is_drawn(name, where, data, line, tmp_path, monkeypatch):
    (tmp_path / name).write_bytes(data)
    text, here = f"move to (0, 0) mm\n{line}", tmp_path / "a.traj"
    monkeypatch.setattr(where, "MOST_BYTES", len(data))
    assert codes_of(lambda: parse(text, "a", here)) == []
    monkeypatch.setattr(where, "MOST_BYTES", len(data) - 1)
    assert codes_of(lambda: parse(text, "a", here)) == ["E294"]


def test_flashes_of_a_drawing(monkeypatch):
    monkeypatch.setattr(from_motion, "MOST_FLASHES", 10)
    text = "period 125 ms\nline to (30, 0) mm in {} s strobe 8 Hz 50%\n"
    dqpaint.preview(text=text.format(1.25), size=(16, 16))
    with pytest.raises(DqpaintError, match="flashes"):
        dqpaint.preview(text=text.format(1.375), size=(16, 16))


def test_lengths_of_a_urdf():
    assert tree.parse_numbers("1 -1000 0", tree.FARTHEST).tolist() == [1.0, -1000.0, 0.0]
    assert not tree.parse_numbers("1 -1000.001 0", tree.FARTHEST).size


def test_runs_of_a_sweep(monkeypatch):
    class PassedError(Exception):
        pass

    def passed(_axes):
        raise PassedError

    monkeypatch.setattr(sweep, "combinations", passed)
    for most, outcome in ((12, PassedError), (11, UsageError)):
        monkeypatch.setattr(sweep, "MOST_RUNS", most)
        with pytest.raises(outcome):
            dqpaint.sweep("star", {"k": (5, 10, 20)}, controller="p", plant="ideal", runs=4)

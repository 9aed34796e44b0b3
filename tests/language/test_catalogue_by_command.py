"""Messages as `dqpaint check --json` gives them: one of each kind, the same as in this process."""

import json
import shutil
import subprocess
import sys
from pathlib import Path

import pytest

from dqpaint.diagnostics.diagnostic import Diagnostic, locate
from tests.support.wrong_drawings import ENTRIES, FILES, LARGE, OF_FILES, found, only, write

KINDS = {
    "# nothing": "no place",
    "let café = 3": "letters beyond ASCII before the caret",
    "line to (0, 0, 70 mm": "a label, a help, no fix",
    "move to (1, 2) mm;": "a fix",
    "period 3 ms~period 4 ms": "another line",
    "def star(r)~line by (r, 0)~end~star(5)": "called from elsewhere",
    'path "bad.csv" unit mm': "a file beside it",
    'svg "otherwise.svg"': "a warning",
}
BESIDES = {"E140", "W403", "W411"}  # what is true of these little texts, too


def checked(paths: list[Path]) -> dict[str, list[dict]]:
    """What the command finds in each file."""
    command = [sys.executable, "-m", "dqpaint", "check", "--json", *map(str, paths)]
    done = subprocess.run(command, capture_output=True, text=True, timeout=120, check=False)
    assert (done.returncode, done.stderr) == (1, "")
    told: dict[str, list[dict]] = {}
    for finding in json.loads(done.stdout)["diagnostics"]:
        told.setdefault(finding["file"], []).append(finding)
    return told


def same(finding: dict, diagnostic: Diagnostic, text: str) -> None:
    for name in ("code", "message", "label", "help"):
        assert finding[name] == getattr(diagnostic, name)
    assert finding["severity"] == diagnostic.severity
    assert len(finding["related"]) == len(diagnostic.related)
    assert (finding["fix"] is None) == (diagnostic.fix is None)
    ends = ("start", "end")
    if diagnostic.span is None:
        assert [finding[end] for end in ends] == [None, None]
        return
    for end in ends:
        line, column = locate(text, getattr(diagnostic.span, end))
        assert finding[end] == {"line": line, "column": column}


@pytest.mark.slow
def test_a_message_of_each_kind(tmp_path: Path) -> None:
    for file in FILES.iterdir():
        shutil.copy(file, tmp_path)
    entries = {tmp_path / f"{i}.traj": e for i, e in enumerate(ENTRIES) if e[0] in KINDS}
    assert len(entries) == len(KINDS)
    for path, entry in entries.items():
        path.write_text(entry[0].replace("~", "\n"), "utf-8")
    (tmp_path / "include").mkdir()
    code, files, of_file, caret = next(case for case in OF_FILES if case[2] == "in/b.traj")
    main = write(tmp_path / "include", files)
    long = tmp_path / "long.traj"
    long.write_text(LARGE["words"][0])

    told = checked([*entries, main, long])
    for path, entry in entries.items():
        one = only(entry)
        (finding,) = (
            f for f in told[str(path)] if f["code"] == one.code or f["code"] not in BESIDES
        )
        same(finding, one, path.read_text("utf-8"))
    (finding,) = told[str(tmp_path / "include" / of_file)]
    assert finding["code"] == code
    assert "{line}:{column}".format(**finding["start"]) == caret.partition(" ")[0]
    same(told[str(long)][0], found(LARGE["words"][0])[0], LARGE["words"][0])


@pytest.mark.slow
def test_what_is_too_large_is_not_even_read(tmp_path: Path) -> None:
    path = tmp_path / "a.traj"
    path.write_text(LARGE["size"][0])
    (finding,) = checked([path])[str(path)]
    assert finding["code"] == "E001"

"""Every message of the catalogue once more, as `dqpaint check --json` gives it."""

import json
import shutil
import subprocess
import sys
from pathlib import Path

import pytest

from tests.support.wrong_drawings import ENTRIES, FILES, LARGE, OF_FILES, write

BESIDES = {"E140", "W403", "W411"}  # what is true of these little texts, too


def checked(paths: list[Path]) -> dict[str, list[dict]]:
    command = [sys.executable, "-m", "dqpaint", "check", "--json", *map(str, paths)]
    done = subprocess.run(command, capture_output=True, text=True, timeout=120, check=False)
    assert (done.returncode, done.stderr) == (1, "")
    found: dict[str, list[dict]] = {}
    for finding in json.loads(done.stdout)["diagnostics"]:
        found.setdefault(finding["file"], []).append(finding)
    return found


@pytest.mark.slow
def test_the_table(tmp_path: Path) -> None:
    paths = {}
    for i, entry in enumerate(ENTRIES):
        if "that is no file" not in entry[3]:
            paths[tmp_path / f"{i}.traj"] = entry
            (tmp_path / f"{i}.traj").write_text(entry[0].replace("~", "\n"))
    for file in FILES.iterdir():
        shutil.copy(file, tmp_path)
    found = checked(list(paths))
    for path, (source, code, caret, message, label, cure) in paths.items():
        (finding,) = (f for f in found[str(path)] if f["code"] == code or f["code"] not in BESIDES)
        said = (finding["code"], finding["message"], finding["label"], finding["help"])
        assert said == (code, message, label, cure), source
        at = finding["start"] and "{line}:{column}".format(**finding["start"])
        assert (at or "") == caret.partition(" ")[0]


@pytest.mark.slow
def test_those_of_several_files(tmp_path: Path) -> None:
    cases = [(code, *case) for code, cases in OF_FILES.items() for case in cases]
    mains = []
    for i, (_, files, *_) in enumerate(cases):
        (tmp_path / str(i)).mkdir()
        mains.append(write(tmp_path / str(i), files))
    found = checked(mains)
    for i, (code, _, file, caret, message) in enumerate(cases):
        (finding,) = found[str(tmp_path / str(i) / file)]
        assert (finding["code"], finding["message"][: len(message)]) == (code, message)
        assert "{line}:{column}".format(**finding["start"]) == caret.partition(" ")[0]


@pytest.mark.slow
def test_the_large_ones(tmp_path: Path) -> None:
    """The text beyond 2 MB is not even read, and so a file that can't be."""
    paths = [tmp_path / f"{i}.traj" for i in range(len(LARGE))]
    for path, text in zip(paths, LARGE, strict=True):
        path.write_bytes(text.encode())
    found = checked(paths)
    for path, (code, message) in zip(paths, LARGE.values(), strict=True):
        first = found[str(path)][0]
        if code == "E305":
            assert (first["code"], first["message"]) == ("E001", f"{path} is larger than 2 MB")
        else:
            assert (first["code"], first["message"][: len(message)]) == (code, message)

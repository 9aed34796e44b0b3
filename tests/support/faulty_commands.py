"""Commands that read and write, each in a folder of its own -> what a fault leaves of it."""

import contextlib
import errno
import json
import os
import shutil
from collections.abc import Iterator
from dataclasses import dataclass, replace
from pathlib import Path

from dqpaint.studies.runner.journal import NAME, decode_line
from tests.support.faults import (
    OF_KIND,
    Answer,
    Faults,
    NoMemory,
    forget,
    workers_in_this_process,
)

Contents = dict[str, bytes]
DRAWING = """period 20 ms
start at (0, 0) mm
include "more.traj"
path "points.csv" unit mm in 400 ms light orange
"""
OTHER = "period 20 ms\nstart at (0, 0) mm\nline to (10, 20) mm in 200 ms\n"
MORE = "line to (30, 10) mm in 400 ms light cyan\n"
POINTS = "x,y\n0,0\n10,5\n5,20\n"
SETTINGS = 'plant = "ideal"\nsize = "64x36"\ncontroller = "p"\n'
CASES = '[one]\ndrawing = "other.traj"\nplant = "ideal"\nwidth = 64\nheight = 36\n'
GAIN = "--gain=k=20"
CHANGE = ("change the drawing",)
DRAW = ("draw", "a.traj", "--settings", "set.toml", "--save", "png,csv,json,film", "--out", "out/")
SWEEP = ("sweep", "other.traj", "--plant", "ideal", "--controller", "p", "--out", "study")


@dataclass(frozen=True)
class Command:
    """A command under test.

    Attributes:
        words: of it.
        before: commands that make what it finds, such as older files of the same names.
    """

    words: tuple[str, ...]
    before: tuple[tuple[str, ...], ...] = ()


COMMANDS = {
    "draw": Command((*DRAW, GAIN), ((*DRAW, "--gain=k=5"),)),
    "develop": Command(
        ("develop", "out/a-p-film.npz", "--look", "agx", "--view", "front,iso", "--out", "out/"),
        (DRAW, ("develop", "out/a-p-film.npz", "--view", "front,iso", "--out", "out/")),
    ),
    "sweep": Command((*SWEEP, "--vary", "k=5,10,20"), ((*SWEEP, "--vary", "k=5,40"),)),
    "verify": Command(("verify", "."), (("verify", ".", "--update"),)),
    "update": Command(("verify", ".", "--update"), (("verify", ".", "--update"), CHANGE)),
    "export": Command(
        ("export", "a.traj", "--plant", "ideal", "--format", "ros2", "--out", "out/"),
        ((*DRAW, GAIN),),
    ),
    "fmt": Command(("fmt", "ugly.traj")),
    "new": Command(("new", "wish")),
}


@dataclass(frozen=True)
class Outcome:
    """What a command answered under a fault, the folder after it, and after another try."""

    failed: str
    why: str
    answer: Answer
    left: Contents
    healed: Contents


class Trial:
    """A command, and the folder that it finds.

    Args:
        name: of the command.
        root: a new folder for it.
    """

    def __init__(self, name: str, root: Path) -> None:
        self.command, self.root = COMMANDS[name], root
        self._found = root / "found"
        self._found.mkdir(parents=True)
        lay_down(self._found)
        for words in self.command.before:
            with _at_work_in(self._found):
                if words == CHANGE:
                    Path("other.traj").write_text(OTHER.replace("20)", "25)"))
                    continue
                done = Answer(*words)
                assert done.code == 0, done.err
        self.before = contents(self._found)
        with self._copy() as place, Faults() as seen:
            assert Answer(*self.command.words).code == 0
        self.after = contents(place)
        self.calls = seen.calls
        with self._copy(), NoMemory() as memory:
            Answer(*self.command.words)
        self.lines = len(memory.calls)

    @contextlib.contextmanager
    def _copy(self) -> Iterator[Path]:
        place = self.root / "now"
        shutil.rmtree(place, ignore_errors=True)
        shutil.copytree(self._found, place)
        with _at_work_in(place):
            yield place

    def outcome(self, faults: Faults | NoMemory) -> Outcome:
        """The command with a fault, and once more without."""
        with self._copy() as place:
            with faults:
                answer = Answer(*self.command.words)
            left = contents(place)
            forget()
            again = Answer(*self.command.words)
            assert again.code == 0 or "is there already" in again.err, again.err
        why = os.strerror(faults.code) if isinstance(faults, Faults) else "memory"
        return Outcome(faults.failed, why, answer, left, contents(place))

    def every_fault(self) -> list[Faults | NoMemory]:
        """Each call for a file with each error it may meet, once and, if disks fill, for good."""
        made: list[Faults | NoMemory] = []
        for number, kind in enumerate(self.calls):
            made += [Faults(number, code) for code in OF_KIND[kind]]
            if errno.ENOSPC in OF_KIND[kind]:
                made.append(Faults(number, errno.ENOSPC, lasting=True))
        return made + [NoMemory(number) for number in range(self.lines)]

    def complaints(self, found: Outcome) -> list[str]:
        """What is wrong with an outcome; nothing if all is as promised."""
        answer, told = found.answer, []
        said = answer.out + answer.err
        if answer.code not in (0, 1):
            told.append(f"exit code {answer.code}")
        if "Traceback" in said or "internal error" in said:
            told.append("internal error")
        if answer.code and found.why.lower() not in said.lower():
            told.append("does not say why")
        if answer.code and sum("error:" in line for line in answer.err.splitlines()) > 1:
            told.append("more than a sentence")
        visible = {name: data for name, data in found.left.items() if not _is_hidden(name)}
        if answer.code == 0 and "died" not in said and self._told(visible, self.after):
            told.append("done, but not whole")
        if answer.code and "complete on the disk" not in said:
            told += self._mixed(found.left)
        hidden = [name for name in found.healed if _is_hidden(name)]
        if found.failed == "unlink" and self.command.words[0] in ("fmt", "new"):
            for name in hidden:  # they remove what others left only where they write a set
                del found.healed[name]
        left = self._told(found.healed, self.after)
        if left:
            told.append(f"not healed: {left}")
        return [f"{found.failed} {found.why}: {one}: {said.strip()[-300:]}" for one in told]

    def _mixed(self, left: Contents) -> list[str]:
        """Files that are neither old nor new, and sets of both."""
        told, ages = [], dict[str, set[str]]()
        for name in self.before.keys() | self.after.keys():
            old, new, now = (files.get(name) for files in (self.before, self.after, left))
            if name.endswith(NAME):  # it grows run by run
                continue
            if now not in (old, new):
                told.append(f"{name} is neither old nor new")
            elif old != new and "/kept/" not in name:
                ages.setdefault(name.split("-")[0].split(".")[0], set()).add(
                    "old" if now == old else "new"
                )
        return told + [f"{name}: old and new" for name, both in ages.items() if len(both) > 1]

    @staticmethod
    def _told(found: Contents, wanted: Contents) -> list[str]:
        names = {name for name in found if "runs-cut" not in name} | wanted.keys()
        return sorted(name for name in names if found.get(name) != wanted.get(name))


def _is_hidden(name: str) -> bool:
    """Whether it is a temporary file, which who next writes to the folder removes."""
    return Path(name).name.startswith(".dqpaint-")


@contextlib.contextmanager
def _at_work_in(folder: Path) -> Iterator[None]:
    """Commands run there, with nothing in the caches."""
    forget()
    with contextlib.chdir(folder), workers_in_this_process():
        yield


def lay_down(folder: Path) -> None:
    """Files that the commands read."""
    for name, text in {
        "a.traj": DRAWING, "more.traj": MORE, "points.csv": POINTS, "set.toml": SETTINGS,
        "other.traj": OTHER, "cases.toml": CASES, "ugly.traj": "line   to (1,2)mm\n",
    }.items():  # fmt: skip
        (folder / name).write_text(text)
    (folder / "out").mkdir()


def contents(folder: Path) -> Contents:
    """All files below a folder by their names; what a clock decides is left out."""
    found = {}
    for path in sorted(folder.rglob("*")):
        if path.is_file():
            found[str(path.relative_to(folder))] = _without_times(path)
    return found


def _without_times(path: Path) -> bytes:
    data = path.read_bytes()
    if path.suffix == ".json":
        facts = json.loads(data)
        facts.pop("wall_s", None)
        if "versions" in facts:  # of a library whose own file cannot be read it is null
            facts["versions"] = sorted(facts["versions"])
        return json.dumps(facts).encode()
    if path.name == NAME:  # of each run the last try; a line without an end stays as it is
        whole, _, tail = data.rpartition(b"\n")
        results = [replace(decode_line(line), wall=0.0) for line in whole.splitlines()]
        return repr(sorted({r.key: r for r in results}.items())).encode() + tail
    return data

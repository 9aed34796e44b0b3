"""A sweep that is killed, has no disk left, or finds its journal damaged -> what came of its table.

`python -m tests.tools.hardships [KILLS FULL DAMAGES]` takes minutes (50, 10 and 100 if not said). A
sweep of twelve runs on the ideal arm is

- killed at random moments (SIGKILL and SIGTERM to the study, SIGINT to its group, SIGKILL to a
  worker) and called again until it ends by itself,
- given a journal that may not grow beyond some bytes (RLIMIT_FSIZE, which a kernel enforces as it
  does a full disk), and called again without,
- called with a journal that was damaged in some way.

In the end its table, page and picture have to be those of a sweep that nothing befell, bit for bit,
or the damage is told with file and line, and the journal is as it was found.
"""

import contextlib
import os
import random
import resource
import shutil
import signal
import subprocess
import sys
import tempfile
import time
from collections import Counter
from collections.abc import Callable
from pathlib import Path

from tests.support.faults import Answer, workers_in_this_process

DRAWING = "period 20 ms\nstart at (0, 0) mm\nline to (30, 10) mm in 400 ms\n"
WORDS = ("sweep", "a.traj", "--plant", "ideal", "--controller", "p", "--vary", "k=2..300:log:12",
         "--jobs", "2", "--out", "study")  # fmt: skip
ENDS = ("-table.csv", "-table.md", "-runs.csv", ".png")
JOURNAL = "runs.jsonl"
LONGEST = 120.0  # [s]


def start(folder: Path, most_bytes: int | None = None) -> "subprocess.Popen[str]":
    """The sweep in a process group of its own."""

    def prepare() -> None:
        signal.signal(signal.SIGINT, signal.SIG_DFL)
        if most_bytes is not None:
            signal.signal(signal.SIGXFSZ, signal.SIG_IGN)
            resource.setrlimit(resource.RLIMIT_FSIZE, (most_bytes, most_bytes))

    return subprocess.Popen(
        [sys.executable, "-m", "dqpaint", *WORDS], cwd=folder, text=True, start_new_session=True,
        stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, preexec_fn=prepare,
    )  # fmt: skip


def tables(folder: Path) -> list[bytes]:
    """What the sweep has written."""
    return [(folder / "study" / f"a-k{end}").read_bytes() for end in ENDS]


def made(root: Path, name: object) -> Path:
    """A new folder with the drawing."""
    folder = root / str(name)
    folder.mkdir()
    (folder / "a.traj").write_text(DRAWING)
    return folder


def finished(folder: Path, **how: int) -> tuple[int, str]:
    """Exit code and messages of the sweep."""
    process = start(folder, **how)
    said = process.communicate(timeout=LONGEST)[1]
    return process.returncode, said


def killed(folder: Path, chance: random.Random, usual: float) -> str:
    """Kill the sweep at a random moment; says how."""
    process = start(folder)
    how = chance.choice(["SIGKILL", "SIGTERM", "SIGINT", "worker"])
    time.sleep(usual * chance.random())
    with contextlib.suppress(ProcessLookupError):
        if how == "worker":
            workers = subprocess.run(["pgrep", "-P", str(process.pid)], capture_output=True,
                                     text=True, check=False).stdout.split()  # fmt: skip
            if workers:
                os.kill(int(chance.choice(workers)), signal.SIGKILL)
        elif how == "SIGINT":
            os.killpg(process.pid, signal.SIGINT)
        else:
            os.kill(process.pid, getattr(signal, how))
    said = process.communicate(timeout=LONGEST)[1]
    if "Traceback" in said or "internal error" in said:
        raise AssertionError(said)
    return f"{how}: ended by itself" if process.returncode == 0 else how


def kills(root: Path, whole: list[bytes], count: int, usual: float) -> Counter[str]:
    """Sweeps that are killed up to four times each before they may end."""
    chance, told, left = random.Random(3), Counter[str](), count
    for number in range(count):
        folder = made(root, f"kill{number}")
        for _ in range(min(left, chance.randrange(1, 5))):
            told[killed(folder, chance, usual)] += 1
            left -= 1
        code, said = finished(folder)
        same = code == 0 and tables(folder) == whole
        told["table the same" if same else f"WRONG {code} {said[-200:]}"] += 1
        if not left:
            break
    return told


def full_disks(root: Path, whole: list[bytes], count: int) -> Counter[str]:
    """Sweeps that may write so many bytes a file."""
    chance, told = random.Random(5), Counter[str]()
    for number in range(count):
        folder = made(root, f"full{number}")
        code, said = finished(folder, most_bytes=chance.randrange(100, 9000))
        plain = code == 1 and "cannot be written: File too large" in said and "Trace" not in said
        told["told" if plain else f"WRONG {code} {said[-200:]}"] += 1
        code, said = finished(folder)
        same = code == 0 and tables(folder) == whole
        told["table the same" if same else f"WRONG {code} {said[-200:]}"] += 1
    return told


def damage(data: bytes, chance: random.Random) -> tuple[str, bytes]:
    """A kind of damage, and a journal that has it."""
    at, size = chance.randrange(len(data)), chance.choice([1, 2, 40, 500, 4096])
    lines = data.splitlines(keepends=True)
    kinds: dict[str, Callable[[], bytes]] = {
        "a bit": lambda: data[:at] + bytes([data[at] ^ 1 << chance.randrange(8)]) + data[at + 1 :],
        "a digit": lambda: _digit(data, chance),
        "zeros": lambda: data[:at] + bytes(len(data[at : at + size])) + data[at + size :],
        "bytes lost": lambda: data[:at] + data[at + size :],
        "bytes put in": lambda: data[:at] + chance.randbytes(size) + data[at:],
        "cut off": lambda: data[:at],
        "lines lost": lambda: b"".join(line for line in lines if chance.random() < 0.6),
        "lines doubled": lambda: b"".join(chance.choices(lines, k=len(lines))),
        "lines in another order": lambda: b"".join(chance.sample(lines, len(lines))),
        "a foreign line": lambda: b"".join([*lines[:3], b'{"x": 1}\n', *lines[3:]]),
    }
    kind = chance.choice(list(kinds))
    return kind, kinds[kind]()


def _digit(data: bytes, chance: random.Random) -> bytes:
    at = chance.choice([i for i, byte in enumerate(data) if 48 <= byte <= 57])
    return data[:at] + b"%d" % ((data[at] - 48 + chance.randrange(1, 10)) % 10) + data[at + 1 :]


def damages(root: Path, whole: list[bytes], good: Path, count: int) -> Counter[str]:
    """Sweeps with a journal that was damaged; in this process, which is faster."""
    chance, told = random.Random(11), Counter[str]()
    for number in range(count):
        folder = root / f"damage{number}"
        shutil.copytree(good, folder)
        journal = folder / "study" / JOURNAL
        kind, data = damage(journal.read_bytes(), chance)
        journal.write_bytes(data)
        for end in ENDS:
            (folder / "study" / f"a-k{end}").unlink()
        with contextlib.chdir(folder), workers_in_this_process():
            answer = Answer(*WORDS)
        code, said = answer.code, answer.err
        if code == 0 and tables(folder) == whole:
            told[f"{kind}: table the same"] += 1
        elif code == 1 and f"{JOURNAL}' line " in said and journal.read_bytes() == data:
            told[f"{kind}: told"] += 1
        else:
            told[f"{kind}: WRONG {code} {said[-200:]}"] += 1
    return told


def main(kill: int = 50, full: int = 10, damaged: int = 100) -> bool:
    """Print what came of it; whether nothing was lost."""
    with tempfile.TemporaryDirectory() as name:
        root = Path(name)
        good = made(root, "whole")
        begin = time.monotonic()
        code, said = finished(good)
        assert code == 0, said
        usual, whole = time.monotonic() - begin, tables(good)
        wrong = False
        for title, told in (
            (f"{kill} kills", lambda: kills(root, whole, kill, usual)),
            (f"{full} full disks", lambda: full_disks(root, whole, full)),
            (f"{damaged} damaged journals", lambda: damages(root, whole, good, damaged)),
        ):
            print(title, flush=True)
            for what, count in sorted(told().items()):
                print(f"  {count:4d}  {what}", flush=True)
                wrong |= "WRONG" in what
    return not wrong


if __name__ == "__main__":
    sys.exit(not main(*map(int, sys.argv[1:])))

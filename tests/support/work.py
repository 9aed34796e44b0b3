"""Work counted in calls of functions, the same on every machine, in place of seconds."""

import cProfile
import os
import re
import resource
import subprocess
import sys
from functools import partial
from pathlib import Path
from types import FrameType
from typing import NamedTuple

ROOT = Path(__file__).parents[2]
FAR_TOO_LONG = 120  # [s] a process that takes so long is taken to hang
MOST_BYTES = 300 << 20  # of data


class TooMuchWorkError(BaseException):
    """Stops what would go on for long; not an Exception, so that nothing takes it for its own."""


class Calls:
    """Counts the calls of functions, of Python and of C, within a `with`.

    A call of C counts once, however long it takes: against that, processes have a generous
    timeout and a bound of memory, and benches their ratios.
    """

    def __init__(self, most: int) -> None:
        self.most, self.count = most, 0

    def __enter__(self) -> "Calls":
        sys.setprofile(self._called)
        return self

    def __exit__(self, *_: object) -> None:
        sys.setprofile(None)

    def _called(self, _frame: FrameType, event: str, _argument: object) -> None:
        if event in ("call", "c_call"):
            self.count += 1
            if self.count > self.most:
                raise TooMuchWorkError(f"more than {self.most:,} calls")


class Answer(NamedTuple):
    """What a process answers: its exit code, what it says, the calls it made."""

    code: int
    said: str
    calls: int


def checked(path: Path, most: int = MOST_BYTES) -> Answer:
    """`dqpaint check` of a file, in a process of its own with a bound of memory [bytes]."""
    done = subprocess.run(
        [sys.executable, "-m", "tests.support.work", "check", str(path)],
        capture_output=True, text=True, preexec_fn=partial(_limit, most), check=False,
        timeout=FAR_TOO_LONG, cwd=ROOT, env={**os.environ, "OPENBLAS_NUM_THREADS": "1"},
    )  # fmt: skip
    said, count = re.fullmatch(r"(.*)calls (\d+)\n", done.stdout + done.stderr, re.DOTALL).groups()
    return Answer(done.returncode, said, int(count))


def _limit(most: int) -> None:
    resource.setrlimit(resource.RLIMIT_DATA, (most, most))


if __name__ == "__main__":
    from dqpaint.cli import main

    sys.argv[0] = "dqpaint"
    code, profile = 0, cProfile.Profile()
    try:
        profile.runcall(main.run)
    except SystemExit as stop:
        code = stop.code
    sys.stdout.flush()
    print(f"calls {sum(entry.callcount for entry in profile.getstats())}", file=sys.stderr)
    sys.exit(code)

"""Every command with every fault of files and memory in turn -> what was not as promised, counts.

`python -m tests.tools.faults [COMMAND ...]` takes minutes a command. A fault is one call for a file
that fails, with each error it may meet; one that fails from then on, as on a full disk; or one line
of the package that gets no memory. After each the command is called again and has to come to what
it comes to without a fault.
"""

import sys
import tempfile
import time
from collections import Counter
from pathlib import Path

from tests.support.faults import NoMemory
from tests.support.faulty_commands import COMMANDS, Trial


def main(names: list[str]) -> int:
    """Print a row a command, and each complaint."""
    wrong = 0
    print("| command | calls for files | faults of files | of memory | complaints | s |")
    print("|---|---|---|---|---|---|")
    for name in names or COMMANDS:
        begin = time.monotonic()
        with tempfile.TemporaryDirectory() as folder:
            trial = Trial(name, Path(folder) / name)
            faults = trial.every_fault()
            told = Counter[str]()
            for fault in faults:
                try:
                    told.update(trial.complaints(trial.outcome(fault)))
                except AssertionError as problem:
                    told[f"another try: {problem}"] += 1
        memory = sum(isinstance(fault, NoMemory) for fault in faults)
        seconds = time.monotonic() - begin
        print(f"| {name} | {len(trial.calls)} | {len(faults) - memory} | {memory} | "
              f"{told.total()} | {seconds:.0f} |", flush=True)  # fmt: skip
        for text, count in told.items():
            print(f"  {count} times {text}", file=sys.stderr)
        wrong += told.total()
    return wrong


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]) > 0)

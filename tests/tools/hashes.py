"""constraints.txt -> constraints-hashes.txt: the SHA-256 of each file that pip would install.

`python -m tests.tools.hashes` asks pip what it would take on this machine and writes it again; the
versions are those of constraints.txt, the files those of this system and this Python.
"""

import json
import subprocess
import sys
import tempfile
from pathlib import Path

ROOT = Path(__file__).parents[2]
PINS, HASHES = ROOT / "constraints.txt", ROOT / "constraints-hashes.txt"
HEAD = """\
# What constraints.txt names, with the SHA-256 of its files for Linux on x86-64 and Python 3.11:
#   pip install --require-hashes --no-deps -r constraints-hashes.txt && pip install --no-deps .
# For another system: python -m tests.tools.hashes
"""


def hashes_text(report: dict[str, object]) -> str:
    """The lines of a report of pip.

    Raises:
        ValueError: a file has no SHA-256.
    """
    lines = []
    installs = report["install"]
    assert isinstance(installs, list)
    for one in installs:
        about = one["metadata"]
        digest = one["download_info"]["archive_info"].get("hashes", {}).get("sha256")
        if not digest:
            raise ValueError(f"pip tells no SHA-256 of {about['name']}")
        lines.append(f"{about['name']}=={about['version']} --hash=sha256:{digest}")
    return HEAD + "".join(f"{line}\n" for line in sorted(lines, key=str.lower))


def main() -> None:
    """Ask pip and write the file."""
    with tempfile.TemporaryDirectory() as scratch:
        path = Path(scratch) / "report.json"
        subprocess.run(
            [sys.executable, "-m", "pip", "install", "-q", "--dry-run", "--ignore-installed",
             "--no-deps", "--report", str(path), "-r", str(PINS)], check=True,
        )  # fmt: skip
        report = json.loads(path.read_text("utf-8"))
    HASHES.write_text(hashes_text(report), "utf-8")


if __name__ == "__main__":
    main()

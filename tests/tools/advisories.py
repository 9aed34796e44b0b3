"""constraints.txt -> known advisories about what it names, by pip-audit, which has to be there.

`python -m tests.tools.advisories` prints them; exit code 1 if there are any, 2 without pip-audit
(pip install pip-audit, best in an environment of its own: PIP_AUDIT names its command then). It
asks osv.dev by the names and versions, so it needs a network, and its answer changes from day to
day: that is why it is a tool and no test.
"""

import os
import shutil
import subprocess
import sys

from tests.tools.hashes import PINS


def main() -> int:
    """Ask for advisories."""
    command = shutil.which(os.environ.get("PIP_AUDIT", "pip-audit"))
    if command is None:
        print("pip-audit is not installed: pip install pip-audit", file=sys.stderr)
        return 2
    words = [command, "--requirement", str(PINS), "--no-deps", "--disable-pip",
             "--vulnerability-service", "osv"]  # fmt: skip
    return subprocess.run(words, check=False).returncode


if __name__ == "__main__":
    sys.exit(main())

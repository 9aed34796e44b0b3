"""The command `dqpaint`, also as `python -m dqpaint`."""

import sys

INTERRUPTED = 130


def main() -> None:
    """Run the command line: exit code 0 done, 1 a fault, 2 wrong usage, 130 interrupted."""
    try:
        from dqpaint.cli import run  # takes a moment, in which a Ctrl-C may come

        run()
    except KeyboardInterrupt:
        print("interrupted", file=sys.stderr)
        sys.exit(INTERRUPTED)


if __name__ == "__main__":
    main()

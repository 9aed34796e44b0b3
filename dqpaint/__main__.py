"""`python -m dqpaint` is the command `dqpaint`."""

from dqpaint.cli import main

if __name__ == "__main__":
    main()

"""What happens inside -> the loggers of `logging`, if the program has any."""

import sys


def log(room: str, text: str, *values: object, detail: bool = False) -> None:
    """Log what happened, as `logging` does, under the logger `dqpaint.ROOM`.

    Where nobody has imported `logging`, nobody listens, and a start does not pay for it.

    Args:
        room: such as `painting`.
        text: with places for the values: `%s`, `%.3f`.
        values: that are put there.
        detail: whether it is DEBUG; else it is INFO.
    """
    logging = sys.modules.get("logging")
    if logging is not None:
        logger = logging.getLogger(f"dqpaint.{room}")
        (logger.debug if detail else logger.info)(text, *values)

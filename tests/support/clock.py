"""Time that other work on the same machine does not lengthen."""

import os


def children_time() -> float:
    """Processor time [s] of all processes that were started and have ended."""
    spent = os.times()
    return spent.children_user + spent.children_system

"""Seconds that a run may take -> a context that ends it then, wherever it is."""

import math
import signal
import threading
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager

from dqpaint.errors import TimeLimitError

AGAIN = 1.0  # [s] after which a law that caught the error meets it again


@contextmanager
def limit_time(seconds: float) -> Iterator[Callable[[], None]]:
    """A context that raises when its time is over; yields a check to be called now and then.

    The check is all there is in a thread, and on systems without timer signals. Elsewhere a signal
    also ends what sleeps or computes in Python and never comes to the check, such as a user's law;
    what hangs in a library does not notice it before it comes back.

    Args:
        seconds: from now.

    Raises:
        TimeLimitError: where the code is when the time is over.
    """
    end = time.monotonic() + seconds

    def check(*_signal: object) -> None:
        if time.monotonic() >= end:
            raise TimeLimitError(
                f"the run has not ended after {seconds:g} s; "
                f"--timeout {4 * seconds:g} gives it more"
            )

    if not hasattr(signal, "setitimer") or threading.current_thread() != threading.main_thread():
        yield check
        return
    before = signal.signal(signal.SIGALRM, check)
    signal.setitimer(signal.ITIMER_REAL, seconds, AGAIN)
    try:
        yield check
    finally:
        end = math.inf  # a signal that is on its way finds nothing to end
        signal.setitimer(signal.ITIMER_REAL, 0.0)
        signal.signal(signal.SIGALRM, before)

"""The door to pybullet: a connection to a world of its own, without PyBullet's output."""

import ctypes
import os
import sys
from collections.abc import Iterator
from contextlib import contextmanager
from typing import Any, Self

from dqpaint.core import Library


@contextmanager
def quiet() -> Iterator[None]:
    """Discard what C code prints meanwhile; its buffer is flushed first."""
    c_library = ctypes.CDLL(None)
    _flush(c_library)
    kept = {stream: os.dup(stream) for stream in (1, 2) if _is_open(stream)}
    nothing = os.open(os.devnull, os.O_WRONLY)
    try:
        for stream in kept:
            os.dup2(nothing, stream)
        yield
        _flush(c_library)
    finally:
        for stream, copy in kept.items():
            os.dup2(copy, stream)
            os.close(copy)
        os.close(nothing)


def _is_open(stream: int) -> bool:
    try:
        os.fstat(stream)
    except OSError:
        return False
    return True


def _flush(c_library: ctypes.CDLL) -> None:
    for stream in (sys.stdout, sys.stderr):
        if stream is not None:
            stream.flush()
    c_library.fflush(None)


bullet: Any = Library("pybullet", "pybullet")
"""It writes a line when it is imported: so its first use is within `quiet`."""


class Client:
    """A connection to a private PyBullet world, until it is closed."""

    def __init__(self) -> None:
        with quiet():
            self.client: int = bullet.connect(bullet.DIRECT)

    def close(self) -> None:
        """Disconnect from the world."""
        bullet.disconnect(self.client)

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *fault: object) -> None:
        """Close it."""
        self.close()


def joint_indices(body: int, client: int) -> list[int]:
    """The indices of a body's movable joints, in the order of the chain."""
    infos = (
        bullet.getJointInfo(body, i, physicsClientId=client)
        for i in range(bullet.getNumJoints(body, physicsClientId=client))
    )
    return [info[0] for info in infos if info[2] != bullet.JOINT_FIXED]

"""What light was solved for -> the light, kept in a folder beside the drawing."""

import contextlib
import hashlib
import io
from pathlib import Path

import numpy as np

from dqpaint.core import examples_folder, read_regular, write_new
from dqpaint.dq import Floats
from dqpaint.errors import DqpaintError

FOLDER = ".dqpaint-light"
VERSION = b"1"  # of the solver: another number, and all is solved again
MOST_BYTES = 400_000_000


class LightCache:
    """The powers of photographs' lamps by the hash of all that they were solved from.

    Args:
        name: of the drawing, as its path; where there is no such file, and beside the examples,
            which may lie within the installed package, nothing is kept.
    """

    def __init__(self, name: str) -> None:
        path = Path(name)
        kept = path.is_file() and path.resolve().parent != examples_folder().resolve()
        self._folder = path.parent / FOLDER if kept else None

    def key(self, *arrays: Floats | None) -> str:
        """The hash of arrays."""
        summed = hashlib.sha256(VERSION)
        for array in arrays:
            if array is not None:
                summed.update(str((array.shape, array.dtype)).encode())
                summed.update(np.ascontiguousarray(array).tobytes())
        return summed.hexdigest()[:24]

    def read(self, key: str, rows: int) -> Floats | None:
        """The powers (rows, 3) for a key; None where there are none, or none that are sound."""
        if self._folder is None:
            return None
        try:
            file = io.BytesIO(read_regular(self._folder / f"{key}.npy", MOST_BYTES))
            powers = np.load(file, allow_pickle=False)
        except (OSError, ValueError, EOFError):
            return None
        sound = powers.shape == (rows, 3) and powers.dtype == np.float32
        return powers if sound and (powers >= 0.0).all() and (powers <= 1.0).all() else None

    def write(self, key: str, powers: Floats) -> None:
        """Keep powers (K, 3); a folder that cannot be written keeps nothing."""
        if self._folder is None:
            return
        file = io.BytesIO()
        np.save(file, powers)
        with contextlib.suppress(OSError, DqpaintError):
            self._folder.mkdir(exist_ok=True)
            write_new(self._folder / f"{key}.npy", file.getvalue())

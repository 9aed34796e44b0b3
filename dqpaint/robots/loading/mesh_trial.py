"""Mesh files -> exit code 0 if Coal reads them; run as a process of its own.

python -m dqpaint.robots.loading.mesh_trial FILE ...
"""

import sys

from dqpaint.robots.urdf.meshes import LARGEST_TRIAL, LONGEST_TRIAL


def main(files: list[str]) -> None:
    """Read the files as Coal does.

    Raises:
        ValueError: one cannot be read.
    """
    _limit()
    from dqpaint.robots.kinematics.collisions import read_mesh

    for file in files:
        read_mesh(file, (1.0, 1.0, 1.0))


def _limit() -> None:
    """Have the system end this process if it takes too much."""
    try:
        import resource
    except ImportError:  # Windows: the one that waits ends it
        return
    resource.setrlimit(resource.RLIMIT_AS, (LARGEST_TRIAL, LARGEST_TRIAL))
    resource.setrlimit(resource.RLIMIT_CPU, (int(LONGEST_TRIAL), int(LONGEST_TRIAL)))
    resource.setrlimit(resource.RLIMIT_CORE, (0, 0))


if __name__ == "__main__":
    main(sys.argv[1:])

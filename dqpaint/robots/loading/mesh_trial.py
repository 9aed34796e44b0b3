"""Mesh files -> exit code 0 if every library reads them; run as a process of its own.

python -m dqpaint.robots.loading.mesh_trial FILE ...
"""

import sys
import tempfile
from pathlib import Path
from xml.sax.saxutils import quoteattr

from dqpaint.robots.urdf.meshes import LARGEST_TRIAL, LONGEST_TRIAL


def main(files: list[str]) -> None:
    """Read the files as PyBullet and coal do.

    Raises:
        ValueError: coal cannot read one; PyBullet's error otherwise.
    """
    _limit()
    from dqpaint.robots.bullet import Client, bullet, quiet
    from dqpaint.robots.kinematics.collisions import read_mesh

    for file in files:
        read_mesh(file, (1.0, 1.0, 1.0))
    shapes = (f"<geometry><mesh filename={quoteattr(file)}/></geometry>" for file in files)
    links = "".join(
        f'<link name="l{i}"><visual>{shape}</visual><collision>{shape}</collision></link>'
        for i, shape in enumerate(shapes)
    )
    joints = "".join(
        f'<joint name="j{i}" type="fixed"><parent link="l0"/><child link="l{i}"/></joint>'
        for i in range(1, len(files))
    )
    with tempfile.TemporaryDirectory() as folder, Client() as client, quiet():
        path = Path(folder) / "trial.urdf"
        path.write_text(f'<robot name="trial">{links}{joints}</robot>', "utf-8")
        bullet.loadURDF(str(path), physicsClientId=client.client)


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

"""What all pages share: the folder, the workers, the shapes of arms, the files that are served."""

import asyncio
from collections.abc import Sequence
from pathlib import Path

from dqpaint.studio.folder import DrawingFolder
from dqpaint.studio.work.messages import ArmShapes
from dqpaint.studio.work.pool import Worker

MOST_PAGES = 24  # open at once


class Studio:
    """What all pages share.

    Args:
        root: the folder whose drawings may be opened.
        laws: files of laws that the command line named.
    """

    def __init__(self, root: Path, laws: Sequence[str] = ()) -> None:
        self.folder = DrawingFolder(root)
        self.laws = tuple(laws)
        self.pages = 0
        self._shapes: dict[str, ArmShapes] = {}
        self._paths: dict[str, list[bytes]] = {}
        self._version = 0

    def start(self) -> None:
        """Start the workers; on the loop of the server."""
        loop = asyncio.get_running_loop()
        folders = [self.folder.root, *(Path(law.partition(":")[0]).parent for law in self.laws)]
        self.reader = Worker("read", folders, loop)
        self.runner = Worker("run", folders, loop)

    def close(self) -> None:
        """End the workers."""
        self.reader.close()
        self.runner.close()

    def keep_shapes(self, shapes: ArmShapes) -> None:
        """Keep the shapes of an arm, to be served."""
        self._shapes[shapes.robot] = shapes

    def shape_urls(self, robot: str) -> list[tuple[str, tuple[float, float, float]]]:
        """Where the shapes of an arm are served, and their colours."""
        kept = self._shapes.get(robot)
        if kept is None:
            return []
        index = list(self._shapes).index(robot)
        return [(f"/arm/{index}/{i}.stl", colour) for i, (_, colour) in enumerate(kept.shapes)]

    def shape(self, arm: int, index: int) -> bytes | None:
        """One shape that is served."""
        kept = list(self._shapes.values())[arm : arm + 1]
        shapes = kept[0].shapes[index : index + 1] if kept else ()
        return shapes[0][0] if shapes else None

    def serve_paths(self, page: str, files: list[bytes]) -> list[str]:
        """Serve the paths of a page in place of its last ones; their addresses."""
        self._version += 1
        self._paths[page] = files
        return [f"/path/{page}/{i}.glb?{self._version}" for i in range(len(files))]

    def path(self, page: str, index: int) -> bytes | None:
        """One path that is served."""
        files = self._paths.get(page, [])
        return files[index] if 0 <= index < len(files) else None

    def forget(self, page: str) -> None:
        """Drop what a page has asked and served."""
        self.reader.forget(page)
        self.runner.forget(page)
        self._paths.pop(page, None)

"""Folders that commands write to."""


def files(folder):
    """The names in it, in order."""
    return sorted(path.name for path in folder.iterdir())

"""The names of the libraries that a run's result depends on -> their versions here."""

LIBRARIES = {
    "mujoco": ("mujoco-core", "mujoco"),  # the engine, alone or with its shell
    "numpy": ("numpy",),
    "opencv-python-headless": ("opencv-python-headless",),
    "pin": ("pin",),
    "pybullet": ("pybullet", "pybullet-arm64"),  # the same module, built for other machines
}
"""Each with the names of the distributions that may bring it."""


def library_versions() -> dict[str, str]:
    """The version of each library; of a build under another name with that name."""
    return {library: _version(names) for library, names in LIBRARIES.items()}


def _version(names: tuple[str, ...]) -> str:
    from importlib.metadata import PackageNotFoundError, version  # slow, and few commands need it

    for name in names:
        try:
            found = version(name)
        except PackageNotFoundError:
            continue
        return found if name == names[0] else f"{found} ({name})"
    return "not installed"

"""Packages made for a test that bring things by entry points, as an installed one would."""

from pathlib import Path


def install(folder: Path, name: str, files: dict[str, str], points: str, version="1.2") -> None:
    """Lay out a package as pip would in a folder of `sys.path`.

    Args:
        folder: which `sys.path` or PYTHONPATH names.
        name: of the distribution and the package.
        files: module name -> text.
        points: of its entry_points.txt.
        version: of the distribution.
    """
    package = folder / name
    package.mkdir(parents=True)
    for file in {"__init__": "", **files}.items():
        (package / f"{file[0]}.py").write_text(file[1], "utf-8")
    facts = folder / f"{name}-{version}.dist-info"
    facts.mkdir()
    (facts / "METADATA").write_text(f"Metadata-Version: 2.1\nName: {name}\nVersion: {version}\n")
    (facts / "entry_points.txt").write_text(points)

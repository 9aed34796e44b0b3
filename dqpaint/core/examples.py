"""Name of an example drawing, or a path -> its file."""

from pathlib import Path

from dqpaint.errors import DqpaintError


def examples_folder() -> Path:
    """The folder of the examples: beside the package in a source tree, inside it when installed."""
    package = Path(__file__).parent.parent
    beside = package.parent / "trajectories"
    return beside if (package.parent / "pyproject.toml").is_file() else package / "trajectories"


def example_names() -> list[str]:
    """The names of the example drawings."""
    return sorted(path.stem for path in examples_folder().glob("*.traj"))


def find_drawing(name: str) -> Path:
    """The file for a path, or for an example's name with or without its ending.

    Raises:
        DqpaintError: neither a file nor an example.
    """
    if name == "-":
        raise DqpaintError("only check and fmt read standard input: write it into a file first")
    path = Path(name)
    example = examples_folder() / f"{name.removesuffix('.traj')}.traj"
    try:
        if name and path.exists() and not path.is_dir():
            return path
        if path.name == name and example.is_file():
            return example
        if name and path.is_dir():
            raise DqpaintError(f"'{name}' is a folder, not a drawing")
        guess = path.with_name(f"{path.name}.traj") if path.name else path
        if guess.is_file():
            raise DqpaintError(f"no file '{name}'; did you mean '{guess}'?")
    except (OSError, ValueError) as problem:
        reason = problem.strerror if isinstance(problem, OSError) else str(problem)
        raise DqpaintError(f"no file '{name[:60]}...': {(reason or '').lower()}") from None
    known = ", ".join(example_names())
    raise DqpaintError(f"no file '{name}', and no example of that name; the examples: {known}")

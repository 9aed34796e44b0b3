"""Name of an example drawing, or a path -> its file."""

from pathlib import Path

from dqpaint.errors import DqpaintError, closest


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
            check_drawing(path)
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
    examples = example_names()
    meant = closest(path.stem, examples) if path.name == name else ""
    asked = f"; did you mean '{meant}'?" if meant else ";"
    raise DqpaintError(
        f"no file '{name}', and no example of that name{asked} the examples: {', '.join(examples)}"
    )


NO_DRAWINGS = {
    (".png", ".jpg", ".jpeg", ".webp", ".tif", ".tiff"): "a picture: dqpaint trace {name} writes a "
    "drawing that paints it",
    (".gif", ".bmp", ".hdr"): "a picture; dqpaint trace takes PNG, JPEG, TIFF and WebP",
    (".svg",): 'an SVG: a line of a drawing takes its paths: svg "{name}" width 200 mm',
    (".npz",): "a film: dqpaint develop {name} makes pictures of it",
    (".csv",): "a table: dqpaint draw FILE --recorded {name} paints a run, dqpaint plot {name} "
    'shows one, and a line of a drawing takes its points: path "{name}"',
    (".json", ".toml"): "no drawing but settings: dqpaint draw FILE --settings {name}",
    (".urdf", ".xacro"): "an arm: dqpaint draw FILE --robot {name}",
    (".py",): "Python: dqpaint draw FILE --controller {name} takes a law",
    (".webm", ".mp4"): "a movie",
}
"""Endings of files that are no drawings, and what they are for."""


def check_drawing(path: Path) -> None:
    """Refuse a file whose ending says that it is something else.

    Raises:
        DqpaintError: it is a picture, a film, a table, settings, an arm or a law.
    """
    ending = path.suffix.lower()
    for endings, what in NO_DRAWINGS.items():
        if ending in endings:
            said = what.format(name=path.name)
            raise DqpaintError(f"'{path}' is {said}; a drawing is a text, such as star.traj")

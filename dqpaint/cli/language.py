"""Words of `fmt`, `explain`, `cite`, `new`, `trace`, `grammar`, `lsp` -> files, texts, codes."""

import json
import re
import sys
from collections.abc import Callable, Sequence
from typing import Annotated, Any

import typer

from dqpaint.cli.front import completion
from dqpaint.cli.front.colours import labels, show
from dqpaint.cli.front.help_pages import Page
from dqpaint.cli.front.streams import is_quiet, tell_result
from dqpaint.errors import DqpaintError, UsageError

MESSAGE = re.compile(r"[A-Za-z]\d+")  # the code of one

_COMMANDS: list[tuple[Callable[..., None], dict[str, Any]]] = []


def add_to(app: typer.Typer) -> None:
    """Add the commands to an application."""
    for function, options in _COMMANDS:
        app.command(cls=Page, **options)(function)


def tell(problem: DqpaintError) -> None:
    """Print an error on standard error."""
    text = str(problem)
    show(text if text.startswith(("error[", "warning[")) else f"error: {text}", sys.stderr)


def point_at(codes: Sequence[str], stream: Any) -> None:
    """Name, at a terminal, the command that explains the first error."""
    if codes and stream.isatty() and not is_quiet():
        print(f"\ndqpaint explain {codes[0]} explains the first", file=sys.stderr)


def _command(**options: Any) -> Callable[[Callable[..., None]], Callable[..., None]]:
    def add(function: Callable[..., None]) -> Callable[..., None]:
        _COMMANDS.append((function, options))
        return function

    return add


@_command(
    epilog="Examples:\n\n  dqpaint fmt star.traj\n\n  dqpaint fmt --check drawings/*.traj",
    rich_help_panel="Write",
)
def fmt(
    files: Annotated[list[str], typer.Argument(metavar="FILE...", help="drawings; - reads stdin")],
    check: Annotated[
        bool, typer.Option("--check", help="write nothing; name the files that would change")
    ] = False,
) -> None:
    """Put the spacing and indentation of drawings in the standard form."""
    from dqpaint.language.syntax import STDIN
    from dqpaint.language.writing import format_files

    failed = False
    for name in files:
        try:
            if name == STDIN:
                made, changed = format_files.format_input()
                if not check:
                    if sys.stdout.isatty():
                        print(made.decode(), end="")
                    else:
                        sys.stdout.buffer.write(made)
            else:
                changed = format_files.format_file(name, write=not check)
                if not check:
                    tell_result(f"{name}: {'formatted' if changed else 'unchanged'}")
        except DqpaintError as problem:
            tell(problem)
            failed = True
            continue
        if check and changed:
            print(name)
            failed = True
    if failed:
        raise typer.Exit(1)


@_command(
    epilog="Examples:\n\n  dqpaint explain hinf\n\n  dqpaint explain E245\n\n  dqpaint explain",
    rich_help_panel="Write",
)
def explain(
    name: Annotated[
        str | None,
        typer.Argument(
            metavar="NAME|CODE",
            help="law, plant, disturbance, metric or profile; or code of a message [default: all]",
            autocompletion=completion.explained,
        ),
    ] = None,
) -> None:
    """Explain a law by its equation, likewise a plant, disturbance, metric, profile or message."""
    from dqpaint.diagnostics import catalogue, closest, did_you_mean

    if name is not None and MESSAGE.fullmatch(name.strip()):
        show(catalogue.format_explanation(catalogue.explanation(name)))
        return
    from dqpaint.cli import explaining

    if name is None:
        show(f"{explaining.list_names()}\n\n{catalogue.list_explanations()}", painter=labels)
    elif found := explaining.explained(name.strip()):
        show("\n\n".join(map(explaining.format_explained, found)), painter=labels)
    else:
        near = did_you_mean(closest(name, explaining.names())) or "all: dqpaint explain"
        raise UsageError(
            f"no law, plant, disturbance, metric or profile named '{name[:40]}'; {near}"
        )


@_command(
    epilog="Examples:\n\n  dqpaint cite hinf\n\n  dqpaint cite star-hinf.json > star.bib",
    rich_help_panel="Write",
)
def cite(
    subject: Annotated[
        str,
        typer.Argument(
            metavar="RUN.json|LAW",
            help="the summary of a run, as draw writes it; or a law",
            autocompletion=completion.laws,
        ),
    ],
) -> None:
    """Print BibTeX of dqpaint and of the law, or of all that a run used: arm and engines, too."""
    from dqpaint.outputs import citation

    of = citation.of_run if subject.lower().endswith(".json") else citation.of_law
    show(of(subject))


@_command(
    epilog="Examples:\n\n  dqpaint new flower\n\n  dqpaint new drawings/flower.traj",
    rich_help_panel="Write",
)
def new(name: Annotated[str, typer.Argument(help="name or file of the drawing")]) -> None:
    """Write a commented drawing to begin with."""
    from dqpaint.language.writing import template

    path = template.start(name)
    print(path)
    if sys.stderr.isatty():
        print(f"now: dqpaint preview {path} --watch", file=sys.stderr)


@_command(
    epilog="Examples:\n\n  dqpaint trace portrait.jpg\n\n  dqpaint trace ada.jpg --out ada.traj",
    rich_help_panel="Write",
)
def trace(
    photo: Annotated[str, typer.Argument(help="a PNG, JPEG, TIFF or WebP file")],
    out: Annotated[
        str | None, typer.Option(metavar="FILE.traj", help="[default: beside the photo]")
    ] = None,
) -> None:
    """Write a drawing that paints a photograph, and a sheet with a preview of each style."""
    from dqpaint.cli.terminal import Progress, table
    from dqpaint.painting.photos import tracing

    with Progress(photo) as progress:
        made = tracing.trace(photo, out, progress)
    rows = [
        ("as " + style, f"likeness {ssim:.3f} on the sheet, {seconds:.0f} s")
        for style, (ssim, seconds) in made.styles.items()
    ]
    print(table([*rows, ("written", str(made.drawing)), ("", str(made.sheet))]))
    if sys.stderr.isatty():
        print(f"now: dqpaint preview {made.drawing}", file=sys.stderr)


@_command(
    epilog="Examples:\n\n  dqpaint grammar\n\n  dqpaint grammar textmate > traj.tmLanguage.json",
    rich_help_panel="Set up",
)
def grammar(
    kind: Annotated[str, typer.Argument(metavar="textmate", help="kind of grammar")] = "textmate",
) -> None:
    """Print the language's grammar for editors, made from its own tables."""
    from dqpaint.editors import textmate
    from dqpaint.errors import UnknownNameError

    if kind != "textmate":
        raise UnknownNameError("grammar", kind, ["textmate"])
    print(json.dumps(textmate.grammar(), indent=2, ensure_ascii=False))


@_command(
    epilog="Examples:\n\n  dqpaint lsp\n\n  dqpaint lsp --help",
    short_help="Serve an editor.",
    rich_help_panel="Set up",
)
def lsp() -> None:
    """Serve an editor: messages, meanings, completion and fixes, over stdin and stdout.

    An editor starts this by itself. It needs the extra: pip install 'dqpaint[lsp]'
    """
    try:
        from dqpaint.editors import server
    except ModuleNotFoundError as missing:
        if (missing.name or "").partition(".")[0] not in ("pygls", "lsprotocol"):
            raise
        raise DqpaintError("the language server needs: pip install 'dqpaint[lsp]'") from None
    server.serve()

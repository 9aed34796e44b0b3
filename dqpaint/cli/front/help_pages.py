"""A command and its options -> its help page: an example first, options under headings.

Nothing is cut: a sentence that does not fit is wrapped. Options of all commands (`-h`, `-q`, `-v`)
are read here, and an option's plural is taken for it.
"""

import inspect
import re
import shutil
import textwrap
from collections.abc import Callable, Iterable
from typing import Any

import typer
from typer.core import TyperCommand, TyperGroup

from dqpaint.cli.front import streams
from dqpaint.cli.front.colours import BOLD, CYAN, FAINT, paint, show
from dqpaint.errors import UsageError

WIDEST = 100
SHORT, LONG = 22, 32  # columns of names, on a narrow and on a wide page
HELP = ("-h", "--help")
ORDER = ("Draw", "Write", "Compare", "Arms", "Set up", "Arguments", "Options", "Control")
"""Headings that come first, of groups of commands and of options; others follow as they come."""
LAST = ("Files", "Limits", "Every command")
OF_ALL = (
    ("-h, --help", "this page"),
    ("-q, --quiet", "say only warnings and errors"),
    ("-v, --verbose", "also say what happens as it happens; -vv: in detail"),
)
DOCUMENTS = {
    "draw": "trajectories/README.md (the language), docs/limits.md",
    "preview": "trajectories/README.md (the language)",
    "check": "trajectories/README.md (the language)",
    "fmt": "trajectories/README.md (the language)",
    "new": "trajectories/README.md (the language)",
    "explain": "docs/equations.md",
    "list": "docs/equations.md",
    "export": "docs/limits.md, docs/record.md",
    "compare": "docs/statistics.md",
    "sweep": "docs/statistics.md",
    "cite": "docs/equations.md, CITATION.cff",
    "lsp": "docs/editors.md",
    "grammar": "docs/editors.md",
}
"""Where there is more about a command, beside the page of all: names within the sources."""
OF_COMMANDS = "docs/command-line.md"
TOGETHER = re.compile(r"\[default: \S{1,16}( \S{1,8})?\]")
HEADING = re.compile(r"[A-Z][\w ]*:$")
SPEC = re.compile(r"^  (\S.*?)(?=  |$)")
DEFAULT = re.compile(r"\[default: [^\]]*\]")

Row = tuple[str, str]


def width() -> int:
    """The columns of a page."""
    return max(40, min(WIDEST, shutil.get_terminal_size().columns))


def show_help(page: str, stream: Any = None) -> None:
    """Print a help page, in colour on a terminal."""
    show(page, stream, _coloured)


def _coloured(page: str) -> str:
    lines, named = [], False  # whether names of commands or options begin the lines
    for line in DEFAULT.sub(_faint, page).split("\n"):
        if HEADING.match(line):
            named = line != "Examples:"
            line = paint(line, BOLD)
        elif line.startswith("Usage: "):
            line = paint("Usage:", BOLD) + line[6:]
        elif named:
            line = SPEC.sub(lambda found: "  " + paint(found[1], CYAN), line)
        lines.append(line)
    return "\n".join(lines)


def _faint(found: re.Match[str]) -> str:
    return "\n".join(paint(line, FAINT) for line in found[0].split("\n"))


def laid_out(title: str, rows: Iterable[Row], column: int) -> str:
    """Names and meanings under a heading; a name that is too long stands above its meaning."""
    lines = [f"{title}:"]
    room = width() - column - 4
    for name, meaning in rows:
        kept = TOGETHER.sub(lambda found: found[0].replace(" ", "\0"), " ".join(meaning.split()))
        wrapped = textwrap.wrap(kept, room, break_on_hyphens=False) or [""]
        wrapped = [line.replace("\0", " ") for line in wrapped]
        if len(name) > column:
            lines += [f"  {name}"]
        else:
            lines += [f"  {name:<{column}}  {wrapped.pop(0)}".rstrip()]
        lines += [" " * (column + 4) + line for line in wrapped]
    return "\n".join(lines)


def in_order(sections: dict[str, list[Row]]) -> list[tuple[str, list[Row]]]:
    """Headings with their rows, the best known first."""

    def rank(title: str) -> int:
        if title in ORDER:
            return ORDER.index(title)
        return len(ORDER) + 1 + LAST.index(title) if title in LAST else len(ORDER)

    return sorted(sections.items(), key=lambda section: rank(section[0]))


def examples(epilog: str | None) -> list[str]:
    """The commands of an epilog, each on lines that can be copied."""
    found = []
    for line in inspect.cleandoc(epilog or "").split("\n"):
        if line.strip() and not line.endswith("xamples:") and not line.endswith("xample:"):
            parts = textwrap.wrap(
                line.strip(), width() - 6, break_long_words=False, break_on_hyphens=False
            )
            found.append("  " + " \\\n      ".join(parts))
    return found


def page(command: Any, ctx: Any, arguments: str, sections: dict[str, list[Row]]) -> str:
    """A help page: usage, what it does, examples, options, where there is more."""
    most = LONG if width() >= WIDEST else SHORT
    rows = [row for title, rows in sections.items() for row in rows if title != "Options"]
    of = {
        title: min(most, max(len(name) for name, _ in (own if title == "Options" else rows)))
        for title, own in sections.items()
    }
    about = inspect.cleandoc(command.help or "").split("\n\n")
    wrapped = [
        textwrap.fill(" ".join(text.split()), width(), initial_indent="  ", subsequent_indent="  ")
        for text in about
    ]
    path = "dqpaint" if ctx.parent is None else f"dqpaint {ctx.info_name}"
    parts = [f"Usage: {path} {arguments}", *wrapped]
    if shown := examples(command.epilog):
        parts.append("\n".join(["Examples:", *shown]))
    parts += [laid_out(title, rows, of[title]) for title, rows in in_order(sections)]
    more = ", ".join(filter(None, (DOCUMENTS.get(ctx.info_name or ""), OF_COMMANDS)))
    parts.append(textwrap.fill(f"More: {more}", width(), break_on_hyphens=False))
    return "\n\n".join(parts)


def _row(parameter: Any, ctx: Any) -> Row | None:
    """A parameter and its meaning; None for one that is hidden, or of every command."""
    record = parameter.get_help_record(ctx)
    if record is None or "--help" in parameter.opts:
        return None
    name, meaning = record
    meaning = meaning.replace("[required]", "").replace("; required]", "]")
    if parameter.param_type_name == "argument":
        return _metavar(parameter), meaning
    name = re.sub(r" <(\w+)>$", lambda found: f" {found[1].upper()}", name)
    return name, re.sub(r"(\[default: -?\d+)\.0\]", r"\1]", meaning)


def _metavar(parameter: Any) -> str:
    return str(parameter.metavar or parameter.name.upper()).strip("{}")


def _obey(ctx: Any, args: list[str], show_page: Callable[[], str]) -> list[str]:
    """The words without those that every command has."""
    if ctx.resilient_parsing:
        return args
    args = streams.take_words(args)
    own = args[: args.index("--")] if "--" in args else args
    if any(word in HELP for word in own):
        show_help(show_page())
        raise typer.Exit()
    return args


class Page(TyperCommand):
    """A command whose help has an example first and its options under headings."""

    def get_help(self, ctx: Any) -> str:
        """Its help page."""
        sections: dict[str, list[Row]] = {}
        usage = []
        for parameter in self.get_params(ctx):
            row = _row(parameter, ctx)
            if row is None:
                continue
            is_argument = parameter.param_type_name == "argument"
            own = "Arguments" if is_argument else "Options"
            sections.setdefault(getattr(parameter, "rich_help_panel", None) or own, []).append(row)
            if is_argument:
                optional = not parameter.required and not row[0].startswith("[")
                usage.append(f"[{row[0]}]" if optional else row[0])
        sections["Every command"] = list(OF_ALL)
        return page(self, ctx, " ".join([*usage, "[OPTIONS]"]), sections)

    def parse_args(self, ctx: Any, args: list[str]) -> list[str]:
        """Read the options; one is accepted for several, and several for one: --plant, --plants.

        Raises:
            UsageError: several are given where there can be one.
        """
        args = _obey(ctx, args, lambda: self.get_help(ctx))
        known = {name for one in self.get_params(ctx) for name in (*one.opts, *one.secondary_opts)}
        end = args.index("--") if "--" in args else len(args)
        meant = []
        for word, following in zip(args[:end], [*args[1:end], ""], strict=False):
            name, sign, value = word.partition("=")
            if name.startswith("--") and name not in known:
                if (one := name.removesuffix("s")) in known:
                    _check_alone(one, value if sign else following, self.name)
                name = next((n for n in (f"{name}s", one) if n in known), name)
            meant.append(name + sign + value)
        return super().parse_args(ctx, meant + args[end:])


def _check_alone(option: str, value: str, command: str | None) -> None:
    """Refuse several names, as in `a,b` but not in `a:key=1,other=2`, for an option of one."""
    if any("=" not in part for part in value.split(",")[1:]):
        raise UsageError(
            f"{command} takes one {option}, not '{value}'; "
            "dqpaint compare and dqpaint sweep take several"
        )


class MadeWhenCalled(TyperCommand):
    """A command with the options of `takes`: made when it is called, not when it is listed."""

    def make_context(
        self, info_name: str | None, args: list[str], parent: Any = None, **extra: Any
    ) -> Any:
        """The context of the whole command."""
        app = typer.Typer(add_completion=False, rich_markup_mode=None)
        made = self.callback.made()  # type: ignore[union-attr]
        epilog = self.epilog or getattr(made, "epilog", None)
        app.command(cls=Page, epilog=epilog)(made)
        return typer.main.get_command(app).make_context(info_name, args, parent, **extra)


class Pages(TyperGroup):
    """All commands: their list in groups, every sentence whole."""

    def get_help(self, ctx: Any) -> str:
        """The page of all commands."""
        sections: dict[str, list[Row]] = {}
        for name in self.list_commands(ctx):
            command: Any = self.get_command(ctx, name)
            if command is None or command.hidden:
                continue
            about = inspect.cleandoc(command.short_help or command.help or "").split("\n\n")[0]
            panel = getattr(command, "rich_help_panel", None) or "Others"
            sections.setdefault(panel, []).append((name, " ".join(about.split())))
        rows = [row for one in self.get_params(ctx) if (row := _row(one, ctx))]
        sections["Options"] = [*rows, *OF_ALL]
        return page(self, ctx, "COMMAND [OPTIONS]", sections)

    def parse_args(self, ctx: Any, args: list[str]) -> list[str]:
        """Read the words before the command."""
        if not args and not ctx.resilient_parsing:
            import sys

            show_help(self.get_help(ctx), sys.stderr)
            raise typer.Exit(2)
        first = next((i for i, word in enumerate(args) if not word.startswith("-")), len(args))
        return super().parse_args(
            ctx, _obey(ctx, args[:first], lambda: self.get_help(ctx)) + args[first:]
        )

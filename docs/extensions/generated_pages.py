"""Registries and the catalogue of messages -> pages in docs/generated: one a message, law, command.

They come from the same source as `dqpaint explain`, `dqpaint list` and `--help`, and are written
before Sphinx looks for pages; only what has changed is touched, so that a second build is quick.
"""

import json
import re
import shlex
from collections.abc import Iterator, Mapping
from itertools import chain
from pathlib import Path
from typing import Any

import typer.main

from extensions import made

PICTURED = ("law", "plant", "disturbance")  # kinds whose first command to try writes a picture


def write(folder: Path) -> None:
    """Write all pages, and remove what is no page any more."""
    texts = dict(chain(_messages(), _explained(), _commands(), _cheat_sheet()))
    for name, text in texts.items():
        path = folder / f"{name}.md"
        path.parent.mkdir(parents=True, exist_ok=True)
        if not path.exists() or path.read_text("utf-8") != text:
            path.write_text(text, "utf-8")
    for path in folder.rglob("*.md"):
        if path.relative_to(folder).with_suffix("").as_posix() not in texts:
            path.unlink()


def _fenced(kind: str, text: str, *options: str) -> str:
    return "\n".join([f"```{kind}", *options, *([""] if options else []), text.strip("\n"), "```"])


def _page(title: str, *parts: str) -> str:
    return "\n\n".join([f"# {title}", *(part for part in parts if part)]) + "\n"


def _toctree(names: list[str]) -> str:
    return _fenced("{toctree}", "\n".join(names), ":maxdepth: 1")


def _messages() -> Iterator[tuple[str, str]]:
    from dqpaint.diagnostics.catalogue import explanations

    names = []
    for code, one in explanations().items():
        names.append(f"messages/{code}")
        wrong = right = ""
        if one.wrong:
            files = [f":beside: {json.dumps(dict(one.files))}"] if one.files else []
            wrong = "**Wrong**\n\n" + _fenced("{traj}", one.wrong, ":wrong:", ":quiet:", *files)
            right = "**Right**\n\n" + _fenced("traj", one.right)
        yield names[-1], _page(f"{code}: {one.title}", one.says.strip(), wrong, right)
    about = (
        "What `dqpaint check`, `draw` and the editor may say of a drawing. E is an error, W a "
        "warning; `dqpaint explain CODE` has the same texts."
    )
    yield "messages", _page("Messages", about, _toctree(names))


def _explained() -> Iterator[tuple[str, str]]:
    from dqpaint.cli import explaining

    for kind in explaining.NEEDED:
        names = []
        for one in explaining.all_explained(kind):
            names.append(f"{kind}s/{one.name}")
            yield names[-1], _explanation(one)
        about = f"The pages of `dqpaint explain NAME`, for each {kind}."
        yield f"{kind}s", _page(f"Every {kind}", about, _toctree(names))


def _explanation(one: Any) -> str:
    from dqpaint.cli.listing import value_line
    from dqpaint.core.texts.mathematics import latex_block, unicode_prose

    sections = one.sections
    equations = latex_block(sections.equations) if sections.equations else ""
    about = [
        f"**{label.capitalize()}.** " + _capital(_plain(unicode_prose(text)))
        for label, text in sections.texts.items()
    ]
    about += [f"**Source.** {_plain(one.source)}"] if one.source else []
    rows = [value_line(value).partition("  ") for value in one.values]
    values = "\n".join(f"- `{name}` {_plain(what)}" for name, _, what in rows)
    heading = "Gains:" if one.kind == "law" else "Values:"
    shown = [_shown(line, one.kind in PICTURED) for line in sections.try_]
    return _page(
        one.name, _plain(sections.summary.rstrip(".")) + ".", equations, *about,
        f"{heading}\n\n{values}" if values else "", *shown,
    )  # fmt: skip


def _shown(line: str, pictured: bool) -> str:
    """A command to try: with its picture, if it writes one and that tells of this thing."""
    words = shlex.split(line)
    if not pictured or words[1] not in ("draw", "compare", "sweep"):
        return _fenced("console", f"$ {line}")
    return _fenced("{picture}", f"{line} --size 480x270")


def command_names() -> list[str]:
    """The commands that `dqpaint --help` lists."""
    from dqpaint.cli.studies import app

    found = typer.main.get_command(app).commands.items()  # type: ignore[attr-defined]
    return sorted(name for name, command in found if not command.hidden)


def _commands() -> Iterator[tuple[str, str]]:
    names = []
    for name in command_names():
        names.append(f"commands/{name}")
        yield names[-1], _command(name)
    about = "What `dqpaint COMMAND --help` says, as a page each."
    yield "commands", _page("Every command", about, _toctree(names))


def _command(name: str) -> str:
    """The help of a command as a page: its paragraphs, its examples, a section a group."""
    said, _ = made.answer(name, "--help")
    parts = []
    for paragraph in re.split(r"\n\n+", said.strip()):
        head, _, rest = paragraph.partition("\n")
        if head.startswith("Usage: "):
            parts.append(_fenced("text", head.removeprefix("Usage: ")))
        elif head == "Examples:":
            lines = "\n".join(f"$ {line.strip()}" for line in rest.splitlines())
            parts += ["## Examples", _fenced("console", lines)]
        elif re.fullmatch(r"[A-Z][\w ]*:", head):
            parts += [f"## {head[:-1]}", *_options(rest)]
        else:
            parts.append(_plain(" ".join(paragraph.split())))
    return _page(f"dqpaint {name}", *parts)


def _options(lines: str) -> Iterator[str]:
    """Lines of `  --name VALUE   what it is`, which go on indented -> one definition each."""
    rows: list[list[str]] = []
    for line in lines.splitlines():
        if line.startswith("  ") and not line.startswith("   "):
            rows.append(re.split(r"\s{2,}", line.strip(), maxsplit=1))
        elif rows:
            rows[-1].append(line.strip())
    for name, *about in rows:
        yield f"`{name}`\n: {_plain(' '.join(about)) or 'see above'}"


def _capital(text: str) -> str:
    return text[:1].upper() + text[1:]


def _plain(text: str) -> str:
    return re.sub(r"([*_<$\[\]`])", r"\\\1", text)


def _cheat_sheet() -> Iterator[tuple[str, str]]:
    from dqpaint.language.vocabulary.units import UNITS
    from dqpaint.language.vocabulary.words import FUNCTIONS, PARTS, PROFILES, STATEMENTS

    def rows(pairs: Mapping[str, str]) -> str:
        return "\n".join(f"- `{example}` {meaning}" for example, meaning in pairs.items())

    statements = {one.example: one.meaning for one in STATEMENTS.values()}
    parts = {one.example: one.meaning for word, one in PARTS.items() if word not in STATEMENTS}
    values = {
        " ".join(UNITS): "units", " ".join(PROFILES): "profiles",
        " ".join(FUNCTIONS.values()): "functions",
    }  # fmt: skip
    commands = {
        "dqpaint draw star --controller hinf": "run a law, paint its picture",
        "dqpaint check my.traj --robot iiwa": "errors, and what the arm will meet",
        "dqpaint preview my.traj": "the picture that is asked for",
        "dqpaint compare lag --controllers p,hinf": "laws side by side",
        "dqpaint explain hinf": "a law, plant, disturbance, figure, message",
        "dqpaint list": "all names",
    }
    tables = {"Commands": commands, "Statements": statements, "Parts": parts, "Values": values}
    body = "\n\n".join(f"## {title}\n\n{rows(pairs)}" for title, pairs in tables.items())
    text = f"# Cheat sheet\n\n::::{{container}} sheet\n{body}\n::::\n"
    yield "cheat-sheet", text

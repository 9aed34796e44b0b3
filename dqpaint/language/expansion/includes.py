"""Files with `include` -> one list of statements, before anything is evaluated.

The text of an included file is put behind those before it, its statements into the body of the
`include`. A file is read once, however often it is included. Only files beside or below the main
one can be named, so that a drawing from elsewhere reads nothing else.
"""

from collections.abc import Callable
from dataclasses import replace
from pathlib import Path, PurePosixPath

from dqpaint.diagnostics import DiagnosticCollector, Problem, Source, closest, did_you_mean, problem
from dqpaint.errors import DqpaintError
from dqpaint.language.imports.file_access import below, is_relative
from dqpaint.language.syntax.parser import parse_statements
from dqpaint.language.syntax.tree import Quoted, Statement

DEEPEST = 8  # files within each other
MOST_LETTERS = 2_000_000  # of all files together
MOST_LINES = 100_000

# Files of other kinds, and the statement that draws them.
_FOR_OTHERS = {
    **dict.fromkeys((".png", ".jpg", ".jpeg", ".tif", ".tiff", ".webp"), "photo"),
    **{".svg": "svg", ".csv": "path", ".txt": "path", ".dat": "path"},
}

Statements = tuple[Statement, ...]


class Loader:
    """Reads a drawing and the files it includes.

    Attributes:
        source: all that was read so far.
    """

    def __init__(
        self,
        text: str,
        path: Path | None,
        read: Callable[[Path], str],
        findings: DiagnosticCollector,
    ) -> None:
        self.source = Source(text)
        self._findings = findings
        self._read = read
        self._root = path.parent if path is not None else None
        self._chain = [path.resolve()] if path is not None else []  # files that are being read
        self._names = [path.name] if path is not None else []
        self._loaded: dict[Path, Statements] = {}

    def statements(self) -> Statements:
        """The statements of the main file, with those of included files in them."""
        return self._with_files(parse_statements(self.source, self._findings), self._root)

    def _with_files(self, statements: Statements, folder: Path | None) -> Statements:
        """Statements with the bodies of their includes filled in; the depth is limited."""
        if not any(s.body or s.word == "include" for s in statements):
            return statements
        return tuple(
            self._include(statement, folder)
            if statement.word == "include" and not statement.broken
            else replace(statement, body=self._with_files(statement.body, folder))
            if statement.body
            else statement
            for statement in statements
        )

    def _include(self, statement: Statement, folder: Path | None) -> Statement:
        try:
            return replace(statement, body=self._body(statement, folder))
        except Problem as mistake:
            self._findings.add(mistake.diagnostic)
            return replace(statement, broken=True)

    def _body(self, statement: Statement, folder: Path | None) -> Statements:
        node = statement.values[0]
        assert isinstance(node, Quoted)
        if folder is None:
            message = "a text that is no file can't include one"
            raise problem("E271", message, node.span, "", "save it beside the other file")
        path = self._allowed(node, folder)
        name = path.relative_to(self._root or folder).as_posix()
        resolved = path.resolve()
        if resolved in self._chain:
            first = self._chain.index(resolved)
            circle = " includes ".join([*self._names[first:], self._names[first]])
            help = "what both need belongs into a third file"
            raise problem("E273", f"this include goes in a circle: {circle}", node.span, "", help)
        if len(self._chain) > DEEPEST:
            message = f"more than {DEEPEST} files within each other"
            raise problem("E274", message, node.span, "", "include them from one file")
        if resolved not in self._loaded:
            self._load(node, path, name, resolved)
        return self._loaded[resolved]

    def _allowed(self, node: Quoted, folder: Path) -> Path:
        """The path of a readable file, in or below the main file's folder, links resolved."""
        assert self._root is not None
        if not is_relative(node.text):
            message = "a file to include is named from the folder of this one"
            help = f'for example: include "{PurePosixPath(node.text).name or "colours.traj"}"'
            raise problem("E271", message, node.span, "", help)
        path = below(self._root, folder, node.text)
        if path is None:
            message = "this file is outside of the main file's folder"
            help = "only files beside or below the main file can be included"
            raise problem("E271", message, node.span, "", help)
        return path

    def _load(self, node: Quoted, path: Path, name: str, resolved: Path) -> None:
        if statement := _FOR_OTHERS.get(path.suffix.lower()):
            message = f"only drawings in .traj are included, and this is a {path.suffix} file"
            help = f"write: {statement} {node.text!r}".replace("'", '"')
            raise problem("E272", message, node.span, "", help)
        try:
            text = self._read(path)
        except DqpaintError as fault:
            others = (other.name for other in path.parent.glob("*.traj") if other != path)
            meant = closest(path.name, others)
            raise problem("E272", str(fault), node.span, "", did_you_mean(meant)) from None
        if "\0" in text:
            raise problem(
                "E272", f"{name} is not a text: there is a zero character in it", node.span
            )
        begin = len(self.source) + 1
        if begin + len(text) > MOST_LETTERS:
            message = f"all files together are larger than {MOST_LETTERS // 1_000_000} MB"
            raise problem("E305", message, node.span)
        if self.source.count("\n") + text.count("\n") > MOST_LINES:
            message = f"all files together have more than {MOST_LINES:,} lines"
            raise problem("E306", message, node.span)
        shown = str(path)
        files = (*self.source.included, (begin, shown))
        self.source = Source(f"{self.source}\n{text}", files)
        self._chain.append(resolved)
        self._names.append(name)
        read = parse_statements(self.source, self._findings, begin)
        self._loaded[resolved] = self._with_files(read, path.parent)
        self._chain.pop()
        self._names.pop()

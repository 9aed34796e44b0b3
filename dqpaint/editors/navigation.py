"""An editor's questions about names, blocks, colours and calls -> answers of the protocol."""

from pathlib import Path
from typing import TYPE_CHECKING
from urllib.parse import unquote, urlparse

from lsprotocol import types as lsp
from pygls.exceptions import JsonRpcInvalidParams

from dqpaint.core import read_regular
from dqpaint.diagnostics import Span
from dqpaint.editors import swatches, symbols
from dqpaint.editors.document import Document
from dqpaint.editors.vocabulary import vocabulary
from dqpaint.language.syntax import lines, meaning

if TYPE_CHECKING:
    from dqpaint.editors.server import Server

LARGEST_FILE = 2_000_000  # bytes of an included file
LARGEST_HINTED = 200_000  # characters of a text whose times are planned at each change
_KINDS = {
    "let": lsp.SymbolKind.Variable,
    "function": lsp.SymbolKind.Function,
    "def": lsp.SymbolKind.Function,
    "frame": lsp.SymbolKind.Object,
    "counter": lsp.SymbolKind.Variable,
    "parameter": lsp.SymbolKind.Variable,
}


def add_to(server: "Server") -> None:
    """Let a server answer these questions."""
    _add_names(server)
    _add_places(server)


def _add_names(server: "Server") -> None:
    @server.feature(lsp.TEXT_DOCUMENT_DOCUMENT_SYMBOL)
    def outlined(params: lsp.DocumentSymbolParams) -> list[lsp.DocumentSymbol]:
        document = server.document(params.text_document.uri)
        return _symbols(document, symbols.outline(document.text).root)

    @server.feature(lsp.TEXT_DOCUMENT_DEFINITION)
    def defined(params: lsp.DefinitionParams) -> lsp.Location | None:
        return _definition(server, params.text_document.uri, params.position)

    @server.feature(lsp.TEXT_DOCUMENT_REFERENCES)
    def used(params: lsp.ReferenceParams) -> list[lsp.Location]:
        uri = params.text_document.uri
        document, found, name = _named(server, uri, params.position)
        spans = found.occurrences(name) if name else []
        if name and not params.context.include_declaration:
            spans = [span for span in spans if span != name.span]
        return [lsp.Location(uri, document.range(span)) for span in spans]

    @server.feature(lsp.TEXT_DOCUMENT_DOCUMENT_HIGHLIGHT)
    def marked(params: lsp.DocumentHighlightParams) -> list[lsp.DocumentHighlight]:
        document, found, name = _named(server, params.text_document.uri, params.position)
        spans = found.occurrences(name) if name else []
        return [lsp.DocumentHighlight(document.range(span)) for span in spans]

    @server.feature(lsp.TEXT_DOCUMENT_PREPARE_RENAME)
    def renamable(params: lsp.PrepareRenameParams) -> lsp.Range | None:
        document, found, name = _named(server, params.text_document.uri, params.position)
        offset = document.offset(params.position)
        spans = found.occurrences(name) if name else []
        return next((document.range(s) for s in spans if s.start <= offset <= s.end), None)

    @server.feature(lsp.TEXT_DOCUMENT_RENAME, lsp.RenameOptions(prepare_provider=True))
    def renamed(params: lsp.RenameParams) -> lsp.WorkspaceEdit | None:
        uri = params.text_document.uri
        document, found, name = _named(server, uri, params.position)
        if name is None:
            return None
        if fault := _not_a_name(params.new_name, found, name):
            raise JsonRpcInvalidParams(fault)
        edits = [
            lsp.TextEdit(document.range(span), params.new_name) for span in found.occurrences(name)
        ]
        return lsp.WorkspaceEdit(changes={uri: edits})


def _add_places(server: "Server") -> None:
    @server.feature(lsp.TEXT_DOCUMENT_FOLDING_RANGE)
    def folded(params: lsp.FoldingRangeParams) -> list[lsp.FoldingRange]:
        found = symbols.folds(server.document(params.text_document.uri).text)
        comment, region = lsp.FoldingRangeKind.Comment, lsp.FoldingRangeKind.Region
        return [
            lsp.FoldingRange(begin, end, kind=comment if is_comment else region)
            for begin, end, is_comment in found
        ]

    @server.feature(lsp.TEXT_DOCUMENT_DOCUMENT_COLOR)
    def coloured(params: lsp.DocumentColorParams) -> list[lsp.ColorInformation]:
        document = server.document(params.text_document.uri)
        return [
            lsp.ColorInformation(document.range(span), lsp.Color(*colour, 1.0))
            for span, colour in swatches.swatches(document.text)
        ]

    @server.feature(lsp.TEXT_DOCUMENT_COLOR_PRESENTATION)
    def picked(params: lsp.ColorPresentationParams) -> list[lsp.ColorPresentation]:
        colour = params.color
        written = swatches.written((colour.red, colour.green, colour.blue))
        return [
            lsp.ColorPresentation(text, lsp.TextEdit(params.range, text))
            for text in reversed(written)
        ]

    @server.feature(lsp.TEXT_DOCUMENT_INLAY_HINT)
    def timed(params: lsp.InlayHintParams) -> list[lsp.InlayHint]:
        uri = params.text_document.uri
        document = server.document(uri)
        if len(document.text) > LARGEST_HINTED:
            return []
        figures = server.analysis(uri, planned=True).figures
        first, last = params.range.start.line, params.range.end.line
        return [
            lsp.InlayHint(document.end_of_line(line - 1), f"{one.seconds:.3g} s", padding_left=True,
                          tooltip=str(one))
            for line, one in figures.items()
            if first <= line - 1 <= last and one.seconds > 0
        ]  # fmt: skip

    @server.feature(
        lsp.TEXT_DOCUMENT_SIGNATURE_HELP, lsp.SignatureHelpOptions(trigger_characters=["(", ","])
    )
    def called(params: lsp.SignatureHelpParams) -> lsp.SignatureHelp | None:
        document = server.document(params.text_document.uri)
        return _signature(document.text, document.offset(params.position))


def _named(
    server: "Server", uri: str, position: lsp.Position
) -> tuple[Document, symbols.Outline, symbols.Name | None]:
    document = server.document(uri)
    found = symbols.outline(document.text)
    return document, found, found.meant(document.offset(position))


def _symbols(document: Document, block: symbols.Block) -> list[lsp.DocumentSymbol]:
    """The names and blocks of a block, in their order; names within a block below it."""
    made = [
        lsp.DocumentSymbol(
            name.text, _KINDS[name.kind], document.range(name.whole), document.range(name.span)
        )
        for name in block.names
        if name.kind not in ("counter", "parameter", "def")
    ]
    defined = {name.whole.start: name for name in block.names if name.kind == "def"}
    for inner in block.blocks:
        name = defined.get(inner.span.start)
        kind = _KINDS["def"] if name else lsp.SymbolKind.Namespace
        head = inner.head.partition("\n")[0]
        at = name.span if name else Span(inner.span.start, inner.span.start + len(head))
        made.append(
            lsp.DocumentSymbol(
                name.text if name else head, kind, document.range(inner.span), document.range(at),
                children=_symbols(document, inner),
            )
        )  # fmt: skip
    return sorted(made, key=lambda one: (one.range.start.line, one.range.start.character))


def _definition(server: "Server", uri: str, position: lsp.Position) -> lsp.Location | None:
    document, found, name = _named(server, uri, position)
    if name is not None:
        return lsp.Location(uri, document.range(name.span))
    offset = document.offset(position)
    word = next((t.text for t, _ in found.uses if t.start <= offset <= t.end), None)
    parts = urlparse(uri)
    if parts.scheme != "file":
        return None
    file = Path(unquote(parts.path))
    if word is None:
        return _included(document, found, file, offset)
    return _elsewhere(server, word, file, found.files, {file})


def _included(
    document: Document, found: symbols.Outline, file: Path, offset: int
) -> lsp.Location | None:
    """The file of an `include` line, asked at its name in quotes."""
    begin = document.text.rfind("\n", 0, offset) + 1
    line = document.text[begin:].partition("\n")[0]
    for name in found.files if line.lstrip().startswith("include") else ():
        if f'"{name}"' in line and (file.parent / name).is_file():
            at = lsp.Range(lsp.Position(0, 0), lsp.Position(0, 0))
            return lsp.Location((file.parent / name).resolve().as_uri(), at)
    return None


def _elsewhere(
    server: "Server", word: str, file: Path, names: tuple[str, ...], seen: set[Path]
) -> lsp.Location | None:
    """Where one of the included files defines a name."""
    for name in names:
        other = (file.parent / name).resolve()
        if other in seen or not other.is_relative_to(file.parent.resolve()):
            continue
        seen.add(other)
        try:
            text = read_regular(other, LARGEST_FILE).decode("utf-8")
        except (OSError, ValueError):
            continue
        found = symbols.outline(text)
        for one in found.root.names:
            if one.text == word:
                return lsp.Location(other.as_uri(), server.document_of(text).range(one.span))
        if deeper := _elsewhere(server, word, other, found.files, seen):
            return deeper
    return None


def _not_a_name(word: str, found: symbols.Outline, name: symbols.Name) -> str:
    """Why a word cannot be the new name of something; empty if it can."""
    tokens = [token for line in lines(word) for token in line.tokens if token.kind != "end"]
    if [(one.kind, one.text) for one in tokens] != [("name", word)] or word == "°":
        return f"'{word[:40]}' is no name: letters, digits and _, a letter first"
    if taken := meaning(word):
        return f"'{word}' can't be used as a name: it is {taken}"
    if any(one.text == word and one != name for one in found.names):
        return f"'{word}' is a name of this drawing already"
    return ""


def _signature(text: str, offset: int) -> lsp.SignatureHelp | None:
    call = symbols.call_at(text, offset)
    if call is None:
        return None
    labels: list[tuple[str, str]] = [
        (label, entry.meaning)
        for entry in vocabulary()
        if entry.word == call.name and entry.kind == "function"
        for label in entry.example.split(" or ")
    ]
    labels += [
        (f"{name.text}({', '.join(name.parameters)})", "of this drawing")
        for name in symbols.outline(text).names
        if name.text == call.name and name.parameters
    ]
    if not labels:
        return None
    made = []
    for label, about in labels:
        words = label.partition("(")[2].rstrip(")").split(", ")
        parameters = [lsp.ParameterInformation(word) for word in words]
        made.append(lsp.SignatureInformation(label, about, parameters))
    fitting = [i for i, one in enumerate(made) if call.argument < len(one.parameters or ())]
    active = fitting[0] if fitting else len(made) - 1
    return lsp.SignatureHelp(made, active_signature=active, active_parameter=call.argument)

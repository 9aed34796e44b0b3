"""An editor's requests on standard input -> responses on standard output: the language server.

`document` converts places, `navigation` has the questions about names, blocks, colours and calls.
"""

import asyncio
import gc
import logging
import os
import sys
import time
from contextlib import redirect_stdout
from pathlib import Path
from typing import Any, BinaryIO, cast
from urllib.parse import unquote, urlparse

from lsprotocol import types as lsp
from pygls.exceptions import JsonRpcException, JsonRpcInvalidRequest
from pygls.lsp.server import LanguageServer
from pygls.protocol import LanguageServerProtocol, default_converter
from pygls.workspace import PositionCodec

from dqpaint import __version__
from dqpaint.diagnostics import Severity, Span, file_at, locate
from dqpaint.editors import completion, navigation
from dqpaint.editors.analysis import Analysis, analyse
from dqpaint.editors.document import Document
from dqpaint.editors.frames import Frames
from dqpaint.language import Diagnostic, ScriptError
from dqpaint.language.vocabulary import STATEMENTS
from dqpaint.language.writing import formatter

PAUSE = 0.1  # [s] without a key before a text is looked at
LONGEST_WAIT = 1.0  # [s] in which messages may be old while keys come without a pause
_SEVERITIES = {
    Severity.ERROR: lsp.DiagnosticSeverity.Error,
    Severity.WARNING: lsp.DiagnosticSeverity.Warning,
}
_KINDS = {
    "statement": lsp.CompletionItemKind.Keyword,
    "part": lsp.CompletionItemKind.Property,
    "word": lsp.CompletionItemKind.Keyword,
    "unit": lsp.CompletionItemKind.Unit,
    "function": lsp.CompletionItemKind.Function,
    "profile": lsp.CompletionItemKind.EnumMember,
    "constant": lsp.CompletionItemKind.Constant,
    "colour": lsp.CompletionItemKind.Color,
    "name": lsp.CompletionItemKind.Variable,
}


def _name(uri: str) -> str:
    """A document's path, which messages name and other files are found by."""
    parts = urlparse(uri)
    return unquote(parts.path) if parts.scheme == "file" else Path(uri).name


class _Protocol(LanguageServerProtocol):
    """The protocol; a request that cannot be understood gets an error for an answer."""

    def structure_message(self, data: dict[str, Any]) -> Any:
        """The message of an object; DqpaintError's like of the protocol."""
        try:
            return super().structure_message(data)
        except JsonRpcException as fault:
            if "method" in data:
                self._refuse(data, fault)
            raise

    def handle_message(self, message: Any) -> None:
        """Answer a message."""
        if hasattr(message, "jsonrpc"):
            super().handle_message(message)
        else:
            self._refuse(message, JsonRpcInvalidRequest())

    def _refuse(self, message: object, fault: JsonRpcException) -> None:
        known = message.get("id") if isinstance(message, dict) else None
        if isinstance(known, int | str):
            self._send_response(known, error=fault.to_response_error())


class Server(LanguageServer):
    """The server, with the analysis of each open text."""

    def __init__(self) -> None:
        super().__init__(
            "dqpaint", __version__, protocol_cls=_Protocol, converter_factory=default_converter
        )
        self._analyses: dict[str, Analysis] = {}
        self._waiting: dict[str, tuple[float, asyncio.TimerHandle]] = {}

    def document(self, uri: str) -> Document:
        """An open text."""
        return Document(self.workspace.get_text_document(uri).source, self._codec)

    def document_of(self, text: str) -> Document:
        """A text that is not open."""
        return Document(text, self._codec)

    @property
    def _codec(self) -> PositionCodec:
        return self.workspace.position_codec

    def analysis(self, uri: str, planned: bool) -> Analysis:
        """The analysis of a text, computed once."""
        text = self.document(uri).text
        known = self._analyses.get(uri)
        if known is None or known.text != text or (planned and not known.planned):
            known = analyse(text, _name(uri), planned)
            self._analyses[uri] = known
        return known

    def publish_soon(self, uri: str) -> None:
        """Send the messages about a text after a pause: versions that are old by then are skipped.

        Its times are not planned.
        """
        now = time.monotonic()
        since = self._unwait(uri) or now
        pause = min(PAUSE, max(0.0, since + LONGEST_WAIT - now))
        timer = asyncio.get_running_loop().call_later(pause, self.publish, uri, False)
        self._waiting[uri] = since, timer

    def _unwait(self, uri: str) -> float | None:
        """Forget what waits for a pause; since when it has."""
        since, timer = self._waiting.pop(uri, (None, None))
        if timer is not None:
            timer.cancel()
        return since

    def publish(self, uri: str, planned: bool) -> None:
        """Send the messages about a text."""
        self._unwait(uri)
        document = self.document(uri)
        understood = self.analysis(uri, planned)
        found = [_message(d, document, uri, understood.source) for d in understood.diagnostics]
        self.text_document_publish_diagnostics(lsp.PublishDiagnosticsParams(uri, found))

    def forget(self, uri: str) -> None:
        """A text that was closed has no messages any more."""
        self._unwait(uri)
        self._analyses.pop(uri, None)
        self.text_document_publish_diagnostics(lsp.PublishDiagnosticsParams(uri, []))


def _message(found: Diagnostic, document: Document, uri: str, source: str) -> lsp.Diagnostic:
    text = found.message + (f" ({found.label})" if found.label else "")
    if found.span is not None and found.span.start > len(document.text):
        at = locate(source, found.span.start)
        text = f"{file_at(source, found.span.start, '')[1]}:{at.line}:{at.column}: {text}"
    return lsp.Diagnostic(
        range=document.range(found.span),
        message=text + (f"\nhelp: {found.help}" if found.help else ""),
        severity=_SEVERITIES[found.severity],
        code=found.code,
        source="dqpaint",
        related_information=[
            lsp.DiagnosticRelatedInformation(lsp.Location(uri, document.range(span)), label)
            for span, label in found.related
            if span.start <= len(document.text)
        ],
    )


def make_server() -> Server:
    """The server with all it answers."""
    server = Server()
    navigation.add_to(server)

    @server.feature(lsp.TEXT_DOCUMENT_DID_OPEN)
    def opened(params: lsp.DidOpenTextDocumentParams) -> None:
        server.publish(params.text_document.uri, planned=True)

    @server.feature(lsp.TEXT_DOCUMENT_DID_CHANGE)
    def changed(params: lsp.DidChangeTextDocumentParams) -> None:
        server.publish_soon(params.text_document.uri)

    @server.feature(lsp.TEXT_DOCUMENT_DID_SAVE)
    def saved(params: lsp.DidSaveTextDocumentParams) -> None:
        server.publish(params.text_document.uri, planned=True)

    @server.feature(lsp.TEXT_DOCUMENT_DID_CLOSE)
    def closed(params: lsp.DidCloseTextDocumentParams) -> None:
        server.forget(params.text_document.uri)

    @server.feature(lsp.TEXT_DOCUMENT_HOVER)
    def hover(params: lsp.HoverParams) -> lsp.Hover | None:
        return _hover(server, params.text_document.uri, params.position)

    @server.feature(lsp.TEXT_DOCUMENT_COMPLETION)
    def complete(params: lsp.CompletionParams) -> list[lsp.CompletionItem]:
        document = server.document(params.text_document.uri)
        found = completion.completions(document.text, document.offset(params.position))
        return [
            lsp.CompletionItem(
                e.word, kind=_KINDS[e.kind], detail=e.meaning, documentation=e.example
            )
            for e in found
        ]

    @server.feature(
        lsp.TEXT_DOCUMENT_CODE_ACTION,
        lsp.CodeActionOptions(code_action_kinds=[lsp.CodeActionKind.QuickFix]),
    )
    def actions(params: lsp.CodeActionParams) -> list[lsp.CodeAction]:
        return _fixes(server, params.text_document.uri, params.range)

    @server.feature(lsp.TEXT_DOCUMENT_FORMATTING)
    def layout(params: lsp.DocumentFormattingParams) -> list[lsp.TextEdit]:
        document = server.document(params.text_document.uri)
        try:
            made = formatter.formatted(document.text)
        except ScriptError:  # its mistakes are shown already
            return []
        return [lsp.TextEdit(document.range(Span(0, len(document.text))), made)]

    return server


def _hover(server: Server, uri: str, position: lsp.Position) -> lsp.Hover | None:
    """The meaning of a word; for a line that moves the tool also its length and duration."""
    document = server.document(uri)
    found = completion.meaning_at(document.text, document.offset(position))
    if found is None:
        return None
    entry, span = found
    parts = [f"**{entry.word}**: {entry.meaning}", f"```traj\n{entry.example}\n```"]
    line = position.line + 1
    figures = server.analysis(uri, planned=True).figures.get(line)
    if figures is not None:
        parts.insert(0, str(figures))
    if entry.kind == "statement" and STATEMENTS[entry.word].parts:
        parts.append(completion.listed(STATEMENTS[entry.word].parts))
    content = lsp.MarkupContent(lsp.MarkupKind.Markdown, "\n\n".join(parts))
    return lsp.Hover(content, document.range(span))


def _fixes(server: Server, uri: str, asked: lsp.Range) -> list[lsp.CodeAction]:
    """The fixes of diagnostics within a range."""
    document = server.document(uri)
    start, end = document.offset(asked.start), document.offset(asked.end)
    found = []
    understood = server.analysis(uri, planned=False)
    for diagnostic in understood.diagnostics:
        fix, span = diagnostic.fix, diagnostic.span
        if fix is None or span is None or span.end < start or span.start > end:
            continue
        edit = lsp.TextEdit(document.range(fix.span), fix.text)
        found.append(
            lsp.CodeAction(
                fix.title,
                kind=lsp.CodeActionKind.QuickFix,
                diagnostics=[_message(diagnostic, document, uri, understood.source)],
                edit=lsp.WorkspaceEdit(changes={uri: [edit]}),
                is_preferred=True,
            )
        )
    return found


def serve() -> None:
    """Serve until the editor closes the connection.

    The server closes the pipes it is given, so it gets its own; what anything prints meanwhile goes
    to standard error and not between its answers.
    """
    gc.enable()  # a long life, unlike a command's
    logging.getLogger("pygls").setLevel(logging.CRITICAL)  # what an editor does wrong it is told
    server = make_server()
    with redirect_stdout(sys.stderr):
        source, answers = open(os.dup(0), "rb"), open(os.dup(1), "wb")  # noqa: SIM115
        server.start_io(cast(BinaryIO, Frames(source)), answers)

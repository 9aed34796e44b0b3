"""A text and the editor's way of counting -> offsets of positions, positions of offsets.

Offsets are code points in dqpaint and UTF-16 units (or the editor's choice) in the protocol.
"""

from lsprotocol import types as lsp
from pygls.workspace import PositionCodec

from dqpaint.diagnostics import Span, locate


class Document:
    """A text, with the editor's places in it."""

    def __init__(self, text: str, codec: PositionCodec) -> None:
        self.text = text.replace("\r\n", "\n").replace("\r", "\n")
        self._lines = self.text.split("\n")
        self._codec = codec

    def position(self, offset: int) -> lsp.Position:
        """Where an offset is."""
        line, column = locate(self.text, offset)
        before = self._lines[line - 1][: column - 1]
        return lsp.Position(line - 1, self._codec.client_num_units(before))

    def range(self, span: Span | None) -> lsp.Range:
        """Where a span is; the first line for the text as a whole, and for other files."""
        if span is None or span.start > len(self.text):
            span = Span(0, 0)
        return lsp.Range(self.position(span.start), self.position(span.end))

    def offset(self, position: lsp.Position) -> int:
        """The offset of a position."""
        line = min(position.line, len(self._lines) - 1)
        row, column, units = self._lines[line], 0, 0
        while column < len(row) and units < position.character:
            units += self._codec.client_num_units(row[column])
            column += 1
        return sum(len(earlier) + 1 for earlier in self._lines[:line]) + column

    def end_of_line(self, line: int) -> lsp.Position:
        """Where a line, from 0, ends."""
        return lsp.Position(line, self._codec.client_num_units(self._lines[line]))

"""Calls or values -> text of the language: formatter, drawing builder, first template."""

__all__ = ["builder", "format_files", "formatter", "template"]

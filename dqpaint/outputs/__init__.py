"""A painting -> files, written as a whole or not at all: pictures, tables, summaries, movies."""

__all__ = ["files"]

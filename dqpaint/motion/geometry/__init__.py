"""Strokes of a program -> places and orientations along them, with derivatives and lengths."""

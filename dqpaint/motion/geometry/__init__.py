"""Segments of a program -> positions and orientations along them, derivatives and lengths."""

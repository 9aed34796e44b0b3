"""Syntax tree -> strokes in order: repeats, definitions and includes expanded, names evaluated."""

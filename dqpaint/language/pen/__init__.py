"""Pen and stroke state between statements -> poses, times and orientations."""

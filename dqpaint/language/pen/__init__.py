"""The state between statements: pose of the pen, state of strokes -> times and orientations."""

"""The state between statements: pose of the pen, settings of strokes -> times and orientations."""

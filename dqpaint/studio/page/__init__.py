"""Elements of one open page: text, picture, arm, curves, choices, comparison and time."""

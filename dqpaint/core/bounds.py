"""Limits that several rooms share."""

DEFAULT_MAX_SAMPLES = 2_000_000  # samples of a drawing, unless the settings allow more
LARGEST_MAX_SAMPLES = 100_000_000  # the most that settings can allow
LARGEST_IMAGE = 50_000_000  # bytes of an image for a brush

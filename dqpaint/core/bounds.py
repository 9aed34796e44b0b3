"""Limits of `max_samples`, which settings and programs share."""

DEFAULT_MAX_SAMPLES = 2_000_000  # samples of a drawing, unless the settings allow more
LARGEST_MAX_SAMPLES = 100_000_000  # the most that settings can allow

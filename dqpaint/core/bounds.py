"""How many samples a drawing may have: a number that settings and programs share."""

DEFAULT_MAX_SAMPLES = 2_000_000  # of a drawing, if no more are allowed
LARGEST_MAX_SAMPLES = 100_000_000  # of one for which more are

"""How many samples a drawing may have: a number that settings and programs share."""

MOST_SAMPLES = 2_000_000  # of a drawing, if no more are allowed
MOST_ALLOWED = 100_000_000  # of one for which more are

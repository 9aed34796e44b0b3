"""Sizes at which each disturbance can be felt, and which of them are random."""

# a size each, a second one where random numbers take part, and where it is of size zero
SIZES = {
    "noise": {"rms": 1e-4},
    "latency": {"periods": 2},
    "payload": {"mass": 2.0},
    "gravity": {"error": 0.1},
    "links": {"part": 0.01},
    "base": {"x": 0.01, "wz": 0.02},
    "push": {"y": 30.0, "start": 0.2},
    "masses": {"error": 0.2},
    "offset": {"x": 0.01, "wy": 0.02},
    "twist": {"form": "noise", "x": 0.01},
}
RANDOM = {"noise", "links", "twist"}

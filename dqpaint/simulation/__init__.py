"""A motion, an arm, a law and a plant -> the recorded run: control loop, sensors, drives."""

from dqpaint.simulation.closed_loop import Track, track, track_many
from dqpaint.simulation.effects import has_effect
from dqpaint.simulation.learned_path import (
    body_errors, check_repeats, corrected, encode_learned, read_learned,
)
from dqpaint.simulation.recorded_run import RECORDED, Recording, read_recording, replay
from dqpaint.simulation.sensors import ModelsDifferError, law_model

__all__ = [
    "RECORDED", "ModelsDifferError", "Recording", "Track", "body_errors", "check_repeats",
    "corrected", "encode_learned", "has_effect", "law_model", "read_learned", "read_recording",
    "replay", "track", "track_many",
]

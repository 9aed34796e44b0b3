"""Parts of laws: poses -> errors, texts -> gains, a user's file -> a law."""

from dqpaint.controllers.base.pose_errors import (
    Point, difference_error, invariant_error, spatial_error,
)
from dqpaint.controllers.base.user_controller import make_controller

__all__ = ["Point", "difference_error", "invariant_error", "make_controller", "spatial_error"]

"""Views and camera settings -> cameras: points in space -> pixels, and their brightness."""

from dqpaint.light.camera.camera import NEAREST_DEPTH, Camera, View, frame_points
from dqpaint.light.camera.exposure_settings import equivalent_exposure, parse_exposure
from dqpaint.light.camera.views import Shot, distance_to, parse_views

__all__ = [
    "NEAREST_DEPTH", "Camera", "Shot", "View", "distance_to", "equivalent_exposure", "frame_points",
    "parse_exposure", "parse_views",
]

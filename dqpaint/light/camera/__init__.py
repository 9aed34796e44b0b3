"""Views and camera settings -> cameras: points in space -> pixels, and their brightness."""

from dqpaint.light.camera.camera import Camera, View, frame_points
from dqpaint.light.camera.exposure_settings import equivalent_exposure, parse_exposure
from dqpaint.light.camera.views import Shot, distance_to, parse_views

__all__ = [
    "Camera", "Shot", "View", "distance_to", "equivalent_exposure", "frame_points",
    "parse_exposure", "parse_views",
]

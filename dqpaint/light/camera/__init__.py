"""Views and camera settings -> a camera: points in space -> pixels, and how bright they are."""

from dqpaint.light.camera.camera import Camera, View, frame
from dqpaint.light.camera.exposure_settings import advice, parse_exposure
from dqpaint.light.camera.views import Shot, distance_to, parse_views

__all__ = [
    "Camera",
    "Shot",
    "View",
    "advice",
    "distance_to",
    "frame",
    "parse_exposure",
    "parse_views",
]

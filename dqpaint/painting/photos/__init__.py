"""A photograph -> the drawing that begins with it, and the light that paints it on a motion.

`photo_light` solves the light, `light_cache` keeps it, `tracing` writes the drawing.
"""

__all__ = ["light_cache", "photo_light", "tracing"]

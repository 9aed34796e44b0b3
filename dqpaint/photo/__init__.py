"""An image file -> the paths of a light that paints it, one style each, without their light.

What is wanted of the light is kept beside the paths (`program.Photo`); `light.inverse` solves it
once the motion is known. A new style is a module of `styles` with a function under
`@STYLES.add(name)`: a `Subject` in, curves out, in metres about the middle of the picture.
"""

import importlib
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from dqpaint.photo.reading import MOST_BYTES, PhotoError, read
    from dqpaint.photo.subject import STYLES, Subject, in_one_colour

STYLE_WORDS = ("hatch", "spiral")
"""The styles, in the order in which they are shown; the language knows them without their code."""

__all__ = ["MOST_BYTES", "STYLES", "STYLE_WORDS", "PhotoError", "Subject", "in_one_colour", "read"]

if not TYPE_CHECKING:

    def __getattr__(name: str) -> Any:
        """Import on first use: a drawing without a photograph needs nothing of it."""
        if name in ("MOST_BYTES", "PhotoError", "read"):
            return getattr(importlib.import_module("dqpaint.photo.reading"), name)
        if name == "STYLES":
            for style in STYLE_WORDS:
                importlib.import_module(f"dqpaint.photo.styles.{style}")
        if name in ("STYLES", "Subject", "in_one_colour"):
            return getattr(importlib.import_module("dqpaint.photo.subject"), name)
        raise AttributeError(f"module 'dqpaint.photo' has no attribute '{name}'")

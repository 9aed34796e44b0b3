"""The name of a brush and its values -> `Emitters`, the lamps on a tool, in the tool frame.

A new brush is a class in `kinds` under `@BRUSHES.add(name)`: fields with their descriptions and
`emitters`. From then on `--brush NAME:KEY=VALUE` and the statement `brush NAME KEY VALUE` take it.
"""

from dqpaint.brushes import kinds as _built_in  # noqa: F401  they register themselves
from dqpaint.brushes.brush import (
    BRUSHES, Brush, Direction, ImageFile, Length, Shades, first_value, takes,
)
from dqpaint.brushes.emitters import POINT, Emitters
from dqpaint.brushes.lamps import LAMPS, Lamp, read_lamp
from dqpaint.brushes.text import describe_fields, make_brush, read_brush

__all__ = [
    "BRUSHES", "LAMPS", "POINT", "Brush", "Direction", "Emitters", "ImageFile", "Lamp", "Length",
    "Shades", "describe_fields", "first_value", "make_brush", "read_brush", "read_lamp", "takes",
]

"""Finished pictures -> legends, contact sheets, differences and encoded files."""

from dqpaint.light.images import contact_sheet
from dqpaint.light.images.colour_maps import categorical_colours, sequential_colours, sequential_map
from dqpaint.light.images.contact_sheet import decode_png
from dqpaint.light.images.image_difference import (
    Difference, decode_picture, decode_planes, difference_picture, encode_planes,
    measure_difference,
)
from dqpaint.light.images.legend import LEGEND_EXPOSURE, Legend, with_legend, with_notes

__all__ = [
    "LEGEND_EXPOSURE", "Difference", "Legend", "categorical_colours", "contact_sheet",
    "decode_picture", "decode_planes", "decode_png", "difference_picture", "encode_planes",
    "measure_difference", "sequential_colours", "sequential_map", "with_legend",
    "with_notes",
]

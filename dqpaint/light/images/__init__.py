"""Finished pictures -> legends, contact sheets, differences, encoded files."""

from dqpaint.light.images import contact_sheet
from dqpaint.light.images.colour_maps import amounts, colour_amounts, colour_kinds
from dqpaint.light.images.contact_sheet import opened
from dqpaint.light.images.image_difference import (
    Difference,
    decode_picture,
    decode_planes,
    differ,
    encode_planes,
    where_they_differ,
)
from dqpaint.light.images.legend import RIDGE, Legend, with_legend

__all__ = [
    "RIDGE",
    "Difference",
    "Legend",
    "amounts",
    "colour_amounts",
    "colour_kinds",
    "contact_sheet",
    "decode_picture",
    "decode_planes",
    "differ",
    "encode_planes",
    "opened",
    "where_they_differ",
    "with_legend",
]

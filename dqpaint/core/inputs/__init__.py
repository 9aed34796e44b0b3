"""What others wrote -> bytes within limits that are checked first, text that is safe to show."""

from dqpaint.core.inputs.clean_stream import CleanStream, cleaned, printable, send_raw
from dqpaint.core.inputs.picture_size import PictureSize, picture_size
from dqpaint.core.inputs.regular_file import read_regular, stat_regular
from dqpaint.core.inputs.xml_tree import parse_xml

__all__ = [
    "CleanStream", "PictureSize", "cleaned", "parse_xml", "picture_size", "printable",
    "read_regular", "send_raw", "stat_regular",
]

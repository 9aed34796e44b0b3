"""What others wrote -> bytes within limits that are checked first."""

from dqpaint.core.inputs.picture_size import PictureSize, picture_size
from dqpaint.core.inputs.regular_file import read_regular, stat_regular
from dqpaint.core.inputs.xml_tree import parse_xml

__all__ = ["PictureSize", "parse_xml", "picture_size", "read_regular", "stat_regular"]

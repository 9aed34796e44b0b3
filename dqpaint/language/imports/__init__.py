"""Files named in a drawing (fonts, tables of points, SVG) -> piecewise curves and colours.

Files are read only from beside the drawing or below it (`file_access`). A new kind of file brings a
reader that returns piecewise curves, and a stroke in `strokes.imported_strokes`.
"""

from dqpaint.language.imports import lettering
from dqpaint.language.imports.dependencies import files_of

__all__ = ["files_of", "lettering"]

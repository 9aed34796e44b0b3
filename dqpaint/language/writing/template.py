"""File name -> a first drawing with comments."""

from pathlib import Path

from dqpaint.core import write_new
from dqpaint.errors import DqpaintError

_TEXT = """\
# {name}.traj - a flower; change a number, save, and look:  dqpaint preview {file} --watch
# x is to the right of the picture, y up, z towards the viewer; the origin is its middle.

period 8 ms  # a robot is told where to be this often
speed 120 mm/s  # slow is bright, fast is dark
let r = 75 mm  # a name for a value, which has a unit
let petals = 7

# A ring: move goes there in the dark, an arc turns about its centre.
move to (r, 0)
arc centre (0, 0) angle 360 deg light "#2050ff" 40%

# Petals: each pass of the loop turns what is inside, and has a colour of its own.
repeat i from 1 to petals
  with rotate i*360 deg/petals light hsv(i*360 deg/petals)
    move to (0.3*r, 0)
    arc via (0.7*r, 12 mm) to (r, 0)
    arc via (0.7*r, -12 mm) to (0.3*r, 0)
  end
end

# The middle: any formula of one name; the light goes from one colour to another on the way.
move to (0.25*r, 0)
curve polar(0.25*r*cos(3*a), a) for a from 0 to 180 deg light "#ff3000" to "#ffc000"
"""


def start(name: str) -> Path:
    """Write a drawing to begin with; a file that is there stays as it is.

    Args:
        name: of the drawing or its file, with or without .traj.

    Returns:
        The path of the file.

    Raises:
        DqpaintError: no such name, or it is taken.
        OutputError: it cannot be written.
    """
    path = Path(name if name.endswith(".traj") else f"{name}.traj")
    if path.name in ("", ".traj") or not path.stem.strip() or not name.isprintable():
        raise DqpaintError(f"'{name[:60]}' is no name for a file")
    if name.endswith("/") or not path.parent.is_dir():
        raise DqpaintError(f"folder '{path.parent}' does not exist")
    shown = f"'{path}'" if " " in str(path) else str(path)
    write_new(path, _TEXT.format(name=path.stem, file=shown).encode())
    return path

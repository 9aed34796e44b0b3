"""A photograph's file -> a drawing with comments that paints it, and a sheet of all styles."""

from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

from dqpaint.core import read_regular, write_new
from dqpaint.errors import DqpaintError
from dqpaint.language import parse
from dqpaint.light.images import contact_sheet
from dqpaint.painting.preview import make_preview
from dqpaint.photo import MOST_BYTES, STYLE_WORDS, PhotoError, read
from dqpaint.settings import make_settings

HEIGHT = 200  # [mm] of the longer side of the photograph
SHEET_ROWS = 480  # of each picture of the sheet
SHEET_LINES = 130  # strokes on the longer side there
ENDINGS = (".png", ".jpg", ".jpeg", ".tif", ".tiff", ".webp")
_TEXT = """\
# {name}.traj - a photograph painted with one lamp:  dqpaint preview {file} --size {size}
# How bright the lamp is along its path is solved for, so that the long exposure is the photo.

speed 100 mm/s  # a slower one shows finer things along the strokes: one step of light a period
photo "{photo}" {side} {length} mm as hatch

# Other styles: {styles}. More to say on that line:
#   detail 1 mm      how far apart the strokes are
#   angle 30 deg     their direction; cross: a second set across
#   colours 1        a lamp that is only dimmed, in the colour of: light orange
#   dark 5%          the tone below which it stays black
#   max 300 s        the time it may take, with fewer strokes if need be
"""


@dataclass(frozen=True)
class Traced:
    """The files that were written, and what each style promises.

    Attributes:
        drawing: the drawing.
        sheet: the picture of all styles.
        styles: the likeness of each (SSIM), and its time [s].
    """

    drawing: Path
    sheet: Path
    styles: dict[str, tuple[float, float]]


def trace(
    name: str, out: str | None = None, progress: Callable[[float], None] = lambda _done: None
) -> Traced:
    """Write a drawing beside a photograph, and a sheet with a preview of each style.

    Args:
        name: of the photograph's file.
        out: of the drawing; by default beside the photograph, with its name.
        progress: called with the share done, 0 to 1.

    Raises:
        DqpaintError: no photograph, or files of these names are there.
    """
    photo = Path(name)
    try:
        picture = read(read_regular(photo, MOST_BYTES))
    except OSError as fault:
        raise DqpaintError(f"can't read {name}: {(fault.strerror or '').lower()}") from None
    except PhotoError as fault:
        help = f"\n  = help: {fault.help}" if fault.help else ""
        raise DqpaintError(f"{name} {fault}{help}") from None
    high, wide = picture.shape[:2]
    side = "height" if high >= wide else "width"
    drawing = photo.with_suffix(".traj") if out is None else Path(out).with_suffix(".traj")
    if drawing.parent.resolve() != photo.parent.resolve():
        raise DqpaintError(f"a drawing reads files beside it: write it to {photo.parent}")
    size = _size(wide, high, 1080)
    text = _TEXT.format(
        name=drawing.stem, file=drawing, photo=photo.name, side=side, length=HEIGHT,
        size=f"{size[0]}x{size[1]}", styles=", ".join(STYLE_WORDS),
    )  # fmt: skip
    write_new(drawing, text.encode())
    pictures, captions, told = [], [], {}
    settings = make_settings(size=_size(wide, high, SHEET_ROWS))
    for number, style in enumerate(STYLE_WORDS):
        line = (
            f'photo "{photo.name}" {side} {HEIGHT} mm as {style} detail {HEIGHT / SHEET_LINES} mm'
        )

        def show(done: float, before: int = number) -> None:
            progress((before + done) / len(STYLE_WORDS))

        shown = make_preview(parse(line, str(drawing), drawing), settings, show)
        told[style] = (shown.photos[0].likeness.ssim, shown.motion.seconds)
        pictures.append(shown.image)
        captions.append(f"{style}: likeness {told[style][0]:.2f}, {told[style][1]:.0f} s")
    sheet = drawing.with_name(f"{drawing.stem}-styles.png")
    made = contact_sheet.sheet(pictures, captions)
    write_new(sheet, contact_sheet.encode_png(made))
    return Traced(drawing, sheet, told)


def _size(wide: int, high: int, rows: int) -> tuple[int, int]:
    """The size of a picture that a photograph fills as a sheet of paper does."""
    longest = max(wide, high)
    return round(rows * (0.28 + 0.72 * wide / longest)), round(
        rows * (0.28 + 0.72 * high / longest)
    )

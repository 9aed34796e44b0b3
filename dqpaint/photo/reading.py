"""The bytes of a PNG, JPEG, TIFF or WebP file -> a picture in sRGB, upright, of bounded size.

Turned as its camera held it (EXIF), laid over black where it is transparent, its colour profile
worked in. Sizes are looked at before anything is decoded.
"""

from __future__ import annotations

import io
import warnings
from typing import TYPE_CHECKING

import numpy as np

from dqpaint.core.arrays import Floats
from dqpaint.errors import DqpaintError

if TYPE_CHECKING:
    from PIL.Image import Image

MOST_BYTES = 100_000_000
MOST_PIXELS = 60_000_000
LARGEST_SIDE = 20_000
LEAST_SIDE = 16
KEPT_SIDE = 2048
"""Pixels of the longer side that are kept: more than a film of 1080 rows can show."""
FORMATS = ("PNG", "JPEG", "TIFF", "WEBP")
LEAST_CONTRAST = 0.02
"""Least difference between the brightest and the darkest tone, of sRGB from 0 to 1."""


class PhotoError(DqpaintError):
    """A file that is no photograph to paint; `help` says what would mend it."""

    def __init__(self, message: str, help: str = "") -> None:
        super().__init__(message)
        self.help = help


def read(data: bytes) -> Floats:
    """The picture (H, W, 3) in sRGB from 0 to 1, float32, its longer side at most `KEPT_SIDE`.

    Raises:
        PhotoError: no picture, a broken one, one of the wrong kind, or one too large to read.
    """
    from PIL import Image, UnidentifiedImageError

    with warnings.catch_warnings():
        warnings.simplefilter("ignore")  # of large pictures and odd tags: checked below
        try:
            with Image.open(io.BytesIO(data), formats=FORMATS) as image:
                _check(image)
                image.draft("RGB", (KEPT_SIDE, KEPT_SIDE))  # JPEG: decoded no larger than needed
                picture = _toned(_upright(image))
        except PhotoError:
            raise
        except Image.DecompressionBombError:
            raise _too_large("too many") from None
        except UnidentifiedImageError:
            raise PhotoError(_what(data), "a photo is a PNG, JPEG, TIFF or WebP file") from None
        except (OSError, SyntaxError, ValueError, EOFError, KeyError, IndexError) as fault:
            raise PhotoError(
                f"is a damaged picture: {str(fault)[:60]}", "save it again from its source"
            ) from None
    contrast = float(picture.max() - picture.min())
    if float(picture.max()) < LEAST_CONTRAST:
        raise PhotoError("is black all over: there is nothing to light up")
    if contrast < LEAST_CONTRAST:
        raise PhotoError("has one tone all over: there is nothing in it to paint")
    return picture


def _check(image: Image) -> None:
    width, height = image.size
    frames = getattr(image, "n_frames", 1)
    if frames > 1:
        help = "save the one that is meant as a PNG"
        raise PhotoError(f"holds {frames} pictures, and a photo is one", help)
    if image.mode in ("CMYK", "YCCK", "LAB"):
        inks = "inks (CMYK)" if image.mode != "LAB" else "Lab colours"
        raise PhotoError(f"is made of {inks}, not of light", "save it in RGB")
    if max(width, height) > LARGEST_SIDE or width * height > MOST_PIXELS:
        raise _too_large(f"{width:,} x {height:,}")
    if min(width, height) < LEAST_SIDE:
        raise PhotoError(
            f"has {width} x {height} pixels; a photo has at least {LEAST_SIDE} on each side"
        )


def _too_large(size: str) -> PhotoError:
    bounds = f"{LARGEST_SIDE:,} on a side and {MOST_PIXELS // 10**6} million in all"
    help = f"make it smaller; {KEPT_SIDE} pixels are as much as the film shows"
    return PhotoError(f"has {size} pixels; at most {bounds} are read", help)


def _upright(image: Image) -> Image:
    """The picture as 8-bit RGB or 16-bit grey, upright, smaller if it is large."""
    from PIL import ImageOps

    image.load()
    profile = image.info.get("icc_profile")
    image = ImageOps.exif_transpose(image)
    if image.mode.startswith("I") or image.mode == "F":
        return image
    if "A" in image.getbands() or "transparency" in image.info:
        image = _over_black(image.convert("RGBA"))
    rgb = image if image.mode in ("RGB", "L") else image.convert("RGB")
    return _in_srgb(rgb, profile) if profile else rgb.convert("RGB")


def _over_black(image: Image) -> Image:
    import PIL.Image

    ground = PIL.Image.new("RGBA", image.size, (0, 0, 0, 255))
    return PIL.Image.alpha_composite(ground, image).convert("RGB")


def _in_srgb(image: Image, profile: bytes) -> Image:
    """The picture with its colour profile worked in; as it is where the profile cannot be read."""
    from PIL import ImageCms

    try:
        own = ImageCms.ImageCmsProfile(io.BytesIO(profile))
        made = ImageCms.profileToProfile(
            image, own, ImageCms.createProfile("sRGB"), outputMode="RGB"
        )
    except (ImageCms.PyCMSError, OSError, ValueError):
        made = None
    return made if made is not None else image.convert("RGB")


def _toned(image: Image) -> Floats:
    """Numbers (H, W, 3) from 0 to 1, no larger than needed."""
    import PIL.Image

    scale = KEPT_SIDE / max(image.size)
    if scale < 1.0:
        size = (max(1, round(image.width * scale)), max(1, round(image.height * scale)))
        image = image.resize(size, PIL.Image.Resampling.BOX, reducing_gap=2.0)
    values = np.asarray(image).astype(np.float32)
    if values.ndim == 2:  # 16 or 32 bits of grey, or numbers of any size
        most = 65535.0 if image.mode.startswith("I") else max(float(values.max()), 1.0)
        if not np.isfinite(values).all():
            raise PhotoError("has tones that are not finite")
        values = np.repeat(np.clip(values / np.float32(most), 0.0, 1.0)[..., None], 3, axis=2)
        return np.ascontiguousarray(values)
    return np.ascontiguousarray(values / np.float32(255.0))


def _what(data: bytes) -> str:
    """What a file is that is no picture."""
    kinds = {
        **{b"%PDF": "a PDF", b"GIF8": "a GIF", b"BM": "a BMP", b"<svg": "an SVG drawing"},
        **{b"<?xm": "an XML text", b"PK\x03\x04": "a ZIP archive"},
        b"\x00\x00\x00": "a HEIC, AVIF or film file",
    }
    for start, kind in kinds.items():
        if data.startswith(start):
            return f"is {kind}, not a photo"
    return "is empty" if not data else "is no picture that can be read"

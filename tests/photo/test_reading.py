"""Files of photographs: what is read, upright and in sRGB, and what is refused, in a sentence."""

import io
from functools import cache
from unittest import mock

import numpy as np
import pytest
from PIL import Image, ImageCms

from dqpaint.photo import PhotoError, reading


def gradient(width=60, height=40, channels=3):
    y, x = np.mgrid[:height, :width]
    planes = [255.0 * x / width, 255.0 * y / height, 128.0 + 0.0 * x]
    return np.rint(np.stack(planes[:channels], axis=2)).astype(np.uint8)


def data_of(image, kind, **options):
    file = io.BytesIO()
    image.save(file, kind, **options)
    return file.getvalue()


@pytest.mark.parametrize("kind", ["PNG", "TIFF", "WEBP"])
def test_the_same_picture_in_each_kind(kind):
    options = {"lossless": True} if kind == "WEBP" else {}
    read = reading.read(data_of(Image.fromarray(gradient()), kind, **options))
    assert read.shape == (40, 60, 3)
    assert read == pytest.approx(gradient() / 255.0, abs=1e-6)


def test_a_jpeg_is_near():
    read = reading.read(data_of(Image.fromarray(gradient()), "JPEG", quality=95))
    assert np.abs(read - gradient() / 255.0).mean() < 0.01


def test_grey_and_sixteen_bits():
    grey = gradient()[..., 0]
    assert reading.read(data_of(Image.fromarray(grey), "PNG")) == pytest.approx(
        np.repeat(grey[..., None], 3, axis=2) / 255.0, abs=1e-6
    )
    deep = grey.astype(np.uint16) * 257 - 100 * (grey > 0).astype(np.uint16)
    for kind in ("PNG", "TIFF"):
        read = reading.read(data_of(Image.fromarray(deep), kind))
        assert read[..., 0] == pytest.approx(deep / 65535.0, abs=1e-6)


def test_alpha_is_laid_over_black():
    rgba = np.dstack([gradient(), np.full((40, 60), 51, np.uint8)])
    read = reading.read(data_of(Image.fromarray(rgba), "PNG"))
    assert read == pytest.approx(gradient() / 255.0 * 0.2, abs=0.005)


def test_it_is_turned_as_the_camera_held_it():
    exif = Image.Exif()
    exif[0x0112] = 6  # the camera was turned to the left
    data = data_of(Image.fromarray(gradient()), "PNG", exif=exif)
    assert reading.read(data) == pytest.approx(np.rot90(gradient(), -1) / 255.0, abs=1e-6)


def test_a_profile_is_worked_in():
    """Its own profile changes nothing; one that cannot be read, nothing either."""
    srgb = ImageCms.ImageCmsProfile(ImageCms.createProfile("sRGB")).tobytes()
    picture = Image.fromarray(gradient())
    assert reading.read(data_of(picture, "PNG", icc_profile=srgb)) == pytest.approx(
        gradient() / 255.0, abs=0.01
    )
    broken = data_of(picture, "PNG", icc_profile=b"no profile")
    assert reading.read(broken) == pytest.approx(gradient() / 255.0, abs=1e-6)
    lab = ImageCms.ImageCmsProfile(ImageCms.createProfile("XYZ")).tobytes()
    assert np.isfinite(reading.read(data_of(picture, "PNG", icc_profile=lab))).all()


def test_a_large_one_is_made_smaller():
    wide = Image.fromarray(np.tile(gradient(64, 32), (40, 100, 1)))
    assert reading.read(data_of(wide, "JPEG")).shape == (410, 2048, 3)


@cache
def wrong_files():
    picture = Image.fromarray(gradient())
    png = data_of(picture, "PNG")
    jpeg = data_of(Image.fromarray(np.tile(gradient(), (5, 5, 1))), "JPEG")
    frames = [Image.fromarray(np.roll(gradient(), n, axis=1)) for n in range(3)]
    webp = data_of(frames[0], "WEBP", save_all=True, append_images=frames[1:])
    tiff = data_of(frames[0], "TIFF", save_all=True, append_images=frames[1:])
    return {
        "empty": (b"", "empty"),
        "text": (b"hello", "no picture"),
        "pdf": (b"%PDF-1.7\n", "PDF"),
        "gif": (data_of(picture, "GIF"), "GIF"),
        "svg": (b"<svg xmlns='http://www.w3.org/2000/svg'/>", "SVG"),
        "heic": (b"\0\0\0\x1cftypheic", "HEIC"),
        "cut": (png[: len(png) // 2], "damaged"),
        "cut jpeg": (jpeg[: len(jpeg) // 2], "damaged"),
        "header alone": (png[:20], "damaged|no picture"),
        "inks": (data_of(picture.convert("CMYK"), "JPEG"), "CMYK"),
        "animated": (webp, "3 pictures"),
        "pages": (tiff, "3 pictures"),
        "one pixel": (data_of(Image.fromarray(gradient(1, 1)), "PNG"), "1 x 1"),
        "black": (data_of(Image.fromarray(0 * gradient()), "PNG"), "black"),
        "white": (data_of(Image.fromarray(0 * gradient() + 255), "PNG"), "one tone"),
        "wide": (data_of(Image.new("L", (30_000, 20), 9), "PNG"), "30,000"),
        "bomb": (data_of(Image.new("1", (19_000, 19_000)), "PNG"), "too many"),
    }


@pytest.mark.parametrize("name", wrong_files())
def test_what_is_refused(name):
    data, says = wrong_files()[name]
    with pytest.raises(PhotoError, match=says) as fault:
        reading.read(data)
    assert "\n" not in str(fault.value)


def test_a_picture_beyond_the_reader_s_own_bounds():
    """Pillow itself refuses pictures of more than twice its bound before it says their size."""
    data = data_of(Image.new("1", (3000, 3000)), "PNG")
    with mock.patch.object(Image, "MAX_IMAGE_PIXELS", 1000), pytest.raises(PhotoError):
        reading.read(data)


def test_a_tiff_of_numbers():
    deep = np.linspace(0.0, 7.5, 2400, dtype=np.float32).reshape(40, 60)
    read = reading.read(data_of(Image.fromarray(deep), "TIFF"))
    assert read[..., 1] == pytest.approx(deep / 7.5, abs=1e-6)
    deep[3, 4] = np.nan
    with pytest.raises(PhotoError, match="not finite"):
        reading.read(data_of(Image.fromarray(deep), "TIFF"))

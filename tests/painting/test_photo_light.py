"""Drawings with photographs -> light that paints them, the same from each side."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from PIL import Image

from dqpaint.errors import DqpaintError
from dqpaint.language import parse
from dqpaint.light.inverse import likeness, seen_through
from dqpaint.light.inverse.exposing import Box
from dqpaint.painting.photos.photo_light import solve_photos
from dqpaint.painting.preview import make_preview
from dqpaint.settings import make_settings

SMALL = make_settings(size=(320, 240))


def picture(width=64, height=48):
    y, x = np.mgrid[:height, :width]
    red = 0.5 + 0.45 * np.sin(x / 7.0)
    return np.stack([red, 0.5 + 0.45 * np.cos(y / 6.0), (x + y) / (width + height)], axis=2)


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    Image.fromarray(np.rint(255 * picture()).astype(np.uint8)).save(tmp_path / "p.png")
    return tmp_path


def drawn(folder, text):
    return parse(text, "a.traj", folder / "a.traj")


@pytest.mark.parametrize(
    "style",
    [
        "hatch",
        pytest.param("hatch cross angle 30 deg", marks=pytest.mark.slow),
        pytest.param("spiral", marks=pytest.mark.slow),
    ],
)
def test_the_preview_is_the_photograph(folder, style):
    program = drawn(folder, f'photo "p.png" height 60 mm as {style} detail 0.8 mm')
    shown = make_preview(program, SMALL)
    (photo,) = shown.photos
    camera = shown.picture.camera
    corners = camera.project(shown.motion.photo_corners[0])[0]
    box = Box(*np.ceil(corners[3]).astype(int), *(corners[1] - corners[3]).astype(int))
    seen = shown.image[box.top : box.top + box.height, box.left : box.left + box.width] / 255.0
    wanted = seen_through(picture().astype(np.float32), corners, box)
    got = likeness(seen, wanted)
    assert got.ssim > 0.85
    assert got.rms < 0.08
    assert photo.likeness.rms < 0.085
    assert 0.0 < photo.least < photo.largest <= 1.0
    assert shown.motion.light.min() >= 0.0
    assert shown.motion.light.max() <= 1.0


def test_light_stays_where_strokes_are(folder):
    text = 'photo "p.png" height 60 mm as hatch detail 3 mm\nmove to (0, 90) mm\nline by (9, 0) mm'
    motion = make_preview(drawn(folder, text), SMALL).motion
    lights = [segment.light for segment in motion.program.segments]
    own = np.array([light is not None and light.photo == 1 for light in lights])[motion.stroke]
    dark = np.array([light is None for light in lights])[motion.stroke]
    assert not motion.light[dark].any()
    ruled = motion.light[~own & ~dark]
    assert (ruled[:-1] == 1.0).all()
    points = motion.points[own & motion.lit]
    low, high = motion.photo_corners[0].min(axis=0), motion.photo_corners[0].max(axis=0)
    assert (points > low - 4e-3).all()
    assert (points < high + 4e-3).all()


def test_a_lamp_of_one_colour(folder):
    text = 'photo "p.png" height 60 mm as hatch detail 3 mm colours 1 light hsv(40 deg)'
    motion = make_preview(drawn(folder, text), SMALL).motion
    lit = motion.light[motion.lit]
    shade = lit / lit.max(axis=1, keepdims=True)
    assert np.ptp(shade, axis=0) == pytest.approx(0.0, abs=1e-6)
    assert shade[0, 0] == 1.0
    assert shade[0, 2] < 0.01


@pytest.mark.slow
def test_the_exposure_is_the_drawing_s(folder):
    """It does not depend on the picture's size, and two photographs share one."""
    one = 'photo "p.png" height 60 mm as hatch detail 3 mm'
    two = f'{one}\nphoto "p.png" height 60 mm at (90, 0) mm as hatch detail 1.5 mm'
    small, large = (make_preview(drawn(folder, one), make_settings(size=s)) for s in
                    ((320, 240), (400, 300)))  # fmt: skip
    assert small.motion.exposure == pytest.approx(large.motion.exposure, rel=0.01)
    both = make_preview(drawn(folder, two), SMALL)
    assert both.motion.exposure >= 0.9 * small.motion.exposure
    assert len(both.photos) == 2
    assert min(photo.likeness.ssim for photo in both.photos) > 0.6


def test_the_whole_photo_is_framed(folder):
    """Also where it is black, so that what is solved for does not move its own camera."""
    dark = picture()
    dark[:, :32] = 0.0
    Image.fromarray(np.rint(255 * dark).astype(np.uint8)).save(folder / "p.png")
    shown = make_preview(drawn(folder, 'photo "p.png" height 60 mm as hatch detail 2 mm'), SMALL)
    pixels = shown.picture.camera.project(shown.motion.photo_corners[0])[0]
    assert pixels.mean(axis=0) == pytest.approx([159.5, 119.5], abs=1e-6)


def test_a_brush_that_is_no_point_is_refused(folder):
    program = drawn(folder, 'photo "p.png" height 60 mm as hatch detail 3 mm')
    with pytest.raises(DqpaintError, match="bar"):
        make_preview(program, make_settings(size=(320, 240), brush="bar"))
    program = drawn(folder, 'brush bar 60 mm\nphoto "p.png" height 60 mm as hatch detail 3 mm')
    with pytest.raises(DqpaintError, match="bar"):
        make_preview(program, SMALL)


def test_without_photographs_nothing_is_done(folder):
    motion = make_preview(drawn(folder, "line by (50, 0) mm"), SMALL).motion
    assert solve_photos(motion, SMALL) == (motion, ())
    assert replace(motion).exposure is None

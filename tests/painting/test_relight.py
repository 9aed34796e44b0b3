"""Light of photographs: kept beside the drawing, solved again after a run, begun by `trace`."""

from pathlib import Path

import numpy as np
import pytest
from PIL import Image

from dqpaint import api
from dqpaint.core import find_drawing
from dqpaint.errors import DqpaintError, OutputError
from dqpaint.painting.photos import light_cache
from dqpaint.painting.photos.tracing import trace

TEXT = 'speed 200 mm/s\nphoto "p.png" height 30 mm as hatch detail 0.8 mm\n'


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    y, x = np.mgrid[:48, :64]
    red = 0.5 + 0.45 * np.sin(x / 7.0)
    made = np.stack([red, 0.5 + 0.45 * np.cos(y / 6.0), (x + y) / 112.0], axis=2)
    Image.fromarray(np.rint(255 * made).astype(np.uint8)).save(tmp_path / "p.png")
    (tmp_path / "p.traj").write_text(TEXT)
    return tmp_path


def test_light_is_kept_beside_the_drawing(folder):
    first = api.preview(folder / "p.traj", size=(240, 180))
    again = api.preview(folder / "p.traj", size=(240, 180))
    assert first.photos[0].steps > 0
    assert again.photos[0].steps == 0
    assert np.array_equal(first.image, again.image)
    kept = list((folder / light_cache.FOLDER).glob("*.npy"))
    assert len(kept) == 1
    kept[0].write_bytes(kept[0].read_bytes()[:-9])  # a broken one is solved for again
    third = api.preview(folder / "p.traj", size=(240, 180))
    assert third.photos[0].steps > 0
    assert np.array_equal(first.image, third.image)


def test_a_lamp_of_few_powers_is_told(folder):
    shown = api.preview(folder / "p.traj", size=(240, 180), lamp="dimmed:bits=2")
    (told,) = shown.photos
    assert told.likeness.ssim < told.ideal.ssim
    powers = np.unique(shown.motion.light.round(6))
    assert set(powers) <= set(((np.arange(4) / 3.0) ** 2.2).round(6))


@pytest.mark.slow
def test_light_that_is_solved_again_is_nearer(folder):
    """An arm that lags paints beside the place; the light of the place it reached is better."""
    options = {"size": (240, 180), "controller": "p", "plant": "ideal", "gains": {"k": 20.0}}
    before = api.draw(folder / "p.traj", **options)
    after = api.draw(folder / "p.traj", relight=True, **options)
    assert before.reached == after.reached
    assert not before.relit
    (reached,), (relit,) = after.reached, after.relit
    assert reached.ssim < before.photos[0].likeness.ssim
    assert relit.likeness.ssim > reached.ssim + 0.1
    assert after.motion.exposure == before.motion.exposure


def test_a_photograph_is_no_drawing(folder):
    with pytest.raises(DqpaintError, match="dqpaint trace"):
        find_drawing(str(folder / "p.png"))


@pytest.mark.slow
def test_a_drawing_and_a_sheet_are_begun(folder):
    (folder / "new.png").write_bytes((folder / "p.png").read_bytes())
    made = trace(str(folder / "new.png"))
    assert made.drawing.read_text().count("photo ") >= 1
    assert set(made.styles) == {"hatch", "spiral"}
    with Image.open(made.sheet) as sheet:
        assert sheet.width > 400
    with pytest.raises(OutputError):
        trace(str(folder / "new.png"))
    with pytest.raises(DqpaintError, match="picture"):
        trace(str(folder / "p.traj"))

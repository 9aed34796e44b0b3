"""What cells drew, beside each other: who stands with whom, on which axes, in which colours."""

import numpy as np
import pytest

from dqpaint.light.images import contact_sheet
from dqpaint.settings.model import make_settings
from dqpaint.studies.experiment.cells import Cell, split_label
from dqpaint.studies.replay.papers import read_paper
from dqpaint.studies.report import pictures
from dqpaint.studies.runner.run import Result
from dqpaint.studies.runner.run_arrays import arrays_path

T = np.arange(0, 1, 0.1)
HEIGHT, WIDTH = 90, 160


def drawn(*labels, scale=1e-3):
    error = scale * (1 + T)
    series = {"t_s": T, "orientation_error_rad": 0.01 * T}
    return {
        label: {**series, "position_error_m": error * (i + 1)} for i, label in enumerate(labels)
    }


def study(tmp_path, labels, lit=lambda i: (40 + i, 60)):
    """Cells with what is kept of them: one lit spot each; the first run of one failed."""
    cells = []
    for i, label in enumerate(labels):
        light = np.zeros((HEIGHT, WIDTH, 3), dtype=np.float32)
        y, x = lit(i)
        light[y : y + 4, x : x + 30] = 0.5
        path = arrays_path(tmp_path, str(i))
        path.parent.mkdir(exist_ok=True)
        np.savez(path, light=light, exposure=np.array(2.0), t_s=T,
                 position_error_m=1e-3 * (1 + i + T), orientation_error_rad=0.1 * T)  # fmt: skip
        cells.append(Cell({"cell": label}, (Result(str(i), "done", "", {"error_integral": 1.0}),)))
    return cells


@pytest.mark.parametrize(
    ("label", "parts"),
    [("HIR, 20 %", ("HIR", "20 %")), ("V-REP: LQR, q 1", ("V-REP", "LQR, q 1")), ("K", ("K", "")),
     ("lqr(q=1,1,4,r=2), stiff", ("lqr(q=1,1,4,r=2)", "stiff")), ("", ("", "")),
     ("two\nlines, x", ("two\nlines", "x"))],
)  # fmt: skip
def test_a_name_s_first_part_is_its_family(label, parts):
    assert split_label(label) == parts


def test_studies_find_the_arrays_that_earlier_versions_kept(tmp_path):
    assert arrays_path(tmp_path, "0123456789" * 4) == tmp_path / "kept/012345678901234567890123.npz"


def test_a_few_stand_together():
    (group,) = pictures.groups(drawn("a, 1", "b, 1", "a, 2"))
    assert list(group.members) == ["a, 1", "b, 1", "a, 2"]
    assert list(group.colours.values()) == contact_sheet.hues(3)


def test_the_cells_of_the_spiral_stand_by_their_laws():
    names = [cell.name for cell in read_paper("thesis-spiral").cells]
    made = drawn(*names)
    split = pictures.groups(made)
    assert [group.title for group in split] == [
        "K",
        "K+FF",
        "LQR in R8",
        "LQR in DQ",
        "HIR",
        "HIRT",
    ]
    for group in split:
        assert list(group.members) == ["ln2^2", "ln2", "best"]
        for name, arrays in group.members.items():
            assert arrays is made[f"{group.title}, {name}"]
    assert pictures.columns(names) == 6  # a law below itself
    by_set = [f"{law}, {n}" for law in ("HIR", "HIRT") for n in "12345"]
    assert pictures.columns(by_set) == 5  # a law a line
    assert pictures.columns(["a", "b", "c"]) == 3
    assert pictures.columns(["a, 1", "a, 2", "b, 1"]) is None


def test_many_without_families_stand_alone():
    split = pictures.groups(drawn(*"abcdefgh"))
    assert [(group.title, list(group.members)) for group in split] == [
        (x, [""]) for x in "abcdefgh"
    ]
    panels = pictures.errors(drawn(*"abcdefgh")).panels
    assert [line.label for line in panels[0].lines] == ["a"]
    assert not panels[0].needs_legend


def test_small_charts_have_one_scale_and_hold_every_error():
    many = drawn(*(f"{law}, {n}" for n in "12" for law in "abcd"))
    made = pictures.errors(many)
    assert made.shared
    assert [panel.title for panel in made.panels[:2]] == ["a: position error", "b: position error"]
    assert len(made.panels) == 8
    for panels, unit in ((made.panels[:4], "mm"), (made.panels[4:], "deg")):
        assert len({panel.span for panel in panels}) == 1
        low, high = panels[0].span
        every = np.concatenate([line.y for panel in panels for line in panel.lines])
        assert low <= every[every > 0].min() * 1.01
        assert high > every.max()
        assert panels[0].y_label.endswith(f"[{unit}]")
    first = made.panels[0].lines[0]
    np.testing.assert_allclose(first.y, 1e3 * many["a, 1"]["position_error_m"])
    np.testing.assert_allclose(made.panels[4].lines[0].y, np.degrees(0.01 * T))
    colours = {line.label: line.colour for panel in made.panels for line in panel.lines}
    assert all(colours[line.label] == line.colour for p in made.panels for line in p.lines)


def test_what_is_far_apart_is_on_a_logarithmic_axis():
    near, far = drawn("a", "b"), drawn("a", scale=1e-5) | drawn("b", scale=1e-3)
    assert pictures.errors(near).panels[0].log_y is False  # no bool of numpy, which JSON has not
    assert pictures.errors(far).panels[0].log_y is True


def test_overlays_of_many_are_apart_and_named_below(tmp_path):
    labels = [f"{law}, {n}" for n in "12" for law in ("p", "q", "r", "s")]
    settings = make_settings(width=WIDTH, height=HEIGHT)
    cells = study(tmp_path, labels)
    made = pictures.pictures(cells, tmp_path, settings)
    assert list(made) == ["-sheet", "-overlay", "-errors"]
    sheet, overlay = (contact_sheet.decode_png(made[end].picture) for end in ("-sheet", "-overlay"))
    assert sheet.shape[1] < 4 * WIDTH  # four beside each other, cut to what is lit
    assert overlay.shape[1] == sheet.shape[1]  # so that they stand below each other
    # eight spots of white; four pairs that differ, each of two hues
    first, second = (np.array(hue) for hue in contact_sheet.hues(2))
    for hue in (first, second):
        strong, weak = int(np.argmax(hue)), int(np.argmin(hue))
        differ = overlay[..., strong].astype(int) - overlay[..., weak]
        assert (differ > 60).any()
    below = {}
    for name, hue in zip("12", (first, second), strict=True):
        strong, weak = int(np.argmax(hue)), int(np.argmin(hue))
        differ = (
            overlay[: len(overlay) // 2, :, strong].astype(int)
            - overlay[: len(overlay) // 2, :, weak]
        )
        below[name] = np.argwhere(differ > 100)[:, 0].mean()
    assert below["1"] < below["2"]  # as they lie, each in the colour that the key names
    lone = pictures.pictures(cells[:1], tmp_path, settings)
    assert contact_sheet.decode_png(lone["-overlay"].picture).shape == (HEIGHT, WIDTH, 3)
    failed = [Cell({"cell": "x"}, (Result("x", "failed", "too far"),))]
    assert pictures.pictures(failed, tmp_path, settings) == {}
    mixed = pictures.pictures([*cells, *failed], tmp_path, settings)
    assert contact_sheet.decode_png(mixed["-sheet"].picture).shape[0] > sheet.shape[0]

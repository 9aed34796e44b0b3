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


def test_lines_of_no_result_are_named_so():
    """In the legend of one chart, and in the titles of several that share one."""
    few = pictures.errors(drawn("a", "b"), bad={"b"}).panels
    assert [line.label for line in few[0].lines] == ["a", "b (no result)"]
    assert "no result" not in few[0].title
    names = [f"{law}, {n}" for n in "12" for law in "abcd"]
    many = pictures.errors(drawn(*names), bad={"a, 1", "a, 2", "b, 2"}).panels
    ends = ["a: position error; no result", "b: position error; no result: 2", "c: position error"]
    assert [panel.title for panel in many[:3]] == ends
    assert [line.label for line in many[0].lines] == ["1", "2"]


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
    alone = contact_sheet.decode_png(lone["-overlay"].picture)
    assert alone.shape[0] > HEIGHT
    assert alone.shape[1] == WIDTH
    failed = [Cell({"cell": "x"}, (Result("x", "failed", "too far"),))]
    assert pictures.pictures(failed, tmp_path, settings) == {}
    mixed = pictures.pictures([*cells, *failed], tmp_path, settings)
    assert contact_sheet.decode_png(mixed["-sheet"].picture).shape[0] > sheet.shape[0]


@pytest.mark.parametrize("count", [3, 8])
def test_every_caption_says_what_is_no_result(tmp_path, monkeypatch, count):
    """Those of the sheet, and of the overlay: its key, or its titles where there are several."""
    made = study(tmp_path, [f"{law}, {n}" for n in "12" for law in "abcd"][:count])
    faults = {0: ["oscillates"], 1: ["done", "clipped"], 2: ["astray", "clipped"]}
    for i, words in faults.items():
        results = tuple(Result(str(i), word, word, {"error_integral": 1.0}) for word in words)
        made[i] = Cell(made[i].choice, results)
    sheets, keys = [], []
    sheet, key = contact_sheet.sheet, contact_sheet.with_key
    monkeypatch.setattr(
        contact_sheet,
        "sheet",
        lambda images, said, *n: sheets.append(said) or sheet(images, said, *n),
    )
    monkeypatch.setattr(
        contact_sheet,
        "with_key",
        lambda image, said, look: keys.append(said) or key(image, said, look),
    )
    pictures.pictures(made, tmp_path, make_settings(width=WIDTH, height=HEIGHT))
    ends = [caption.split("\n")[1:] for caption in sheets[-1 if count == 3 else 1]]
    said = [["no result: oscillates"], ["1 done, 1 clipped"], ["no result: 1 astray, 1 clipped"]]
    assert [end[-1:] for end in ends] == said + [[]] * (count - 3)
    if count == 3:
        names = [name for name, _ in keys[0]]
        assert {"a, 1 (no result)", "b, 1", "c, 1 (no result)"} <= set(names)
    else:
        ends = ["a; no result: 1", "b", "c; no result: 1", "d"]
        assert sheets[0] == ends


def kept(tmp_path, count=4, steps=True):
    """Cells of two laws with runs of several seeds, each with its errors and a step of 40 mm."""
    cells = []
    t = np.linspace(0, 2, 201)
    for law, rate in (("p", 5.0), ("pff", 20.0)):
        results = []
        for seed in range(count):
            way = 1 - np.exp(-rate * t) * (1 + 0.1 * seed)
            error = 1e-3 * (1 + seed) * np.ones(201)
            light = {"light": np.zeros((HEIGHT, WIDTH, 3), np.float32), "exposure": np.array(1.0)}
            light["light"][10:14, 10:60] = 1
            step = {"steps": np.array(1), "step0_t": t, "step0_size": np.array([0.04, 0, 1e-5]),
                    "step0_turn": np.array(0.5), "step0_line": np.array("3"),
                    "step0_angle": 0.5 * way, "step0_x": 0.04 * way, "step0_y": 0 * t,
                    "step0_z": 0 * t}  # fmt: skip
            key = f"{law}{seed}"
            path = arrays_path(tmp_path, key)
            path.parent.mkdir(exist_ok=True)
            np.savez(path, t_s=t, position_error_m=error, orientation_error_rad=error,
                     **(light if seed == 0 else {}), **(step if steps else {}))  # fmt: skip
            results.append(Result(key, "done", "", {"error_integral": 1.0 + seed}))
        cells.append(Cell({"controller": law}, tuple(results)))
    return cells


@pytest.mark.parametrize("band", ["std", "quantiles", "none"])
def test_bands_are_those_of_all_seeds(tmp_path, band):
    choice = pictures.ChartChoice(band=band, scale="linear", span=(0.5, 1.0))
    made = pictures.pictures(kept(tmp_path), tmp_path, make_settings(), choice)
    panel = made["-errors"].panels[0]
    line, values = panel.lines[0], np.array([1.0, 2.0, 3.0, 4.0])  # mm
    assert (panel.log_y, panel.x_span) == (False, (0.5, 1.0))
    expected = {
        "std": (2.5, 2.5 - values.std(ddof=1), 2.5 + values.std(ddof=1)),
        "quantiles": (2.5, *np.quantile(values, (0.1, 0.9))), "none": (2.5,),
    }[band]  # fmt: skip
    np.testing.assert_allclose(line.y, expected[0])
    if band == "none":
        assert line.band is None
    else:
        np.testing.assert_allclose(line.band[0], expected[1])
        np.testing.assert_allclose(line.band[1], expected[2])
    assert ("band" in made["-errors"].note) == (band != "none")


def test_a_run_that_is_no_result_is_in_no_band(tmp_path):
    cells = kept(tmp_path)
    lost = (*cells[0].results[:3], Result("p3", "oscillates", "it rings", {"error_integral": 9.0}))
    found = [Cell(cells[0].choice, lost), cells[1]]
    choice = pictures.ChartChoice(scale="linear")
    panel = pictures.pictures(found, tmp_path, make_settings(), choice)["-errors"].panels[0]
    np.testing.assert_allclose(panel.lines[0].y, 2.0)
    np.testing.assert_allclose(panel.lines[1].y, 2.5)


def test_on_a_logarithmic_axis_no_band_goes_below_zero(tmp_path):
    made = pictures.pictures(kept(tmp_path), tmp_path, make_settings(),
                             pictures.ChartChoice(scale="log"))  # fmt: skip
    panel = made["-errors"].panels[0]
    assert panel.log_y
    assert panel.lines[0].band[0].min() > 0
    assert "10 % to 90 %" in made["-errors"].note


def test_a_step_response_shows_what_moves_and_until_it_is_there(tmp_path):
    cells = kept(tmp_path)
    steps = pictures.pictures(cells, tmp_path, make_settings())["-steps"]
    assert [panel.title for panel in steps.panels] == ["x", "angle"]  # y and z hardly move
    x, angle = steps.panels
    assert (x.bound, x.log_y) == (40.0, False)
    assert angle.bound == pytest.approx(np.degrees(0.5))
    means = [1 - np.exp(-rate * x.lines[0].x) * 1.15 for rate in (5.0, 20.0)]
    for line, way in zip(x.lines, means, strict=True):
        np.testing.assert_allclose(line.y, 40 * way)
    assert x.span is None
    # the slowest comes within 2 % at ln(50 * 1.3) / 5 s, and 2.5 times that is all that there is
    assert x.x_span == (0, 2)
    fast = pictures.pictures(cells[1:], tmp_path, make_settings())["-steps"].panels[0]
    assert fast.x_span == (0, pytest.approx(2.5 * np.log(50 * 1.3) / 20, abs=0.03))
    assert "-steps" not in pictures.pictures(kept(tmp_path, steps=False), tmp_path, make_settings())


def test_panels_are_those_of_the_axis_that_is_asked_for(tmp_path):
    found = [Cell({"controller": c.choice["controller"], "plant": plant}, c.results)
             for c in kept(tmp_path) for plant in ("ideal", "stiff")]  # fmt: skip
    plants, laws = ["ideal", "stiff"], ["p", "pff"]
    for axis, titles, lines in (("plant", plants, laws), ("controller", laws, plants)):
        choice = pictures.ChartChoice(panels=axis)
        panels = pictures.pictures(found, tmp_path, make_settings(), choice)["-errors"].panels
        assert [p.title for p in panels[:2]] == [f"{t}: position error" for t in titles]
        assert [line.label for line in panels[0].lines] == lines

"""`brush NAME KEY VALUE ...`: any brush of the registry, as `--brush` has it."""

import cv2
import numpy as np
import pytest

from dqpaint.brushes import BRUSHES, make_brush, read_brush
from dqpaint.language import ScriptError, parse, read
from dqpaint.language.writing.formatter import formatted
from tests.support.drawn import last, only

LINE = "line by (9, 0) mm"

# As an option, and as a statement.
SAME = [
    ("point", "point"),
    ("point:lobe=3", "point lobe 3"),
    ("ball", "ball"),
    ("ball:size=8mm", "ball 8 mm"),
    ("ball:size=8mm", "point 8 mm"),
    ("ball:size=8mm,lobe=2", "point 8 mm lobe 2"),
    ("bar", "bar"),
    ("bar:length=300mm", "bar 300 mm"),
    ("bar:length=30cm,along=-y,leds=40,joined=0.2", "bar length 30 cm along -y leds 40 joined 0.2"),
    ("bar:leds=3,colours=red/white/0000ff", 'bar colours red to white to "#0000ff" leds 3'),
    ("ribbon:length=120mm,colours=orange/cyan", "ribbon 120 mm colours orange to cyan"),
    ("pixelstick:length=140mm,along=y,times=3", "pixelstick 140 mm along y times 1 + 2"),
    ("fibre:width=30mm,fibres=20,seed=7", "fibre width 30 mm fibres 20 seed 7"),
]


@pytest.mark.parametrize(("option", "words"), SAME)
def test_a_statement_is_the_option_to_the_last_bit(option, words):
    here = make_brush(only(f"brush {words}\n{LINE}").brush)
    there = read_brush(option)
    assert here == there
    mine, other = here.emitters(), there.emitters()
    for name in ("positions", "tints", "normal"):
        assert np.array_equal(getattr(mine, name), getattr(other, name)), name
    assert (mine.size, mine.joined, mine.lobe) == (other.size, other.joined, other.lobe)


def test_every_brush_and_every_value_can_be_said():
    said = " ".join(words for _, words in SAME)
    assert {words.split()[0] for _, words in SAME} == set(BRUSHES)
    keys = {key for model in BRUSHES.values() for key in model.model_fields}
    assert keys - {"size", "image"} <= set(said.split())


def test_what_is_usual_is_not_said():
    usual = only(f"brush bar 200 mm along x leds 0\n{LINE}").brush
    assert usual == only(f"brush bar\n{LINE}").brush
    assert usual.values == ()


def test_only_what_has_several_lamps_draws_when_it_turns_on_the_spot():
    several = {name for name in BRUSHES if only(f"brush {name}\n{LINE}").brush.several}
    assert several == {"bar", "ribbon", "pixelstick", "fibre"}


def test_names_of_the_file_that_are_called_like_values():
    text = "let length = 30 mm\nlet leds = 7\nbrush bar {}\n" + LINE
    whole = only(text.format("length 30 mm leds leds")).brush
    for words in ("length along x leds 7", "length*1 leds leds", "length length leds 7"):
        assert only(text.format(words)).brush == whole
    assert only(text.format("length")).brush.values == (("length", 0.03),)


def test_the_words_of_a_brush_and_those_of_its_statement():
    """What both know is the brush's, as long as its clause goes on."""
    screw = last(f"{LINE}\nscrew about (0, 0) brush bar 30 mm along z along y angle 9 deg")
    assert dict(screw.brush.values)["along"] == (0.0, 0.0, 1.0)
    assert screw.path.axis == (0.0, 1.0, 0.0)
    wide = last('text "i" height 9 mm brush fibre width 3 mm')
    assert wide.brush.values == (("width", 0.003),)
    narrow = last('text "i" brush bar 3 mm width 9 mm')
    assert narrow.brush.values == (("length", 0.003),)
    light = last(f"{LINE} brush ribbon colours red to blue light lime").light
    assert light.first == (0.0, 1.0, 0.0)


def test_an_image_lies_beside_the_drawing(tmp_path):
    cv2.imwrite(str(tmp_path / "stripes.png"), np.full((4, 6, 3), 255, np.uint8))
    drawing = tmp_path / "a.traj"
    drawing.write_text(f'brush pixelstick 140 mm image "stripes.png"\n{LINE}\n')
    made = make_brush(read(drawing).segments[0].brush)
    assert made == read_brush(f"pixelstick:length=140mm,image={tmp_path / 'stripes.png'}")
    assert made.emitters().tints.shape[0] == 6
    with pytest.raises(ScriptError) as caught:
        parse(drawing.read_text(), "a text without a file")
    assert [d.code for d in caught.value.diagnostics] == ["E292"]


@pytest.mark.parametrize(
    ("text", "laid_out"),
    [
        ("bar  length (3*r)  leds 40", "bar length (3*r) leds 40"),
        ("ball size(3 mm) lobe -1*-2", "ball size (3 mm) lobe -1*-2"),
        ("bar colours red to(c) along(0,1)", "bar colours red to (c) along (0, 1)"),
        ("bar f (3) leds g (3)", "bar f(3) leds g(3)"),
        ("bar leds(3) light(red)", "bar leds (3) light (red)"),
    ],
)
def test_layout(text, laid_out):
    assert formatted(f"line by (1,0) mm brush  {text}") == f"line by (1, 0) mm brush {laid_out}\n"

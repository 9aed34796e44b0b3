"""The baked light, decoded bit for bit: by the program itself, and by its compiled sketch."""

import re
import shutil
import subprocess
import sys
from types import ModuleType, SimpleNamespace

import numpy as np
import pytest

import dqpaint
from dqpaint.errors import DqpaintError
from dqpaint.outputs.registry import choose_writers, make_files

TEXT = """period 10 ms
profile quintic
start at (-40, 0) mm
line to (0, 20) mm light red to blue in 0.5 s
move to (40, 20) mm in 0.3 s
hold 0.4 s light white 50%
line to (40, 0) mm light "#20f0a0" in 0.25 s
"""
SIZE = {"plant": "ideal", "size": (64, 36)}


def drawn(tmp_path, text=TEXT, **choices):
    (tmp_path / "hook.traj").write_text(text)
    return dqpaint.draw(tmp_path / "hook.traj", **{**SIZE, **choices})


def program(painting, form, ending):
    return make_files(choose_writers(form), painting)[ending].decode()


class OverError(Exception):
    """The wire has gone low again."""


def played(text, monkeypatch):
    """What the LEDs show, with times [ns], as a board would run the program."""
    clock, shown, plays = [10**9 * 3600], [], []

    class Pixels(list):
        def __init__(self, pin, count, brightness, auto_write):
            super().__init__([(0, 0, 0)] * count)
            assert brightness == 1.0
            assert auto_write is False

        def fill(self, colour):
            self[:] = [colour] * len(self)

        def show(self):
            shown.append((clock[0], np.array(self, np.uint8)))

    class Wire:
        def __init__(self, pin):
            self.asked = 0

        def switch_to_input(self, pull):
            pass

        @property
        def value(self):
            self.asked += 1
            if self.asked == 5:
                plays.append(len(shown))
            if self.asked > 5:
                raise OverError
            return self.asked == 5

    def monotonic_ns():
        clock[0] += 1000
        return clock[0]

    fakes = {
        "time": {"monotonic_ns": monotonic_ns},
        "board": {"D5": 5, "D6": 6},
        "digitalio": {"DigitalInOut": Wire, "Pull": SimpleNamespace(DOWN=0)},
        "neopixel": {"NeoPixel": Pixels},
    }
    for name, has in fakes.items():
        module = ModuleType(name)
        vars(module).update(has)
        monkeypatch.setitem(sys.modules, name, module)
    with pytest.raises(OverError):
        exec(compile(text, "code.py", "exec"), {})
    begin = plays[0]
    zero = shown[begin][0]
    assert not shown[begin - 1][1].any()
    return [(time - zero, leds) for time, leds in shown[begin:]]


def at(shown, seconds):
    """What is shown at times (M,) [s]: (M, K, 3)."""
    times = np.array([time for time, _ in shown]) * 1e-9
    rows = np.searchsorted(times, seconds, side="right") - 1
    return np.array([leds for _, leds in shown])[rows]


def test_every_sample_is_what_8_bits_can_show(tmp_path, monkeypatch):
    painting = drawn(tmp_path)
    motion = painting.motion
    text = program(painting, "circuitpython", "-lamp.py")
    shown = played(text, monkeypatch)
    middle = motion.t[:-1] + 0.5 * motion.period
    asked = np.floor(255 * motion.light[:-1] + 0.5).astype(np.uint8)
    assert len(np.unique(asked, axis=0)) > 30
    np.testing.assert_array_equal(at(shown, middle)[:, 0], asked)
    assert not shown[-1][1].any()
    assert shown[-1][0] * 1e-9 == pytest.approx(motion.t[-1], abs=1e-4)
    assert text.startswith("# The light, baked")
    assert "Never run on a board" in text.splitlines()[0]
    assert len(shown) < 60  # held colours are one entry


def test_a_bar_has_its_leds(tmp_path, monkeypatch):
    """Lamps side by side, of which an image tints each by the way that has been gone."""
    painting = drawn(tmp_path, brush="bar:length=100mm,leds=5")
    shown = played(program(painting, "circuitpython", "-lamp.py"), monkeypatch)
    middle = painting.motion.t[:-1] + 0.5 * painting.motion.period
    [sweep] = painting.scene.light
    tints = sweep.emitters.tints
    assert tints.shape[1] == 5
    share = tints[0] / tints.max()
    asked = np.floor(255 * sweep.colours[:, None] * share + 0.5)
    np.testing.assert_array_equal(at(shown, middle), asked)


def test_a_strobe_flashes_as_it_does_in_the_picture(tmp_path, monkeypatch):
    text = TEXT.replace("hold", "strobe 25 Hz 30%\nhold")
    painting = drawn(tmp_path, text)
    shown = played(program(painting, "circuitpython", "-lamp.py"), monkeypatch)
    motion = painting.motion
    seconds = np.arange(0.0015, motion.t[-1], 0.003)
    row = np.floor(seconds / motion.period).astype(int)
    flashing = np.array([one.strobe is not None for one in motion.program.segments])[motion.stroke]
    on = ~flashing[row] | ((seconds * 25) % 1.0 < 0.3)
    clear = np.abs((seconds * 25 + 0.5) % 1.0 - 0.5) > 0.02
    clear &= np.abs((seconds * 25 - 0.3 + 0.5) % 1.0 - 0.5) > 0.02
    assert (flashing[row] & ~on & clear).sum() > 20
    asked = np.floor(255 * motion.light[row] * on[:, None] + 0.5)
    np.testing.assert_array_equal(at(shown, seconds)[clear][:, 0], asked[clear])


@pytest.mark.parametrize(
    ("change", "choices", "says"),
    [
        (("period 10 ms", "period 1 ms"), {"brush": "bar:length=100mm,leds=60"}, "60 LEDs take"),
        (("hold", "brush bar length 80 mm leds 3\nhold"), {}, "brushes of different lamps"),
    ],
)
def test_what_a_lamp_cannot_do_is_refused(tmp_path, change, choices, says):
    painting = drawn(tmp_path, TEXT.replace(*change), **choices)
    with pytest.raises(DqpaintError, match=says):
        program(painting, "circuitpython", "-lamp.py")


def test_what_16_bits_cannot_count_is_several_entries():
    from dqpaint.outputs.robot.lamp_table import _encoded

    ticks = np.array([65535, 200_000, 1, 65536])
    data = _encoded(ticks, np.arange(12, dtype=np.uint8).reshape(4, 1, 3))
    entries = [data[at : at + 5] for at in range(0, len(data), 5)]
    counts = [entry[0] + 256 * entry[1] for entry in entries]
    assert min(counts) > 0
    assert [sum(n for n, one in zip(counts, entries, strict=True) if one[2] == 3 * k)
            for k in range(4)] == ticks.tolist()  # fmt: skip


def table_of(sketch):
    body = re.search(r"PROGMEM = \{(.*?)\};", sketch, re.S)[1]
    return bytes(int(word) for word in body.replace(",", " ").split())


FASTLED = """
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#define PROGMEM
#define pgm_read_byte(at) (*(const uint8_t *)(at))
#define INPUT 0
#define RISING 3
enum Chip { WS2812B }; enum Order { GRB };
struct CRGB { uint8_t r, g, b; CRGB() : r(0), g(0), b(0) {}
  CRGB(uint8_t x, uint8_t y, uint8_t z) : r(x), g(y), b(z) {} };
static uint32_t now_us = 4294000000u, zero;
static void (*rising)() = 0;
static uint32_t micros() { return now_us += 2; }
static void pinMode(int, int) {}
static int digitalPinToInterrupt(int pin) { return pin; }
static void attachInterrupt(int, void (*f)(), int) { rising = f; }
struct Fast { CRGB *leds; int count;
  template <Chip c, int pin, Order o> void addLeds(CRGB *l, int n) { leds = l; count = n; }
  void setBrightness(int) {} void setDither(int) {}
  void show() { printf("%u", now_us - zero);
    for (int i = 0; i < count; i++) printf(" %d %d %d", leds[i].r, leds[i].g, leds[i].b);
    printf("\\n"); }
  void clear(bool) { for (int i = 0; i < count; i++) leds[i] = CRGB(); show(); } };
static Fast FastLED;
"""


@pytest.mark.slow
def test_the_sketch_compiled_shows_the_same(tmp_path, monkeypatch):
    """Against a stand-in for FastLED whose clock of 32 bits runs over in the middle."""
    compiler = shutil.which("g++")
    if compiler is None:
        pytest.skip("no C++ compiler")
    painting = drawn(tmp_path, brush="bar:length=100mm,leds=5")
    sketch = program(painting, "fastled", "-lamp.ino")
    (tmp_path / "FastLED.h").write_text(FASTLED)
    main = "int main() { setup(); loop(); zero = now_us; rising(); loop(); loop(); }\n"
    (tmp_path / "lamp.cpp").write_text(sketch + main)
    done = tmp_path / "lamp"
    flags = ["-Wall", "-Werror", "-Wno-unused-function", f"-I{tmp_path}"]
    subprocess.run([compiler, *flags, str(tmp_path / "lamp.cpp"), "-o", str(done)], check=True)
    lines = subprocess.run([done], check=True, capture_output=True, text=True).stdout.splitlines()
    numbers = [list(map(int, line.split())) for line in lines[1:]]  # the first clears
    shown = [(row[0] * 1000, np.array(row[1:]).reshape(-1, 3)) for row in numbers]
    other = played(program(painting, "circuitpython", "-lamp.py"), monkeypatch)
    assert len(shown) == len(other)
    for (t, leds), (time, expected) in zip(shown, other, strict=True):
        assert abs(t - time) < 1e5
        np.testing.assert_array_equal(leds, expected)


def test_both_have_one_table(tmp_path):
    painting = drawn(tmp_path)
    sketch = program(painting, "fastled", "-lamp.ino")
    source = program(painting, "circuitpython", "-lamp.py")
    literal = re.search(r"TABLE = (\(.*?\n\))", source, re.S)[1]
    assert table_of(sketch) == eval(literal)
